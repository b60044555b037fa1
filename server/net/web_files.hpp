#pragma once
// The built page, held in memory.

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "net/peer.hpp"

namespace oval4d::net {

struct WebFile {
    Bytes bytes;
    std::string type;  ///< the Content-Type
    std::string etag;
};

/// Reads the folder once: what is not in it at the start cannot be asked for.
class WebFiles {
  public:
    /// A folder that is missing is an empty one, and logged.
    explicit WebFiles(const std::filesystem::path& root);

    /// The file at this path of a URL, "/" being index.html; nullptr if there is none.
    const WebFile* find(std::string_view path) const;

  private:
    std::map<std::string, WebFile, std::less<>> files_;
};

}  // namespace oval4d::net
