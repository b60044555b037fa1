#pragma once
// The files of a folder of which an array consists.

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

/// Returns a part of a file in a folder by the file's relative path, such as "temperature/c/0/0"; an empty optional if
/// there is no such file. Returns fewer bytes if the file ends before the part does. Errors: those of
/// FileContents::map(), and those of the place where the folder is.
using FolderFileReader =
    std::function<Result<std::optional<FileContents>>(const std::string& path, const FilePart& part)>;

/// A file that was found in a folder.
struct FoundFile {
    std::shared_ptr<const FileHandle> file;  ///< the open file; null if it cannot be opened where it is
    std::string bytes;                       ///< if `file` is null, the bytes of the part that was asked for
};

/// A folder of which the server gets the files for a process that parses them, and that may not open files itself.
/// Thread-safe.
class FolderFiles {
  public:
    virtual ~FolderFiles() = default;

    /// Finds a file by its relative path, and opens it or gets the bytes of `part`. Returns an empty optional if there
    /// is no such file, or if a name in the path is empty, "." or "..". If the bytes must be waited for, waits until
    /// `until` or until a stop is requested, and then returns an error.
    virtual Result<std::optional<FoundFile>> find(const std::string& path, const FilePart& part,
                                                  std::chrono::steady_clock::time_point until,
                                                  const std::stop_token& stop) const = 0;

    /// Returns a string that changes when the metadata of the folder's arrays change, as far as this is noticed.
    virtual std::string version() const = 0;
};

}  // namespace oval4d::fields
