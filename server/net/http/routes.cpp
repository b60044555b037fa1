#include "net/http/routes.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>

#include "net/http/etags_and_ranges.hpp"
#include "net/jobs/data_names.hpp"
#include "net/jobs/export_job.hpp"
#include "net/jobs/loader_job.hpp"
#include "net/jobs/run_on_pool.hpp"
#include "pipeline/cost.hpp"
#include "session/object_loader.hpp"
#include "session/picture.hpp"
#include "session/query.hpp"
#include "slicing/slice_edges.hpp"
#include "text/message_text.hpp"
#include "text/words.hpp"
#include "wire/export_query.hpp"
#include "wire/messages.hpp"
#include "wire/state_message.hpp"

namespace oval4d::net {

namespace asio = boost::asio;

namespace {

const Error kMethodNotAllowed{ErrorCode::bad_message, "only the methods GET and HEAD are allowed"};
const Error kMakingFailed{ErrorCode::internal, "the server failed to make this picture or file"};

Error pathNotFoundError(const std::string& path) {
    return {ErrorCode::not_found, "there is nothing at the path " + text::inQuotes(path)};
}

/// Parses a number of pixels. `name` is the name of the query parameter, for the error message. Errors: `out_of_range`.
Result<int> parsePixels(const std::string& name, const std::string& text) {
    int value = 0;
    const std::string_view number = text::trimmed(text);
    const auto [end, fault] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (fault != std::errc{} || end != number.data() + number.size()) {
        return Error{ErrorCode::out_of_range, name + " must be a whole number of pixels, not " + text::inQuotes(text)};
    }
    return value;
}

/// Returns the resident memory of this process in bytes; 0 if /proc is not available.
double residentBytes() {
    double whole = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> whole >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// Removes `width` and `height` from a query, and returns the picture size that they describe. A missing one has its
/// default value. Errors: `out_of_range` if a value is not a number, or the size is not within `limits`.
Result<scene::Viewport> takeViewport(session::QueryParameters& query, const pipeline::PictureSizeLimits& limits) {
    scene::Viewport viewport = pipeline::defaultViewport(limits);
    session::QueryParameters rest;
    for (auto& [name, value] : query) {
        if (name == "width" || name == "height") {
            const auto parsed = parsePixels(name, value);
            if (!parsed) return parsed.error();
            (name == "width" ? viewport.width : viewport.height) = *parsed;
        } else {
            rest.emplace_back(std::move(name), std::move(value));
        }
    }
    query = std::move(rest);
    return pipeline::checkViewport(viewport, limits);
}

/// Returns the value of the header field Export-Warnings: the warnings, separated by semicolons, which no warning
/// contains. Replaces minus signs (U+2212) by hyphens, because clients read header fields as ASCII or ISO 8859-1.
std::string warningsField(const std::vector<std::string>& warnings) {
    std::string value;
    for (const std::string& warning : warnings) value += (value.empty() ? "" : "; ") + warning;
    constexpr std::string_view kMinus = "\u2212";
    for (std::size_t at = value.find(kMinus); at != std::string::npos; at = value.find(kMinus, at))
        value.replace(at, kMinus.size(), "-");
    return value;
}

/// Returns the export format that a path requests, such as stl for "/api/v1/file.stl"; null for other paths.
const exports::Format* formatInPath(std::string_view path) {
    constexpr std::string_view kFile = "/api/v1/file.";
    return path.starts_with(kFile) ? exports::formatNamed(path.substr(kFile.size())) : nullptr;
}

/// Returns a job that draws a picture as a PNG file. Its result is empty if the picture would exceed the limit on the
/// bytes held for the client (ByteBudget::Account).
std::function<std::optional<SharedBytes>(pipeline::Pipeline&)> frameJob(const session::State& state,
                                                                        scene::Viewport viewport,
                                                                        const ClientAccountPtr& client,
                                                                        Metrics& metrics) {
    return [state, viewport, client, &metrics](pipeline::Pipeline& pipeline) -> std::optional<SharedBytes> {
        // Reserves the bytes of the pixels until the size of the PNG file is known. The file is rarely larger.
        auto held = client->byteAccount().reserve(image::byteCount(viewport.width, viewport.height));
        if (!held) return std::nullopt;
        std::vector<std::uint8_t> png;
        const scene::PictureRequest picture = session::pictureRequestOf(state, viewport);
        pipeline.drawPng(picture, wire::stateMessageOutsideSessions(state, pipeline.nameFocusSection(picture).names),
                         png);
        metrics.observe(pipeline.times());
        held->forceResize(png.capacity());
        return SharedBytes(std::move(png)).keepingAlive(std::make_shared<ByteBudget::Reservation>(std::move(*held)));
    };
}

/// The content security policy of the web client. The page loads files only from its own server, and connects only to
/// this server. `blob:` is for pictures that the page offers for download.
constexpr const char* kContentSecurityPolicy =
    "default-src 'none'; script-src 'self'; worker-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'self'";

/// Returns the reply to a request for a file of the web client. Supports compressed representations (Accept-Encoding),
/// If-None-Match and byte ranges.
HttpReply webFileReply(const WebFile& file, const Routes::ParsedRequest& request) {
    const HttpRepresentation& representation = file.negotiate(request.acceptEncoding);
    HttpReply reply{200,
                    file.type,
                    representation.bytes,
                    {{"ETag", representation.etag},
                     {"Cache-Control", "no-cache"},
                     {"Vary", "Accept-Encoding"},
                     {"Accept-Ranges", "bytes"},
                     {"Content-Security-Policy", kContentSecurityPolicy}}};
    if (matchesEntityTag(request.ifNoneMatch, representation.etag)) return {304, "", {}, reply.headers};
    if (representation.coding != "identity") reply.headers.emplace_back("Content-Encoding", representation.coding);
    const bool unchanged = request.ifRange.empty() || request.ifRange == representation.etag;
    const auto range =
        request.method == "GET" && unchanged ? parseRange(request.range, representation.bytes.size()) : std::nullopt;
    if (!range) return reply;
    const std::string size = std::to_string(representation.bytes.size());
    if (!range->satisfiable) {
        HttpReply refused = noCacheTextReply("text/plain", "the file has " + size + " bytes\n", 416);
        refused.headers.emplace_back("Content-Range", "bytes */" + size);
        return refused;
    }
    reply.status = 206;
    reply.body = representation.bytes.subrange(range->first, range->size);
    reply.headers.emplace_back("Content-Range", "bytes " + std::to_string(range->first) + '-' +
                                                    std::to_string(range->first + range->size - 1) + '/' + size);
    return reply;
}

}  // namespace

asio::awaitable<HttpReply> Routes::answer(ParsedRequest request) {
    if (request.method != "GET" && request.method != "HEAD") {
        HttpReply refused = errorReply(kMethodNotAllowed, 405);
        refused.headers.emplace_back("Allow", "GET, HEAD");
        co_return refused;
    }
    const std::string& path = request.target.path;
    if (path == "/healthz") co_return noCacheTextReply("text/plain", "ok\n");
    if (path == "/readyz") co_return readiness();
    if (path == "/metrics") co_return metrics();
    if (path == "/api/v1/catalogue") co_return co_await catalogue(request.client);
    if (path == "/api/v1/keymap") co_return jsonReply(wire::keymapMessage({}));
    if (path == "/api/v1/frame.png") co_return co_await frame(std::move(request.target.query), request.client);
    if (const auto format = formatInPath(path))
        co_return co_await file(std::move(request.target.query), *format, request.client);
    if (const WebFile* file = files_.find(path)) co_return webFileReply(*file, request);
    co_return errorReply(pathNotFoundError(path));
}

/// Returns the state that a query describes. `others` are the names of further parameters that the query may have. If
/// the polytope of the state must be built, a worker builds it. Errors: those of session::stateFromQuery(); `too_many`
/// if the client's byte account has no room for the polytope. Throws the exceptions of runOnPool().
asio::awaitable<Result<session::State>> Routes::stateFromQueryOnWorker(session::QueryParameters query,
                                                                       std::span<const std::string_view> others,
                                                                       ClientAccountPtr client) {
    std::erase_if(query, [](const auto& entry) { return entry.first == "token"; });
    const session::Limits& limits = services_.options.session;
    const auto loader = std::make_shared<session::ObjectLoader>(
        limits, services_.polytopes, session::ObjectLoader::LoadingMode::deferred, session::FileReader());
    for (;;) {
        auto state = session::stateFromQuery(query, limits, *loader, session::initialState(), others);
        if (!loader->isPending()) co_return state;
        const auto reservation = client->byteAccount().reserve(loader->estimatedMemory());
        if (!reservation) co_return kTooManyBytes;
        co_await runOnPool<std::monostate>(services_.pictureWorkers.workers(), loaderJob(loader),
                                           client->pictureJobQueue(), loader->estimatedDuration());
    }
}

asio::awaitable<HttpReply> Routes::catalogue(ClientAccountPtr client) {
    try {
        const std::vector<std::string> names = co_await dataFolderNames(services_, std::move(client));
        co_return jsonReply(wire::catalogueMessage({}, {}, names));
    } catch (const parallel::QueueFull&) {
        co_return countedErrorReply(kTooManyJobs);
    }
}

HttpReply Routes::countedErrorReply(const Error& error) {
    services_.metrics.countError(error.code);
    return errorReply(error);
}

asio::awaitable<HttpReply> Routes::frame(session::QueryParameters query, ClientAccountPtr client) {
    try {
        const auto viewport = takeViewport(query, services_.options.frame);
        if (!viewport) co_return countedErrorReply(viewport.error());
        const auto requested = co_await stateFromQueryOnWorker(std::move(query), session::kPictureParameters, client);
        if (!requested) co_return countedErrorReply(requested.error());
        const auto cost = pipeline::frameCost(session::pictureRequestOf(*requested, *viewport));
        auto png = co_await runOnPool<std::optional<SharedBytes>>(
            services_.pictureWorkers, frameJob(*requested, *viewport, client, services_.metrics),
            client->pictureJobQueue(), cost);
        if (!png) co_return countedErrorReply(kTooManyBytes);
        co_return noCacheReply("image/png", std::move(*png));
    } catch (const parallel::QueueFull&) {
        co_return countedErrorReply(kTooManyJobs);
    } catch (const slicing::TooManySliceEdges& fault) {
        co_return countedErrorReply({ErrorCode::too_large, fault.what()});
    } catch (const std::exception& fault) {
        spdlog::error("picture failed fault=\"{}\"", fault.what());
        co_return errorReply(kMakingFailed);
    }
}

asio::awaitable<HttpReply> Routes::file(session::QueryParameters query, const exports::Format& format,
                                        ClientAccountPtr client) {
    try {
        const auto exported = wire::extractExportRequest(query, format, services_.options.session.maxSlices);
        if (!exported) co_return countedErrorReply(exported.error());
        const auto requested = co_await stateFromQueryOnWorker(std::move(query), session::kFileParameters, client);
        if (!requested) co_return countedErrorReply(requested.error());
        const scene::PictureRequest picture = session::pictureRequestOf(*requested);
        const ExportResult made =
            co_await runOnPool<ExportResult>(services_.exportWorkers, exportJob(services_, picture, *exported, client),
                                             client->exportJobQueue(), pipeline::exportCost(picture, *exported));
        if (!*made) co_return countedErrorReply(made->error());
        const FinishedExport& finished = **made;
        HttpReply answer = noCacheReply(format.mediaType, finished.bytes);
        if (!finished.warnings.empty())
            answer.headers.emplace_back("Export-Warnings", warningsField(finished.warnings));
        answer.headers.emplace_back(
            "Content-Disposition",
            "attachment; filename=\"" + pipeline::exportFileName(requested->object, *exported) + "\"");
        co_return answer;
    } catch (const parallel::QueueFull&) {
        co_return countedErrorReply(kTooManyJobs);
    } catch (const std::exception& fault) {
        spdlog::error("file failed fault=\"{}\"", fault.what());
        co_return errorReply(kMakingFailed);
    }
}

HttpReply Routes::readiness() const {
    if (readiness_.stopping()) return noCacheTextReply("text/plain", "stopping\n", 503);
    if (readiness_.ready()) {
        // The server stays ready while the store of sessions is unavailable. Other servers that share the store could
        // not serve its clients better.
        const std::string error = sessions_.writeBehind().lastError();
        return noCacheTextReply("text/plain",
                                error.empty() ? "ready\n"
                                              : "ready, but the store is unavailable, so sessions are kept in memory "
                                                "for now: " +
                                                    error + "\n");
    }
    const bool broken = readiness_.isBroken();
    return noCacheTextReply(
        "text/plain", broken ? "not ready: frames cannot be drawn; see the log\n" : "not ready: warming up\n", 503);
}

HttpReply Routes::metrics() {
    Metrics& shown = services_.metrics;
    shown.sessions.Set(static_cast<double>(sessions_.writeBehind().sessionCount()));
    shown.openSessions.Set(static_cast<double>(sessions_.openSessionCount()));
    shown.unsaved.Set(static_cast<double>(sessions_.writeBehind().unsaved()));
    shown.storeUp.Set(sessions_.writeBehind().lastError().empty() ? 1 : 0);
    shown.workers.Set(static_cast<double>(services_.pictureWorkers.workers().size()));
    shown.workerSeconds.Increment(
        std::max(0.0, Seconds(services_.pictureWorkers.workers().busyTime()).count() - shown.workerSeconds.Value()));
    shown.jobsWaiting.Set(static_cast<double>(services_.pictureWorkers.workers().waitingJobCount()));
    shown.memory.Set(residentBytes());
    shown.bytesHeld.Set(static_cast<double>(services_.clients.bytesHeld()));
    shown.clients.Set(static_cast<double>(services_.clients.size()));
    shown.polytopes.Set(static_cast<double>(services_.polytopes.bytes()));
    shown.dataFields.Set(static_cast<double>(services_.data.bytesInMemory()));
    shown.fieldFiles.Set(static_cast<double>(services_.fieldCacheFiles.diskBytes()));
    shown.critical.Set(static_cast<double>(services_.critical.bytes()));
    return noCacheTextReply("text/plain; version=0.0.4; charset=utf-8", shown.expositionText());
}

}  // namespace oval4d::net
