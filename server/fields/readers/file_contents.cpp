#include "fields/readers/file_contents.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace oval4d::fields {

FileContents FileContents::partialContents(const FilePart& part) const {
    const std::uint64_t whole = bytes.size();
    const std::uint64_t first = part.fromEnd ? whole - std::min(whole, part.size) : std::min(whole, part.offset);
    return {owner, bytes.subspan(first, std::min(whole - first, part.size)), file};
}

FileContents FileContents::copyOf(std::string_view bytes) {
    const auto view = std::as_bytes(std::span(bytes));
    return ofBytes({view.begin(), view.end()});
}

FileContents FileContents::ofBytes(std::vector<std::byte> bytes) {
    auto owned = std::make_shared<const std::vector<std::byte>>(std::move(bytes));
    const std::span<const std::byte> view = *owned;
    return {std::move(owned), view};
}

FileContents FileContents::ofString(std::string bytes) {
    auto owned = std::make_shared<const std::string>(std::move(bytes));
    const std::span<const std::byte> view = std::as_bytes(std::span(*owned));
    return {std::move(owned), view};
}

FileContents FileContents::ofMappedFile(MappedFilePtr file) {
    const std::span<const std::byte> bytes = file->bytes();
    return {file, bytes, file};
}

Result<FileContents> FileContents::map(int file) {
    auto mapped = MappedFile::map(file);
    if (!mapped) return mapped.error();
    return ofMappedFile(std::move(*mapped));
}

Result<FileContents> FileContents::map(const std::filesystem::path& path) {
    // O_NONBLOCK is for named pipes: without it, opening a pipe waits until another process writes to it.
    const FileHandle file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.descriptor() < 0)
        return Error{ErrorCode::not_found, "the file cannot be opened: " + std::generic_category().message(errno)};
    return map(file.descriptor());
}

}  // namespace oval4d::fields
