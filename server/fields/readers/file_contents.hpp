#pragma once
// The bytes of a file to be read, in memory or mapped.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "errors/error.hpp"
#include "fields/array/mapped_file.hpp"

namespace oval4d::fields {

/// A part of a file; by default, the whole file.
struct FilePart {
    static constexpr std::uint64_t kAll = std::numeric_limits<std::uint64_t>::max();

    std::uint64_t offset = 0;   ///< the offset of the part's first byte; ignored if `fromEnd` is true
    std::uint64_t size = kAll;  ///< the size in bytes; a part beyond the end of the file is cut off there
    bool fromEnd = false;       ///< whether the part consists of the last `size` bytes of the file

    bool isWhole() const { return size == kAll && (offset == 0 || fromEnd); }
};

/// The bytes of a file. Copies share the bytes.
struct FileContents {
    std::shared_ptr<const void> owner;  ///< keeps the bytes valid
    std::span<const std::byte> bytes;
    MappedFilePtr file = {};  ///< the mapped file that contains the bytes; null if they are in memory

    /// Releases the resident pages of the mapped file (see MappedFile::releasePages()), if the bytes are in one.
    void releasePages() const {
        if (file) file->releasePages();
    }

    /// Returns the bytes of a part, without those beyond the end of the file.
    FileContents partialContents(const FilePart& part) const;

    /// Returns contents that own a copy of `bytes`.
    static FileContents copyOf(std::string_view bytes);
    /// Returns contents that own `bytes`.
    static FileContents ofBytes(std::vector<std::byte> bytes);
    /// Returns contents that own `bytes`.
    static FileContents ofString(std::string bytes);
    /// Returns the bytes of a mapped file.
    static FileContents ofMappedFile(MappedFilePtr file);
    /// Maps the open file with the descriptor `file`, which the caller may close afterward. Errors: those of
    /// MappedFile::map().
    static Result<FileContents> map(int file);
    /// Maps a file. Errors: those of map(int), and `not_found`.
    static Result<FileContents> map(const std::filesystem::path& path);
};

}  // namespace oval4d::fields
