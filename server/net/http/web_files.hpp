#pragma once
// The files of the built web client, held in memory.

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "net/shared_bytes.hpp"

namespace oval4d::net {

/// The bytes of a file, uncompressed or compressed: a representation in the sense of RFC 9110, section 3.2.
struct Representation {
    SharedBytes bytes;
    std::string coding;  ///< the content coding (Content-Encoding); "identity" if uncompressed
    std::string etag;    ///< the entity tag, including its quotes
};

/// A file with all its representations, the smallest first.
struct WebFile {
    std::string type;  ///< the Content-Type
    std::vector<Representation> representations;

    /// Returns the representation that an Accept-Encoding field prefers (RFC 9110, section 12.5.3), or the smallest of
    /// several equally preferred ones. Returns the uncompressed representation if the field accepts none of them.
    const Representation& negotiate(std::string_view acceptEncoding) const;
};

/// The files of a folder, which the constructor reads: later changes to the folder have no effect. The files
/// `app.js.br` and `app.js.gz` are compressed representations of `app.js`.
class WebFiles {
  public:
    /// Reads all files below `root`. Logs a warning if there is no index.html; a missing folder counts as empty.
    explicit WebFiles(const std::filesystem::path& root);

    /// Returns the file at this URL path, index.html for "/"; nullptr if there is none.
    const WebFile* find(std::string_view path) const;

  private:
    std::map<std::string, WebFile, std::less<>> files_;
};

}  // namespace oval4d::net
