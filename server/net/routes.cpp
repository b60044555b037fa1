#include "net/routes.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>

#include "geometry/catalogue.hpp"
#include "net/file_job.hpp"
#include "net/on_pool.hpp"
#include "protocol/cpp/codec.hpp"

namespace oval4d::net {

namespace asio = boost::asio;
using protocol::Error;
using protocol::ErrorCode;
using protocol::Result;

namespace {

constexpr const char* kJson = "application/json";

const Error kNoSuchMethod{ErrorCode::bad_message, "only GET and HEAD are understood here"};
const Error kNotMade{ErrorCode::internal, "the server failed to make this"};

Error nothingAt(const std::string& path) { return {ErrorCode::not_found, "there is nothing at " + path}; }

Reply reply(std::string type, Bytes body, unsigned status = 200) {
    return {status, std::move(type), std::move(body), {{"Cache-Control", "no-cache"}}};
}

Reply textReply(std::string type, std::string body, unsigned status = 200) {
    return reply(std::move(type), Bytes(std::move(body)), status);
}

unsigned statusFor(ErrorCode code) {
    switch (code) {
        case ErrorCode::not_found:
            return 404;
        case ErrorCode::bad_token:
            return 401;
        case ErrorCode::too_large:
            return 413;
        case ErrorCode::too_many:
            return 503;
        case ErrorCode::internal:
            return 500;
        default:
            return 400;
    }
}

Result<int> pixels(const std::string& name, const std::string& text) {
    int value = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (fault != std::errc{} || end != text.data() + text.size()) {
        return Error{ErrorCode::out_of_range, name + " must be a whole number of pixels, not '" + text + "'"};
    }
    return value;
}

double residentBytes() {
    double whole = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> whole >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

struct Wish {
    session::State state;
    scene::Viewport viewport;
};

/// What a query asks a picture of, and its size.
Result<Wish> parseWish(session::Query query, const Options& options) {
    scene::Viewport viewport;
    session::Query settings;
    for (auto& [name, value] : query) {
        if (name == "width" || name == "height") {
            const auto parsed = pixels(name, value);
            if (!parsed) return parsed.error();
            (name == "width" ? viewport.width : viewport.height) = *parsed;
        } else if (name != "token") {
            settings.emplace_back(std::move(name), std::move(value));
        }
    }
    if (const auto fits = picture::checked(viewport, options.frame); !fits) return fits.error();
    auto state = session::stateFromQuery(settings, options.session);
    if (!state) return state.error();
    return Wish{std::move(*state), viewport};
}

struct FileWish {
    session::State state;
    exports::Wish wish;
};

Result<FileWish> parseFileWish(session::Query query, exports::Format format, const Options& options) {
    std::erase_if(query, [](const auto& entry) { return entry.first == "token"; });
    auto wish = picture::takeWish(query, format);
    if (!wish) return wish.error();
    auto state = session::stateFromQuery(query, options.session);
    if (!state) return state.error();
    return FileWish{std::move(*state), *wish};
}

// Queries are read on a worker: the polytope that one names may have to be built.

std::function<std::optional<Result<Wish>>(picture::Painter&)> readWish(const session::Query& query,
                                                                       const Options& options) {
    return [query, &options](picture::Painter& /*unused*/) { return std::optional(parseWish(query, options)); };
}

std::function<std::optional<Result<FileWish>>(picture::Painter&)> readFileWish(const session::Query& query,
                                                                               exports::Format format,
                                                                               const Options& options) {
    return [query, format, &options](picture::Painter& /*unused*/) {
        return std::optional(parseFileWish(query, format, options));
    };
}

/// "/api/v1/file.stl" → stl
std::optional<exports::Format> formatIn(std::string_view path) {
    constexpr std::string_view kFile = "/api/v1/file.";
    return path.starts_with(kFile) ? exports::named(exports::kFormats, path.substr(kFile.size())) : std::nullopt;
}

std::function<Bytes(picture::Painter&)> frameJob(const Wish& wish, Metrics& metrics) {
    return [wish, &metrics](picture::Painter& painter) {
        std::vector<std::uint8_t> png;
        painter.frame(wish.state, protocol::stateMessage(wish.state, 0), wish.viewport, png);
        metrics.observe(painter.times());
        return Bytes(std::move(png));
    };
}

/// The page needs nothing but its own files and its own server; pictures to be saved are blobs.
constexpr const char* kContentPolicy =
    "default-src 'none'; script-src 'self'; worker-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'self'";

Reply fileReply(const WebFileForms& file, const Routes::Inquiry& inquiry) {
    const WebFile& form = file.bestFor(inquiry.acceptEncoding);
    std::vector<std::pair<std::string, std::string>> headers{{"ETag", form.etag},
                                                             {"Cache-Control", "no-cache"},
                                                             {"Vary", "Accept-Encoding"},
                                                             {"Content-Security-Policy", kContentPolicy}};
    if (inquiry.ifNoneMatch.find(form.etag) != std::string::npos) return {304, "", {}, headers};
    if (form.coding != "identity") headers.emplace_back("Content-Encoding", form.coding);
    return {200, file.type, form.bytes, headers};
}

}  // namespace

Reply errorReply(const Error& error, unsigned status) {
    return textReply(kJson, protocol::errorMessage(error, {}), status != 0 ? status : statusFor(error.code));
}

asio::awaitable<Reply> Routes::answer(Inquiry inquiry) {
    if (inquiry.method != "GET" && inquiry.method != "HEAD") {
        Reply refused = errorReply(kNoSuchMethod, 405);
        refused.headers.emplace_back("Allow", "GET, HEAD");
        co_return refused;
    }
    const std::string& path = inquiry.target.path;
    if (path == "/healthz") co_return textReply("text/plain", "ok\n");
    if (path == "/readyz") co_return readiness();
    if (path == "/metrics") co_return metrics();
    if (path == "/api/v1/catalogue") co_return textReply(kJson, protocol::catalogueMessage({}));
    if (path == "/api/v1/keymap") co_return textReply(kJson, protocol::keymapMessage({}));
    if (path == "/api/v1/frame.png") co_return co_await frame(std::move(inquiry.target.query));
    if (const auto format = formatIn(path)) co_return co_await file(std::move(inquiry.target.query), *format);
    if (const WebFileForms* file = files_.find(path)) co_return fileReply(*file, inquiry);
    co_return errorReply(nothingAt(path));
}

asio::awaitable<Reply> Routes::frame(session::Query query) {
    try {
        const auto wish = co_await onPool(services_.pool, readWish(query, services_.options));
        if (!*wish) {
            services_.metrics.countError(wish->error().code);
            co_return errorReply(wish->error());
        }
        Bytes png = co_await onPool(services_.pool, frameJob(**wish, services_.metrics));
        co_return reply("image/png", std::move(png));
    } catch (const std::exception& fault) {
        spdlog::error("picture failed fault=\"{}\"", fault.what());
        co_return errorReply(kNotMade);
    }
}

asio::awaitable<Reply> Routes::file(session::Query query, exports::Format format) {
    std::optional<Result<FileWish>> asked;
    MadeFile made;
    try {
        asked = co_await onPool(services_.pool, readFileWish(query, format, services_.options));
        if (*asked) made = co_await onPool(services_.files, fileJob(services_, (*asked)->state, (*asked)->wish));
    } catch (const std::exception& fault) {
        spdlog::error("file failed fault=\"{}\"", fault.what());
    }
    if (!made || !*made) {
        const Error& error = made ? made->error() : asked && !*asked ? asked->error() : kNotMade;
        services_.metrics.countError(error.code);
        co_return errorReply(error);
    }
    Reply answer = reply(std::string(exports::mediaType(format)), **made);
    answer.headers.emplace_back("Content-Disposition",
                                "attachment; filename=\"" + picture::fileName((*asked)->state, (*asked)->wish) + "\"");
    co_return answer;
}

Reply Routes::readiness() const {
    if (readiness_.stopping()) return textReply("text/plain", "stopping\n", 503);
    if (readiness_.ready()) {
        // A store that fails is no reason to send clients elsewhere: there it fails, too.
        const std::string trouble = hub_.keeper().trouble();
        return textReply("text/plain", trouble.empty() ? "ready\n"
                                                       : "ready, but the store fails, and sessions stay in memory "
                                                         "meanwhile: " +
                                                             trouble + "\n");
    }
    const bool broken = readiness_.broken();
    return textReply("text/plain", broken ? "frames cannot be drawn: see the log\n" : "not yet: warming up\n", 503);
}

Reply Routes::metrics() {
    Metrics& shown = services_.metrics;
    shown.sessions.Set(static_cast<double>(hub_.keeper().count()));
    shown.openSessions.Set(static_cast<double>(hub_.open()));
    shown.unsaved.Set(static_cast<double>(hub_.keeper().unsaved()));
    shown.storeUp.Set(hub_.keeper().trouble().empty() ? 1 : 0);
    shown.workers.Set(static_cast<double>(services_.pool.size()));
    shown.workerSeconds.Increment(
        std::max(0.0, Seconds(services_.pool.worked()).count() - shown.workerSeconds.Value()));
    shown.jobsWaiting.Set(static_cast<double>(services_.pool.waiting()));
    shown.memory.Set(residentBytes());
    shown.polytopes.Set(static_cast<double>(geometry::polytopesKept()));
    return textReply("text/plain; version=0.0.4; charset=utf-8", shown.text());
}

}  // namespace oval4d::net
