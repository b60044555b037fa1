// Fuzzes PNG files. The input has one byte for the width of a picture, one byte for its height, and the text of its
// state. The PNG file made from them must have valid chunks, and must give back the text and the pixels. The text is
// then parsed as a state.

#include <png.h>
#include <zlib.h>

#include "image/png.hpp"
#include "support.hpp"

using namespace oval4d;
using fuzz::require;

namespace {

using Bytes = std::vector<std::uint8_t>;

std::uint32_t load32(const Bytes& bytes, std::size_t at) {
    return std::uint32_t{bytes[at]} << 24U | std::uint32_t{bytes[at + 1]} << 16U | std::uint32_t{bytes[at + 2]} << 8U |
           bytes[at + 3];
}

/// Returns the text in the iTXt chunk of a PNG file. Requires that every chunk is complete.
std::string stateTextIn(const Bytes& png) {
    constexpr std::string_view kHeader("oval4d\0\0\0\0\0", 11);
    std::string state;
    std::vector<std::string> names;
    std::size_t at = 8;
    while (at < png.size()) {
        require(png.size() - at >= 12, "a chunk has a head and a checksum");
        const std::size_t length = load32(png, at);
        require(length <= png.size() - at - 12, "a chunk is whole");
        names.emplace_back(png.begin() + at + 4, png.begin() + at + 8);
        const std::uint32_t checksum = crc32(0, png.data() + at + 4, static_cast<uInt>(length + 4));
        require(checksum == load32(png, at + 8 + length), "a chunk has its checksum");
        const std::string_view data = fuzz::textOf(png.data() + at + 8, length);
        if (names.back() == "iTXt") {
            require(data.starts_with(kHeader), "the state's chunk begins with its keyword");
            state = data.substr(kHeader.size());
        }
        at += length + 12;
    }
    require(names.size() >= 4 && names[0] == "IHDR" && names[1] == "iTXt" && names.back() == "IEND",
            "the chunks are in order");
    return state;
}

/// Returns the pixels that libpng decodes, without alpha.
Bytes pixelsIn(const Bytes& png, png_image& header) {
    header = {};
    header.version = PNG_IMAGE_VERSION;
    require(png_image_begin_read_from_memory(&header, png.data(), png.size()) != 0, "libpng reads it:", header.message);
    header.format = PNG_FORMAT_RGB;
    Bytes pixels(PNG_IMAGE_SIZE(header));
    require(png_image_finish_read(&header, nullptr, pixels.data(), 0, nullptr) != 0,
            "libpng reads it:", header.message);
    return pixels;
}

// Returns a length in pixels for an input byte. The bytes "LL" give a picture so large that it is encoded in two bands.
int lengthFrom(std::uint8_t byte) { return byte == 'L' ? 640 : 1 + byte % 64; }

}  // namespace

OVAL4D_FUZZER(frame) {
    if (size < 2) return 0;
    image::Image image{lengthFrom(data[0]), lengthFrom(data[1]), {}};
    const std::string_view text = fuzz::textOf(data + 2, size - 2);
    const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    for (std::size_t i = 0; i < 4 * pixels; ++i) image.pixels.push_back(data[i % size] ^ (i / size % 7));
    static image::PngEncoder encoder;
    static Bytes png;
    encoder.encode(image, text, png);
    require(stateTextIn(png) == text, "the state's text comes back");
    png_image header;
    const Bytes read = pixelsIn(png, header);
    require(static_cast<int>(header.width) == image.width && static_cast<int>(header.height) == image.height,
            "the size comes back");
    for (std::size_t i = 0; i < pixels; ++i) {
        const std::size_t row = i / image.width, column = i % image.width;
        // The rows of the image are stored from the bottom to the top.
        const std::size_t from = 4 * ((image.height - 1 - row) * image.width + column);
        require(std::equal(read.begin() + 3 * i, read.begin() + 3 * i + 3, image.pixels.begin() + from),
                "the pixels come back");
    }

    const auto set = wire::setCommandFromState(text);
    if (!set) {
        fuzz::requireSentence(set.error());
        return 0;
    }
    session::Session session;
    fuzz::execute(session, *set);
    fuzz::requireRoundTrip(session.current, session.loaded);
    return 0;
}
