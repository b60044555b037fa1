#include <algorithm>
#include <charconv>

#include "protocol/cpp/writer.hpp"

namespace oval4d::protocol {

namespace {

constexpr std::size_t kNumber = 32;  // more than any number takes, a separator included

char* put(char* at, double coordinate) { return std::to_chars(at, at + kNumber, static_cast<float>(coordinate)).ptr; }
char* put(char* at, std::uint32_t index) { return std::to_chars(at, at + kNumber, index).ptr; }

template <typename V>
char* putVector(char* at, const V& v) {
    *at++ = '[';
    for (int i = 0; i < V::length(); ++i) {
        if (i > 0) *at++ = ',';
        at = put(at, v[i]);
    }
    *at++ = ']';
    return at;
}

// "[" items "]", each item written by `write(at, item)` in at most `most` bytes.
template <typename List, typename Write>
void putArray(Buffer& buffer, const List& list, std::size_t most, Write write) {
    buffer.room(2 + list.size() * (most + 1));
    char* at = buffer.at();
    *at++ = '[';
    for (const auto& item : list) {
        at = write(at, item);
        *at++ = ',';
    }
    if (!list.empty()) --at;
    *at++ = ']';
    buffer.moveTo(at);
}

}  // namespace

void JsonWriter::open(char bracket) {
    separate();
    buffer_.put(bracket);
    comma_ = false;
}

void JsonWriter::close(char bracket) {
    buffer_.put(bracket);
    comma_ = true;
}

void JsonWriter::key(std::string_view name) {
    separate();
    buffer_.put('"');
    buffer_.put(name);
    buffer_.put("\":");
    comma_ = false;
}

void JsonWriter::value(double number) {
    separate();
    buffer_.room(kNumber);
    buffer_.moveTo(std::to_chars(buffer_.at(), buffer_.at() + kNumber, number).ptr);
}

void JsonWriter::value(std::uint64_t number) {
    separate();
    buffer_.room(kNumber);
    buffer_.moveTo(std::to_chars(buffer_.at(), buffer_.at() + kNumber, number).ptr);
}

void JsonWriter::value(std::int64_t number) {
    separate();
    buffer_.room(kNumber);
    buffer_.moveTo(std::to_chars(buffer_.at(), buffer_.at() + kNumber, number).ptr);
}

void JsonWriter::value(bool flag) {
    separate();
    buffer_.put(flag ? "true" : "false");
}

void JsonWriter::null() {
    separate();
    buffer_.put("null");
}

void JsonWriter::json(std::string_view text) {
    separate();
    buffer_.put(text);
}

void JsonWriter::value(std::string_view text) {
    constexpr std::string_view kHex = "0123456789abcdef";
    separate();
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
    separate();
    buffer_.room(4 * kNumber);
    buffer_.moveTo(putVector(buffer_.at(), v));
}

void JsonWriter::vectors(std::span<const glm::dvec3> list) {
    separate();
    putArray(buffer_, list, 4 * kNumber, [](char* at, const glm::dvec3& v) { return putVector(at, v); });
}

void JsonWriter::vectors(std::span<const glm::dvec4> list) {
    separate();
    putArray(buffer_, list, 5 * kNumber, [](char* at, const glm::dvec4& v) { return putVector(at, v); });
}

void JsonWriter::pairs(std::span<const Pair> list) {
    separate();
    putArray(buffer_, list, 2 * kNumber, [](char* at, const Pair& pair) {
        *at++ = '[';
        at = put(at, pair[0]);
        *at++ = ',';
        at = put(at, pair[1]);
        *at++ = ']';
        return at;
    });
}

void JsonWriter::triples(std::span<const Triple> list) {
    separate();
    putArray(buffer_, list, 3 * kNumber, [](char* at, const Triple& triple) {
        *at++ = '[';
        for (const std::uint32_t index : triple) {
            at = put(at, index);
            *at++ = ',';
        }
        at[-1] = ']';
        return at;
    });
}

void JsonWriter::numbers(std::span<const std::uint32_t> list) {
    separate();
    putArray(buffer_, list, kNumber, [](char* at, std::uint32_t index) { return put(at, index); });
}

void JsonWriter::lists(ListsView view) {
    beginArray();
    for (std::size_t i = 0; i + 1 < view.begin.size(); ++i) {
        numbers(view.items.subspan(view.begin[i] - view.begin[0], view.begin[i + 1] - view.begin[i]));
    }
    endArray();
}

void JsonWriter::picture(std::span<const std::uint8_t> pixels, std::size_t columns) {
    beginArray();
    for (std::size_t at = 0; at < pixels.size(); at += columns) {
        separate();
        putArray(buffer_, pixels.subspan(at, columns), 3,
                 [](char* to, std::uint8_t pixel) { return put(to, std::uint32_t{pixel}); });
    }
    endArray();
}

}  // namespace oval4d::protocol
