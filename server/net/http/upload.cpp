#include "net/http/upload.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "net/services.hpp"
#include "session/load.hpp"
#include "session/query.hpp"
#include "text/message_text.hpp"
#include "wire/parse.hpp"

namespace oval4d::net {

namespace {

constexpr std::string_view kSessions = "/api/v1/sessions/", kFields = "/fields/", kMoments = "/moments",
                           kState = "/state";

// The number of bytes that are reserved beyond those received, so that the byte account is not locked for each small
// part of a body.
constexpr std::size_t kReserved = 1U << 20U;

const Error kNoUpload{ErrorCode::not_found,
                      "a field is uploaded with PUT to /api/v1/sessions/{session}/fields/{name}, and moments are added "
                      "with POST to /api/v1/sessions/{session}/fields/{name}/moments; a picture or a state is restored "
                      "with PUT to /api/v1/sessions/{session}/state"};

/// Sets the member of `load` that a query parameter names. Returns an error if the parameter is unknown or its value is
/// invalid; otherwise an empty optional.
std::optional<Error> setLoadMember(session::LoadObject& load, const std::string& name, const std::string& value) {
    const auto found = std::ranges::find(session::kLoadTexts, name, &session::NamedLoadOption::name);
    if (found != session::kLoadTexts.end()) {
        load.*(found->member) = value;
    } else if (name == "box") {
        const auto box = session::parseBox(value);
        if (!box) return box.error();
        load.box = *box;
    } else {
        std::vector<std::string_view> names{"box"};
        for (const session::NamedLoadOption& each : session::kLoadTexts) names.push_back(each.name);
        return Error{ErrorCode::bad_message, "an upload has no " + text::inQuotes(name) +
                                                 text::didYouMean(name, names) + "; its query may have " +
                                                 text::commaSeparated(names)};
    }
    return {};
}

std::optional<Error> setLoadMembers(session::LoadObject& load, const session::QueryParameters& query) {
    for (auto entry = query.begin(); entry != query.end(); ++entry) {
        const auto& [name, value] = *entry;
        if (name == "token") continue;
        if (std::ranges::find(entry + 1, query.end(), name, &session::QueryParameters::value_type::first) !=
            query.end())
            return Error{ErrorCode::bad_message, text::inQuotes(name) + " is repeated in the query"};
        if (auto error = setLoadMember(load, name, value)) return error;
    }
    return {};
}

}  // namespace

bool isUpload(std::string_view method, std::string_view path) {
    return (method == "PUT" || method == "POST") && path.starts_with(kSessions);
}

Result<UploadRequest> parseUpload(std::string_view method, const RequestTarget& target, const session::Limits& limits) {
    std::string_view rest = std::string_view(target.path).substr(kSessions.size());
    const std::size_t at = std::min(rest.find('/'), rest.size());
    UploadRequest upload{std::string(rest.substr(0, at)), {}};
    rest.remove_prefix(at);
    if (rest == kState && method == "PUT") {
        for (const auto& [name, value] : target.query) {
            if (name != "token")
                return Error{ErrorCode::bad_message, "the upload of a state has no " + text::inQuotes(name)};
        }
        return upload;
    }
    if (!rest.starts_with(kFields)) return kNoUpload;
    rest.remove_prefix(kFields.size());
    session::LoadObject load;
    load.append = method == "POST";
    if (load.append) {
        if (!rest.ends_with(kMoments)) return kNoUpload;
        rest.remove_suffix(kMoments.size());
    }
    load.name = rest;
    if (auto error = setLoadMembers(load, target.query)) return std::move(*error);
    // checkLoad() requires an array format only if `load.file` is set. The file is not received yet, so the format is
    // checked here.
    const bool array = load.format.empty() || session::isArrayFormat(load.format);
    if (!array)
        return Error{ErrorCode::unsupported_format,
                     "an uploaded file must be an array: " + text::joinedWithOr(session::arrayFormatNames()) +
                         ", not " + text::inQuotes(load.format)};
    session::LoadObject checked = load;
    if (checked.format.empty()) checked.format = "npy";
    if (auto error = session::checkLoad(checked, limits)) return std::move(*error);
    upload.load = std::move(load);
    return upload;
}

std::function<ParsedStateFile(std::size_t worker)> parseStateFileJob(std::shared_ptr<const fields::FileHandle> file,
                                                                     std::size_t maxMessage) {
    return [file = std::move(file), maxMessage](std::size_t /*worker*/) -> ParsedStateFile {
        const auto contents = fields::FileContents::map(file->descriptor());
        if (!contents) return contents.error();
        const auto& bytes = contents->bytes;
        return wire::setCommandFromFile({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, maxMessage);
    };
}

HttpReply uploadErrorReply(const Error& error) {
    if (error.code == ErrorCode::unsupported_format) return errorReply(error, 415);
    if (error.code != ErrorCode::too_many) return errorReply(error);
    HttpReply reply = errorReply(error, 429);
    reply.headers.emplace_back("Retry-After", "10");
    return reply;
}

UploadedBody::UploadedBody(const ClientAccountPtr& client) {
    const int file = memfd_create("oval4d-upload", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    if (file < 0) throw std::system_error(errno, std::generic_category(), "an upload cannot be received");
    reservedFile_ = std::make_shared<FileWithReservation>(client->byteAccount().forceReserve(0), file);
}

std::optional<Error> UploadedBody::append(std::string_view bytes) {
    const std::size_t size = size_ + bytes.size();
    if (size > reservedFile_->bytes.size() && !reservedFile_->bytes.growTo(size + kReserved) &&
        !reservedFile_->bytes.growTo(size))
        return kTooManyBytes;
    while (!bytes.empty()) {
        const ssize_t written = write(reservedFile_->file.descriptor(), bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return Error{ErrorCode::internal, "the server has no memory for this upload"};
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    size_ = size;
    return {};
}

std::shared_ptr<const fields::FileHandle> UploadedBody::finish() {
    reservedFile_->bytes.forceResize(size_);
    // The seals prevent the process that will read the file from changing the size of the file.
    fcntl(reservedFile_->file.descriptor(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL);
    return {reservedFile_, &reservedFile_->file};
}

}  // namespace oval4d::net
