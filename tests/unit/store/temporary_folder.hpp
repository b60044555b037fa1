#pragma once
// A temporary folder for the tests of session stores.

#include <cstdlib>
#include <filesystem>
#include <string>

namespace oval4d::store {

/// A temporary folder. The destructor deletes it.
class Folder {
  public:
    Folder() {
        std::string pattern = std::filesystem::temp_directory_path() / "oval4d-store-XXXXXX";
        path = mkdtemp(pattern.data());
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { std::filesystem::remove_all(path); }
    std::filesystem::path path;
};

}  // namespace oval4d::store
