#include "wire/json_parser.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <system_error>
#include <utility>
#include <vector>

#include "text/ascii.hpp"
#include "text/message_text.hpp"

namespace oval4d::wire {

namespace {

using nlohmann::json;

// The maximum number of values in a message, far above what valid messages contain. The limit also bounds the memory of
// the validator if every value has an error.
constexpr std::size_t kMaxValues = 10'000;

// A handler of nlohmann-json's parser events that builds a value. Stops parsing if the text is nested too deeply or has
// too many values.
class JsonValueBuilder {
  public:
    JsonValueBuilder(json& root, int maxDepth) : root_(root), maxDepth_(maxDepth) {}

    bool null() { return add(nullptr); }
    bool boolean(bool value) { return add(value); }
    bool number_integer(std::int64_t value) { return add(value); }
    bool number_unsigned(std::uint64_t value) { return add(value); }
    bool number_float(double value, const std::string& /*text*/) {
        constexpr double kExact = 9007199254740992;  // 2^53, up to which doubles represent all integers
        const bool whole =
            std::abs(value) <= kExact && value == std::trunc(value) && !(value == 0 && std::signbit(value));
        return whole ? add(static_cast<std::int64_t>(value)) : add(value);
    }
    bool string(std::string& value) { return add(std::move(value)); }
    bool binary(json::binary_t& /*value*/) { return false; }  // never called, because JSON text has no binary values

    bool start_object(std::size_t /*size*/) { return openContainer(json::object()); }
    bool start_array(std::size_t /*size*/) { return openContainer(json::array()); }
    bool end_object() { return closeContainer(); }
    bool end_array() { return closeContainer(); }
    bool key(std::string& name) {
        key_ = std::move(name);
        return true;
    }
    bool parse_error(std::size_t position, const std::string& token, const nlohmann::detail::exception& error) {
        position_ = position;
        token_ = token;
        overflow_ = error.id == 406;  // the error id of nlohmann-json for a number that is too large for a double
        return false;
    }

    /// Returns the error message for the limit that the text exceeds; empty if it exceeds no limit.
    const std::string& limitMessage() const { return refusal_; }
    bool hasOverflow() const { return overflow_; }
    std::size_t errorPosition() const { return position_; }
    const std::string& token() const { return token_; }

  private:
    template <typename T>
    bool add(T&& value) {
        return insertValue(json(std::forward<T>(value))) != nullptr;
    }
    json* insertValue(json&& value) {
        if (++values_ > kMaxValues) {
            refusal_ = "the message holds too many values; at most " + std::to_string(kMaxValues) + " are allowed";
            return nullptr;
        }
        if (open_.empty()) return &(root_ = std::move(value));
        json& parent = *open_.back();
        if (parent.is_object()) return &(parent[key_] = std::move(value));
        return &parent.emplace_back(std::move(value));
    }
    bool openContainer(json&& empty) {
        if (open_.size() == static_cast<std::size_t>(maxDepth_)) {
            refusal_ = "the message nests too deeply; at most " + std::to_string(maxDepth_) + " levels are allowed";
            return false;
        }
        // The address of the new value stays valid while the value is open: until it is closed, its parent gets no
        // other element.
        json* placed = insertValue(std::move(empty));
        if (placed) open_.push_back(placed);
        return placed != nullptr;
    }
    bool closeContainer() {
        open_.pop_back();
        return true;
    }

