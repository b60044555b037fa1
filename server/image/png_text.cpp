#include "image/png_text.hpp"

#include <cstddef>
#include <cstdint>

namespace oval4d::image {

namespace {

constexpr std::string_view kPngStart("\x89PNG\r\n\x1a\n", 8);
// The start of the data of the iTXt chunk: the keyword, a zero that ends the keyword, and the compression flag 0 for
// "not compressed". The compression method, a language tag and a translated keyword follow.
constexpr std::string_view kKeyword("oval4d\0\0", 8);

std::uint32_t readBigEndian32(std::string_view bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8U | static_cast<unsigned char>(bytes[i]);
    return value;
}

}  // namespace

bool isPng(std::string_view file) { return file.starts_with(kPngStart); }

std::optional<std::string_view> stateTextIn(std::string_view file) {
    if (!isPng(file)) return {};
    file.remove_prefix(kPngStart.size());
    // The number of bytes of a chunk besides its data: 4 each for its length, type and checksum.
    constexpr std::size_t kAround = 12;
    while (file.size() >= kAround) {
        const std::size_t length = readBigEndian32(file);
        if (length > file.size() - kAround) return {};
        std::string_view data = file.substr(8, length);
        if (file.substr(4, 4) == "iTXt" && data.starts_with(kKeyword)) {
            const std::size_t languageEnd = data.find('\0', kKeyword.size() + 1);
            const std::size_t translationEnd =
                languageEnd == std::string_view::npos ? languageEnd : data.find('\0', languageEnd + 1);
            if (translationEnd == std::string_view::npos) return {};
            return data.substr(translationEnd + 1);
        }
        file.remove_prefix(length + kAround);
    }
    return {};
}

}  // namespace oval4d::image
