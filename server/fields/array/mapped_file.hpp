#pragma once
// Files that are mapped into memory.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "errors/error.hpp"

namespace oval4d::fields {

/// An open file descriptor, which the destructor closes.
class FileHandle {
  public:
    /// Takes ownership of the descriptor. A negative descriptor means that there is no file.
    explicit FileHandle(int descriptor) : descriptor_(descriptor) {}
    ~FileHandle();
    FileHandle(const FileHandle&) = delete;
    FileHandle& operator=(const FileHandle&) = delete;

    int descriptor() const { return descriptor_; }
    /// Returns the present size of the file in bytes; 0 if the size is unknown.
    std::size_t size() const;

  private:
    int descriptor_;
};

/// A file that is mapped into memory. The system reads only the pages that are used, and can drop pages when it needs
/// memory.
///
/// An access to a page raises SIGBUS if another process has shortened the file, or if a network or a disk fails. A
/// check of the size cannot prevent this, because the file may be shortened between the check and the access. Copying
/// each page before it is used would make sampling slower and need a cache.
///
/// Therefore a handler of SIGBUS replaces the whole mapping by zeros, marks the file as lost, and lets the thread
/// continue. Wayland compositors treat the shared memory of their clients in the same way. A bus error at an address
/// outside of all mapped files ends the process, as it does without the handler.
class MappedFile {
  public:
    enum class MappingAccess : bool { read, write };

    /// Maps an open file, which stays open as long as this object exists. Errors: `bad_field` if the file is not a
    /// regular file, or is empty; `too_large` if there is no room in the address space, or if too many files are
    /// mapped; `internal` if the system cannot map the file.
    static Result<std::shared_ptr<const MappedFile>> map(std::shared_ptr<const FileHandle> file);
    /// Maps an open file as map() does, but for reading and writing.
    static Result<std::shared_ptr<MappedFile>> mapForWriting(std::shared_ptr<const FileHandle> file);
    /// Maps an open file as map(file) does, but does not keep it open: the caller may close `descriptor` after the
    /// call. The result's descriptor() returns −1.
    static Result<std::shared_ptr<const MappedFile>> map(int descriptor);

    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    std::span<const std::byte> bytes() const { return {at_, size_}; }
    /// Returns the bytes for reading and writing. The file must have been mapped by mapForWriting().
    std::span<std::byte> writableBytes() { return {at_, size_}; }
    int descriptor() const { return file_ ? file_->descriptor() : -1; }

    /// Returns whether a part of the file could not be read; all of bytes() are then 0. If this object keeps the file
    /// open, also returns true if the file has been modified since it was mapped, or is shorter than the mapping.
    bool isLost() const;

    /// Removes the file's pages from the memory of this process. The pages stay in the system's page cache, so the next
    /// access is fast. Thread-safe.
    void releasePages() const;

  private:
    MappedFile(std::byte* at, std::size_t size, std::shared_ptr<const FileHandle> file, std::size_t entry)
        : at_(at), size_(size), file_(std::move(file)), entry_(entry) {}
    static Result<std::shared_ptr<MappedFile>> mapAs(MappingAccess access, int descriptor,
                                                     std::shared_ptr<const FileHandle> file);

    std::byte* const at_;
    const std::size_t size_;
    const std::shared_ptr<const FileHandle> file_;  // null if the file does not stay open
    const std::size_t entry_;                       // the index of this file in the list that the signal handler reads
};

using MappedFilePtr = std::shared_ptr<const MappedFile>;

}  // namespace oval4d::fields