    json& root_;
    int maxDepth_;
    std::vector<json*> open_;
    std::string key_;
    bool overflow_ = false;
    std::string refusal_;
    std::size_t values_ = 0;
    std::size_t position_ = 0;
    std::string token_;
};

constexpr auto kNotFinite = std::to_array<std::string_view>({"NaN", "Infinity", "-Infinity"});

// Returns the token at which the parser stopped, if it is NaN, Infinity, -Infinity or a number too large for a double.
// Otherwise returns an empty string.
std::string_view badNumberAt(std::string_view text, const JsonValueBuilder& builder) {
    if (builder.errorPosition() == 0 || builder.errorPosition() > text.size()) return {};
    if (builder.hasOverflow())
        return text.substr(builder.errorPosition() - builder.token().size(), builder.token().size());
    const std::size_t start = builder.errorPosition() - (builder.token().starts_with('-') ? 2 : 1);
    if (start >= text.size()) return {};
    for (const std::string_view name : kNotFinite) {
        if (text.substr(start).starts_with(name)) return text.substr(start, name.size());
    }
    return {};
}

// Returns whether a word is NaN, Infinity, -Infinity or a number too large for a double.
bool isBadNumber(std::string_view word) {
    if (std::ranges::find(kNotFinite, word) != kNotFinite.end()) return true;
    double value = 0;
    const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool tooSmall = word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos;
    return fault == std::errc::result_out_of_range && end == word.data() + word.size() && !tooSmall;
}

// Returns the length of the string literal at the start of the text, including both quotation marks. If the string does
// not end, returns the length of the text.
std::size_t lengthOfString(std::string_view text) {
    for (std::size_t i = 1; i < text.size(); ++i) {
        if (text[i] == '"') return i + 1;
        if (text[i] == '\\') ++i;
    }
    return text.size();
}

// Returns the length of the word at the start of the text. A word consists of letters, digits, signs and points.
std::size_t lengthOfWord(std::string_view text) {
    const auto inWord = [](char c) {
        return text::isLetter(c) || text::isDigit(c) || c == '+' || c == '-' || c == '.';
    };
    return static_cast<std::size_t>(std::ranges::find_if_not(text, inWord) - text.begin());
}

// Returns the text with null in place of NaN, Infinity, -Infinity and numbers too large for a double, except in
// strings. Takes linear time, because the text may come from an attacker.
std::string replaceNonFiniteByNull(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        const std::string_view rest = text.substr(i);
        const std::size_t word = lengthOfWord(rest);
        const std::size_t length = word > 0 ? word : rest.front() == '"' ? lengthOfString(rest) : 1;
        out += isBadNumber(rest.substr(0, word)) ? std::string_view("null") : rest.substr(0, length);
        i += length;
    }
    return out;
}

// Returns the UTF-16 code unit of the escape at the start of the text: a backslash, u and four hexadecimal digits (RFC
// 8259, section 7). Returns 0 if the text does not begin with such an escape. The escape of U+0000 also gives 0, which
// does not matter here, because callers look for surrogates.
unsigned escapedUnit(std::string_view text) {
    constexpr std::size_t kLength = 6;
    unsigned unit = 0;
    if (text.size() < kLength || !text.starts_with("\\u")) return 0;
    const auto [end, fault] = std::from_chars(text.data() + 2, text.data() + kLength, unit, 16);
    return fault == std::errc{} && end == text.data() + kLength ? unit : 0;
}

// Returns the text with U+FFFD in place of each escape of a lone surrogate, which is not a character (RFC 8259, section
// 8.2). Sets `first` to the position of the first such escape, or to npos if there is none.
std::string withoutLoneSurrogates(std::string_view text, std::size_t& first) {
    constexpr std::size_t kLength = 6;
    const auto isBetween = [](unsigned unit, unsigned least, unsigned most) { return unit >= least && unit <= most; };
    std::string out;
    first = std::string_view::npos;
    for (std::size_t i = 0; i < text.size();) {
        const unsigned unit = escapedUnit(text.substr(i));
        std::size_t length = text[i] == '\\' ? 2 : 1;
        if (isBetween(unit, 0xD800, 0xDFFF)) {
            const unsigned next = escapedUnit(text.substr(i + kLength));
            const bool isPair = unit < 0xDC00 && isBetween(next, 0xDC00, 0xDFFF);
            length = isPair ? 2 * kLength : kLength;
            if (!isPair) {
                first = std::min(first, i);
                out += "\\ufffd";
                i += length;
                continue;
            }
        }
        out += text.substr(i, length);
        i += length;
    }
    return out;
}

}  // namespace

ParsedJson parseJson(std::string_view text, int maxDepth) {
    ParsedJson result;
    JsonValueBuilder builder(result.value, maxDepth);
    if (json::sax_parse(text.begin(), text.end(), &builder)) return result;
    if (!builder.limitMessage().empty()) {
        result.fault = builder.limitMessage();
        return result;
    }
    const std::string_view number = badNumberAt(text, builder);
    std::size_t surrogate = 0;
    const std::string characters = withoutLoneSurrogates(text, surrogate);
    if (number.empty() && surrogate < builder.errorPosition()) {
        result.fault = "the escape " + std::string(text.substr(surrogate, 6)) + " at byte " +
                       std::to_string(surrogate + 1) + " is a lone surrogate, which is no character";
        const std::string repaired = replaceNonFiniteByNull(characters);
        JsonValueBuilder again(result.value, maxDepth);
        result.repaired = json::sax_parse(repaired.begin(), repaired.end(), &again);
        result.notJson = !result.repaired && again.limitMessage().empty();
        return result;
    }
    if (number.empty()) {
        result.fault = "the text is not JSON: unexpected " +
                       (builder.errorPosition() > text.size() ? std::string("end") : text::inQuotes(builder.token())) +
                       " at byte " + std::to_string(builder.errorPosition()) +
                       "; a message is one JSON object such as {\"type\":\"undo\"}";
        result.notJson = true;
        return result;
    }
    result.fault = std::string(number) + (builder.hasOverflow() ? " is too large for a number" : " is not JSON") +
                   " (byte " + std::to_string(static_cast<std::size_t>(number.data() - text.data()) + 1) +
                   "); numbers must be finite";
    // The message is refused, but parse all of it, so that the answer can contain the message's id.
    const std::string repaired = replaceNonFiniteByNull(characters);
    JsonValueBuilder again(result.value, maxDepth);
    result.repaired = json::sax_parse(repaired.begin(), repaired.end(), &again);
    result.notJson = !result.repaired && again.limitMessage().empty();
    return result;
}

}  // namespace oval4d::wire
