#pragma once
// Access to the files of a folder that contains an array.

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "errors/error.hpp"
#include "fields/array/mapped_file.hpp"
#include "fields/readers/file_contents.hpp"

namespace oval4d::fields {

/// A function that returns a part of a file in a folder. `path` is relative to the folder, such as "temperature/c/0/0".
/// Returns an empty optional if there is no such file, and fewer bytes if the file ends before the part does. Errors:
/// those of FileContents::map(), and those of the store in which the folder is.
using FolderFileReader =
    std::function<Result<std::optional<FileContents>>(const std::string& path, const FilePart& part)>;

/// A file that was found in a folder.
struct FoundFile {
    std::shared_ptr<const FileHandle> file;  ///< the open file; null if the folder is not on a disk
    std::string bytes;                       ///< only if `file` is null: the bytes of the requested part
};

/// A folder from which the server takes files for another process. That process parses the files, and may not open
/// files itself. Thread-safe.
class FolderFileProvider {
  public:
    virtual ~FolderFileProvider() = default;

    /// Finds a file by its path relative to the folder. Opens the file, or gets the bytes of `part` if the file cannot
    /// be opened. Returns an empty optional if there is no such file, or if a name in the path is empty, "." or "..".
    /// If the bytes do not arrive by `until`, or if a stop is requested, returns an error.
    virtual Result<std::optional<FoundFile>> findFile(const std::string& path, const FilePart& part,
                                                      std::chrono::steady_clock::time_point until,
                                                      const std::stop_token& stop) const = 0;

    /// Returns a string that changes when the metadata of the folder's arrays change. Some changes may go unnoticed.
    virtual std::string version() const = 0;
};

}  // namespace oval4d::fields
