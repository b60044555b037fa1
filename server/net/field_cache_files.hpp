#pragma once
// Files with the converted samples of large fields. The files from which these fields come cannot be mapped into memory
// as they are.

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "errors/error.hpp"
#include "fields/array/mapped_file.hpp"

namespace oval4d::net {

/// The field cache on the disk (option --field-cache). It consists of unnamed files and has a limit on their total
/// size. The system deletes a file when the last reference to it is gone, at the latest when the server ends or
/// crashes. Thread-safe.
class FieldCacheFiles {
  public:
    /// `folder` is the folder of the files. If it is empty, the folder is /var/tmp, which is on a disk even where /tmp
    /// is in memory. `bytes` is the maximum total size of the files.
    FieldCacheFiles(const std::string& folder, std::size_t bytes);

    using FilePtr = std::shared_ptr<const fields::FileHandle>;

    /// Returns a new file of `bytes` bytes. Reserves its space on the disk if the file system can do so; writing to the
    /// file then cannot fail for lack of space. Returns a null pointer if only the total size of all files would exceed
    /// the limit. This object must outlive the file. Errors: `too_large` if the file alone exceeds the limit;
    /// `internal` if it cannot be made; `too_many` if the disk is full.
    Result<FilePtr> allocateFile(std::size_t bytes);

    /// Returns the total size of all files, in bytes.
    std::size_t diskBytes() const { return bytes_; }

  private:
    const std::filesystem::path folder_;
    const std::size_t maxBytes_;
    std::atomic<std::size_t> bytes_ = 0;
};

}  // namespace oval4d::net
