#pragma once
// Uploads of fields and states. Parses requests such as PUT /api/v1/sessions/{id}/fields/{name}, and receives their
// bodies.

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "errors/error.hpp"
#include "fields/readers/file_contents.hpp"
#include "net/clients.hpp"
#include "net/http/request_target.hpp"
#include "net/http/routes.hpp"
#include "session/command.hpp"

namespace oval4d::net {

/// The parsed header of an upload, without the uploaded file.
struct UploadRequest {
    std::string session;                      ///< id of the session to change
    std::optional<session::LoadObject> load;  ///< how to load the uploaded field; empty if the file contains a state
};

/// Returns whether a request with this method and path uploads a file, and therefore has a body. Uploads are PUT and
/// POST to paths that begin with /api/v1/sessions/.
bool isUpload(std::string_view method, std::string_view path);

/// Parses an upload, for which isUpload() must be true. There are three kinds:
/// - PUT …/fields/{name} loads a field;
/// - POST …/fields/{name}/moments adds time steps to a loaded field;
/// - PUT …/state restores the state in the uploaded picture or `state` message.
///
/// The query of the first two kinds may have `format`, `axes`, `box`, `variable`, `values` and `values_variable`; the
/// query of the third must be empty. A parameter `token`, the token of the server, is ignored. Errors: `not_found` for
/// any other path; `unsupported_format` if the format is not an array format; `bad_message` for an unknown or repeated
/// name in the query; those of session::parseBox() and session::checkLoad().
Result<UploadRequest> parseUpload(std::string_view method, const RequestTarget& target, const session::Limits& limits);

/// The maximum size of an uploaded picture or `state` message, in bytes. The largest picture that oval4d makes is
/// smaller.
inline constexpr std::size_t kMaxStateFile = std::size_t{64} << 20U;

/// The result of parsing an uploaded state: the command that restores the state, or an error. Empty before the file is
/// parsed.
using ParsedStateFile = std::optional<Result<session::ChangeSettings>>;
/// Returns a job for a worker pool that parses an uploaded file with a state. `maxMessage` is the maximum size of the
/// `state` message in the file, in bytes. Errors: those of wire::setCommandFromFile(); `bad_field` if the file is
/// empty.
std::function<ParsedStateFile(std::size_t worker)> parseStateFileJob(std::shared_ptr<const fields::FileHandle> file,
                                                                     std::size_t maxMessage);

/// Returns the reply to a failed upload. Like errorReply(), but `unsupported_format` has status 415, and `too_many` has
/// status 429 and the header field Retry-After.
HttpReply uploadErrorReply(const Error& error);

/// Receives the body of an upload into a file in memory. Its bytes stay reserved in the client's byte account
/// (ByteBudget::Account) until this object and all copies of finish()'s result are destroyed.
class UploadedBody {
  public:
    /// Throws std::system_error if the system cannot create the file.
    explicit UploadedBody(const ClientAccountPtr& client);

    /// Appends bytes to the file. Errors: `too_many` if the client's byte account has no room; `internal` if the system
    /// has no memory.
    std::optional<Error> append(std::string_view bytes);
    /// Returns the complete file. append() must not be called afterward.
    std::shared_ptr<const fields::FileHandle> finish();

  private:
    struct FileWithReservation {
        FileWithReservation(ByteBudget::Reservation reserved, int descriptor)
            : bytes(std::move(reserved)), file(descriptor) {}
        ByteBudget::Reservation bytes;
        fields::FileHandle file;
    };
    std::shared_ptr<FileWithReservation> reservedFile_;
    std::size_t size_ = 0;
};

}  // namespace oval4d::net
