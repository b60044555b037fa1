#include "text_files/plain_text.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include <boost/locale/encoding_utf.hpp>

#include "text/words.hpp"
#include "text_files/file_error.hpp"

namespace oval4d::text_files {

namespace {

using namespace std::string_view_literals;

/// A kind of file that is refused. A file of this kind begins with the bytes `signature`. `description` completes the
/// error message "the file …".
struct RefusedFileKind {
    std::string_view signature, description;
};
constexpr auto kKinds = std::to_array<RefusedFileKind>({
    {"\x1F\x8B"sv, "is compressed with gzip; unpack it first"},
    {"BZh"sv, "is compressed with bzip2; unpack it first"},
    {"\xFD"
     "7zXZ"sv,
     "is compressed with xz; unpack it first"},
    {"\x28\xB5\x2F\xFD"sv, "is compressed with zstd; unpack it first"},
    {"PK\x03\x04"sv, "is a zip archive, such as a spreadsheet or a 3MF file; save it as text first"},
    {"7z\xBC\xAF\x27\x1C"sv, "is a 7z archive; unpack it first"},
    {"\x89PNG\r\n\x1A\n"sv, "is a PNG picture"},
    {"\xFF\xD8\xFF"sv, "is a JPEG picture"},
    {"GIF8"sv, "is a GIF picture"},
    {"RIFF"sv, "is a RIFF file, such as a WebP picture or a sound"},
    {"%PDF-"sv, "is a PDF file"},
    {"\xD0\xCF\x11\xE0"sv, "is an old Office file; save it as text first"},
    {"\x7F"
     "ELF"sv,
     "is a program"},
    {"glTF"sv, "is a GLB file of a three-dimensional model"},
    {"\xFF\xFE\0\0"sv, "is text in UTF-32; save it in UTF-8"},
    {"\0\0\xFE\xFF"sv, "is text in UTF-32; save it in UTF-8"},
});

/// Kinds of text files that are refused. decodePlainText() compares the start of a text, in lowercase, with these
/// signatures. The first signature must be the longest one, because its length is the number of characters that
/// decodePlainText() compares.
constexpr auto kTextKinds = std::to_array<RefusedFileKind>({
    {"<!doctype html", "is an HTML page"},
    {"<html", "is an HTML page"},
    {"<svg", "is an SVG picture"},
    {"<?xml", "is an XML file, such as an SVG picture or a VTK file"},
});

constexpr std::string_view kMarkUtf8 = "\xEF\xBB\xBF", kMarkLittle = "\xFF\xFE", kMarkBig = "\xFE\xFF";

// Converts UTF-16 to UTF-8. `low` is the index of the low byte in each 16-bit unit: 0 for little-endian text, 1 for
// big-endian text. Ignores the last byte of an odd number of bytes.
std::string fromUtf16(std::string_view bytes, std::size_t low) {
    std::u16string units(bytes.size() / 2, u'\0');
    for (std::size_t i = 0; i < units.size(); ++i) {
        const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(bytes[2 * i + at]); };
        units[i] = static_cast<char16_t>(byte(low) | byte(1 - low) << 8U);
    }
    return boost::locale::conv::utf_to_utf<char>(units);
}

// Returns the number of bytes of the space at the beginning of a text; 0 if there is none. Spaces are a vertical tab, a
// form feed, a byte order mark, a zero-width space, and the spaces that text::leadingUnicodeSpaceLength() recognizes.
std::size_t spaceAt(std::string_view text) {
    for (const std::string_view space : {"\v"sv, "\f"sv, "\xEF\xBB\xBF"sv, "\xE2\x80\x8B"sv}) {
        if (text.starts_with(space)) return space.size();
    }
    return text::leadingUnicodeSpaceLength(text);
}

// Replaces the line ends CR LF and CR by LF. Replaces each space that spaceAt() recognizes by U+0020.
void normalizeSpace(std::string& text) {
    constexpr auto kStarts = "\r\v\f\xC2\xE2\xE3\xEF"sv;
    if (text.find_first_of(kStarts) == std::string::npos) return;
    std::string result;
    result.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::string_view rest = std::string_view(text).substr(i);
        if (kStarts.find(text[i]) == std::string_view::npos) {
            result += text[i];
        } else if (const std::size_t space = spaceAt(rest); space > 0) {
            result += ' ';
            i += space - 1;
        } else if (text[i] != '\r') {
            result += text[i];
        } else if (!rest.starts_with("\r\n")) {
            result += '\n';
        }
    }
    text = std::move(result);
}

}  // namespace

std::string decodePlainText(std::string_view bytes) {
    for (const RefusedFileKind& kind : kKinds) {
        if (bytes.starts_with(kind.signature)) throwFileError(0, "the file " + std::string(kind.description));
    }
    std::string text;
    if (bytes.starts_with(kMarkLittle)) {
        text = fromUtf16(bytes.substr(kMarkLittle.size()), 0);
    } else if (bytes.starts_with(kMarkBig)) {
        text = fromUtf16(bytes.substr(kMarkBig.size()), 1);
    } else if (bytes.size() >= 2 && (bytes[0] == 0) != (bytes[1] == 0)) {
        text = fromUtf16(bytes, bytes[0] == 0 ? 1 : 0);
    } else {
        if (bytes.starts_with(kMarkUtf8)) bytes.remove_prefix(kMarkUtf8.size());
        text = bytes;
    }
    normalizeSpace(text);
    if (text.find_first_not_of(" \t\n") == std::string::npos) throwFileError(0, "the file is empty");
    if (const std::size_t zero = text.find('\0'); zero != std::string::npos)
        throwFileError(0, "the file is not text: byte " + std::to_string(zero + 1) + " is zero");
    std::string start = text.substr(text.find_first_not_of(" \t\n"), kTextKinds.front().signature.size());
    std::ranges::transform(start, start.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    for (const RefusedFileKind& kind : kTextKinds) {
        if (start.starts_with(kind.signature)) throwFileError(0, "the file " + std::string(kind.description));
    }
    return text;
}

}  // namespace oval4d::text_files
