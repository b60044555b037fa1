#include "wire/json_writer.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "text/decimal.hpp"

namespace oval4d::wire {

namespace {

// The number of bytes that value() reserves for one number. The longest number has fewer bytes.
constexpr std::size_t kMaxNumberLength = 32;

// Returns the number of bytes to reserve for an array of `numbers` coordinates or indices, including brackets and
// commas.
std::size_t bytesToReserve(std::size_t numbers) { return (numbers + 2) * text::kBytesPerNumber; }

// Writes numbers, each with a comma after it. Returns the end of the text.
char* putIntegers(char* at, std::span<const std::uint32_t> list) {
    for (const std::uint32_t number : list) {
        at = text::putInteger(at, number);
        *at++ = ',';
    }
    return at;
}

// Writes "],[", the separator of two arrays, and returns the end of these three bytes. Also overwrites the byte after
// them.
char* putArraySeparator(char* at) {
    std::memcpy(at, "],[", 4);
    return at + 3;
}

}  // namespace

void JsonWriter::openBracket(char bracket) {
    writeCommaIfNeeded();
    buffer_.put(bracket);
    comma_ = false;
}

void JsonWriter::closeContainer(char bracket) {
    buffer_.put(bracket);
    comma_ = true;
}

void JsonWriter::value(double number) {
    writeCommaIfNeeded();
    buffer_.reserveMore(kMaxNumberLength);
    char* const end = buffer_.at() + kMaxNumberLength;
    // Convert integers separately: for 1000000, to_chars of a double would write 1e+06.
    buffer_.setEnd(text::isExactInteger(number)
                       ? std::to_chars(buffer_.at(), end, static_cast<std::int64_t>(number)).ptr
                       : std::to_chars(buffer_.at(), end, number).ptr);
}

void JsonWriter::value(std::uint64_t number) {
    writeCommaIfNeeded();
    buffer_.reserveMore(kMaxNumberLength);
    buffer_.setEnd(std::to_chars(buffer_.at(), buffer_.at() + kMaxNumberLength, number).ptr);
}

void JsonWriter::value(std::int64_t number) {
    writeCommaIfNeeded();
    buffer_.reserveMore(kMaxNumberLength);
    buffer_.setEnd(std::to_chars(buffer_.at(), buffer_.at() + kMaxNumberLength, number).ptr);
}

void JsonWriter::value(bool flag) {
    writeCommaIfNeeded();
    buffer_.put(flag ? "true" : "false");
}

void JsonWriter::null() {
    writeCommaIfNeeded();
    buffer_.put("null");
}

void JsonWriter::raw(std::string_view text) {
    writeCommaIfNeeded();
    buffer_.put(text);
}

void JsonWriter::value(std::string_view text) {
    constexpr std::string_view kHex = "0123456789abcdef";
    writeCommaIfNeeded();
    buffer_.put('"');
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            buffer_.put('\\');
            buffer_.put(c);
        } else if (byte < 0x20) {
            buffer_.put("\\u00");
            buffer_.put(kHex[byte >> 4U]);
            buffer_.put(kHex[byte & 0xFU]);
        } else {
            buffer_.put(c);
        }
    }
    buffer_.put('"');
}

void JsonWriter::vector(const glm::dvec3& v) {
    writeCommaIfNeeded();
    buffer_.reserveMore(bytesToReserve(3));
    buffer_.setEnd(text::putVectorsAsJson(buffer_.at(), std::span(&v, 1)));
}

// Writes an array of `numbers` numbers. `put(at)` writes the content at `at`, and returns its end.
template <typename Put>
void JsonWriter::numberArray(std::size_t numbers, Put put) {
    writeCommaIfNeeded();
    buffer_.reserveMore(bytesToReserve(numbers));
    char* at = buffer_.at();
    *at++ = '[';
    at = put(at);
    *at++ = ']';
    buffer_.setEnd(at);
}

void JsonWriter::floatsForPictures(std::span<const float> list) {
    constexpr double kDecimals = 1e4;
    beginArray();
    for (const float number : list) value(std::round(number * kDecimals) / kDecimals);
    endArray();
}

void JsonWriter::vectors(std::span<const glm::vec3> list) {
    numberArray(3 * list.size(), [list](char* at) {
        constexpr std::size_t kBatch = 256;
        std::array<glm::dvec3, kBatch> doubles;
        for (std::size_t begin = 0; begin < list.size(); begin += kBatch) {
            const auto batch = list.subspan(begin, std::min(kBatch, list.size() - begin));
            std::ranges::transform(batch, doubles.begin(), [](const glm::vec3& v) { return glm::dvec3(v); });
            if (begin > 0) *at++ = ',';
            at = text::putVectorsAsJson(at, std::span(std::as_const(doubles)).first(batch.size()));
        }
        return at;
    });
}

void JsonWriter::vectors(std::span<const glm::dvec3> list) {
    numberArray(3 * list.size(), [list](char* at) { return text::putVectorsAsJson(at, list); });
}

void JsonWriter::vectors(std::span<const glm::dvec4> list) {
    numberArray(4 * list.size(), [list](char* at) { return text::putVectorsAsJson(at, list); });
}

template <std::size_t Size>
void JsonWriter::tuples(std::span<const std::array<std::uint32_t, Size>> list) {
    numberArray(Size * list.size(), [list](char* at) {
        if (list.empty()) return at;
        *at++ = '[';
        for (const auto& tuple : list) at = putArraySeparator(putIntegers(at, tuple) - 1);
        return at - 2;
    });
}

void JsonWriter::pairs(std::span<const IndexPair> list) { tuples(list); }
void JsonWriter::triples(std::span<const IndexTriple> list) { tuples(list); }

void JsonWriter::numbers(std::span<const std::uint32_t> list) {
    numberArray(list.size(), [list](char* at) { return list.empty() ? at : putIntegers(at, list) - 1; });
}

void JsonWriter::jaggedArray(JaggedArrayView view) {
    numberArray(view.begin.size() + view.items.size(), [&view](char* at) {
        if (view.begin.size() < 2) return at;
        *at++ = '[';
        for (std::size_t i = 0; i + 1 < view.begin.size(); ++i) {
            const auto list = view.items.subspan(view.begin[i] - view.begin[0], view.begin[i + 1] - view.begin[i]);
            at = putArraySeparator(putIntegers(at, list) - (list.empty() ? 0 : 1));
        }
        return at - 2;
    });
}

void JsonWriter::image(std::span<const std::uint8_t> pixels, std::size_t columns) {
    numberArray(2 * pixels.size(), [=](char* at) {
        if (pixels.empty()) return at;
        *at++ = '[';
        for (std::size_t row = 0; row < pixels.size(); row += columns) {
            for (const std::uint8_t pixel : pixels.subspan(row, columns)) {
                at = text::putInteger(at, pixel);
                *at++ = ',';
            }
            at = putArraySeparator(at - 1);
        }
        return at - 2;
    });
}

}  // namespace oval4d::wire
