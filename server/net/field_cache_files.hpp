#pragma once
// Files of samples, for fields of the data folder that are too large for memory and cannot be mapped as they are.

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "errors/error.hpp"
#include "fields/array/mapped_file.hpp"

namespace oval4d::net {

/// The field cache on the disk (--field-cache): unnamed files, with a limit on their total size. The system deletes
/// each file when the last reference to it is gone, at the latest when the server ends, even by a crash. Thread-safe.
class FieldCacheFiles {
  public:
    /// `folder`: empty for /var/tmp, which is on a disk even where /tmp is in memory. `bytes`: the maximum total size
    /// of the files.
    FieldCacheFiles(const std::string& folder, std::size_t bytes);

    using FilePtr = std::shared_ptr<const fields::FileHandle>;

    /// Returns a new file of this size. Reserves its space on the disk if the file system can do so, so that writing to
    /// it cannot fail for lack of space. Returns a null pointer if this size is within the limit, but the total size of
    /// all files would exceed it. This object must outlive the file. Errors: `too_large` if the file is larger than the
    /// limit; `internal` if it cannot be made; `too_many` if the disk is full.
    Result<FilePtr> allocateFile(std::size_t bytes);

    /// Returns the size of all files, in bytes.
    std::size_t diskBytes() const { return bytes_; }

  private:
    const std::filesystem::path folder_;
    const std::size_t maxBytes_;
    std::atomic<std::size_t> bytes_ = 0;
};

}  // namespace oval4d::net
