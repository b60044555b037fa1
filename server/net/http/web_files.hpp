#pragma once
// The files of the built web client, which the server holds in memory.

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "net/shared_bytes.hpp"

namespace oval4d::net {

/// The bytes of a file in one content coding, compressed or not (a representation in RFC 9110, section 3.2).
struct HttpRepresentation {
    SharedBytes bytes;
    std::string coding;  ///< the Content-Encoding; "identity" if uncompressed
    std::string etag;    ///< the entity tag, including its quotes
};

/// A file with all its representations, the smallest first.
struct WebFile {
    std::string type;  ///< the Content-Type
    std::vector<HttpRepresentation> representations;

    /// Returns the representation that the header field Accept-Encoding prefers (RFC 9110, section 12.5.3). Among
    /// equally preferred representations, returns the smallest. If the field accepts none, returns the uncompressed
    /// one.
    const HttpRepresentation& negotiate(std::string_view acceptEncoding) const;
};

/// The files of a folder, as they were when the constructor read them. The files `app.js.br` and `app.js.gz` count as
/// compressed representations of `app.js`.
class WebFiles {
  public:
    /// Reads all files below `root`. Logs a warning if there is no index.html; a missing folder counts as empty.
    explicit WebFiles(const std::filesystem::path& root);

    /// Returns the file at this URL path; "/" means index.html. Returns nullptr if there is no such file.
    const WebFile* find(std::string_view path) const;

  private:
    std::map<std::string, WebFile, std::less<>> files_;
};

}  // namespace oval4d::net
