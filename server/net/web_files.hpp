#pragma once
// The built page, held in memory.

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "net/peer.hpp"

namespace oval4d::net {

/// One form of a file, as it is or compressed.
struct WebFile {
    Bytes bytes;
    std::string coding;  ///< the Content-Encoding; "identity" as it is
    std::string etag;
};

/// All forms of a file, the smallest first.
struct WebFileForms {
    std::string type;  ///< the Content-Type
    std::vector<WebFile> forms;

    /// The form that an Accept-Encoding header likes best (RFC 9110, 12.5.3), of equals the smallest; the file as it is
    /// where the header wants nothing that there is.
    const WebFile& bestFor(std::string_view acceptEncoding) const;
};

/// Reads the folder once: what is not in it at the start cannot be asked for. Of `app.js`, `app.js.br` and `app.js.gz`
/// are compressed forms.
class WebFiles {
  public:
    /// A folder that is missing is an empty one, and logged.
    explicit WebFiles(const std::filesystem::path& root);

    /// The file at this path of a URL, "/" being index.html; nullptr if there is none.
    const WebFileForms* find(std::string_view path) const;

  private:
    std::map<std::string, WebFileForms, std::less<>> files_;
};

}  // namespace oval4d::net
