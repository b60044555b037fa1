#include "wire/json_parser.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "text/message_text.hpp"

namespace oval4d::wire {

namespace {

using nlohmann::json;

// No valid message contains nearly as many values. Limits the memory that the validator needs if every value has an
// error.
constexpr std::size_t kMaxValues = 10'000;

// Builds a value from the events of nlohmann-json's parser. Stops if the text nests too deeply or has too many values.
class Builder {
  public:
    Builder(json& root, int maxDepth) : root_(root), maxDepth_(maxDepth) {}

    bool null() { return add(nullptr); }
    bool boolean(bool value) { return add(value); }
    bool number_integer(std::int64_t value) { return add(value); }
    bool number_unsigned(std::uint64_t value) { return add(value); }
    bool number_float(double value, const std::string& /*text*/) {
        constexpr double kExact = 9007199254740992;  // 2^53
        const bool whole =
            std::abs(value) <= kExact && value == std::trunc(value) && !(value == 0 && std::signbit(value));
        return whole ? add(static_cast<std::int64_t>(value)) : add(value);
    }
    bool string(std::string& value) { return add(std::move(value)); }
    bool binary(json::binary_t& /*value*/) { return false; }  // does not occur in JSON text

    bool start_object(std::size_t /*size*/) { return open(json::object()); }
    bool start_array(std::size_t /*size*/) { return open(json::array()); }
    bool end_object() { return close(); }
    bool end_array() { return close(); }
    bool key(std::string& name) {
        key_ = std::move(name);
        return true;
    }
    bool parse_error(std::size_t position, const std::string& token, const nlohmann::detail::exception& error) {
        position_ = position;
        token_ = token;
        overflow_ = error.id == 406;  // nlohmann-json's error id for a number that overflows
        return false;
    }

    /// Returns a message about the limit that the text exceeds; empty if it exceeds none.
    const std::string& refusal() const { return refusal_; }
    bool overflow() const { return overflow_; }
    std::size_t position() const { return position_; }
    const std::string& token() const { return token_; }

  private:
    template <typename T>
    bool add(T&& value) {
        return place(json(std::forward<T>(value))) != nullptr;
    }
    json* place(json&& value) {
        if (++values_ > kMaxValues) {
            refusal_ = "the message holds too many values; at most " + std::to_string(kMaxValues) + " are allowed";
            return nullptr;
        }
        if (open_.empty()) return &(root_ = std::move(value));
        json& parent = *open_.back();
        if (parent.is_object()) return &(parent[key_] = std::move(value));
        return &parent.emplace_back(std::move(value));
    }
    bool open(json&& empty) {
        if (open_.size() == static_cast<std::size_t>(maxDepth_)) {
            refusal_ = "the message nests too deeply; at most " + std::to_string(maxDepth_) + " levels are allowed";
            return false;
        }
        // The address stays valid: an array grows only while none of its elements is open.
        json* placed = place(std::move(empty));
        if (placed) open_.push_back(placed);
        return placed != nullptr;
    }
    bool close() {
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

// Returns the token at which the parser stopped if it is NaN, ±Infinity or a number too large for a double; else an
// empty string.
std::string_view badNumberAt(std::string_view text, const Builder& builder) {
    if (builder.position() == 0 || builder.position() > text.size()) return {};
    if (builder.overflow()) return text.substr(builder.position() - builder.token().size(), builder.token().size());
    const std::size_t start = builder.position() - (builder.token().starts_with('-') ? 2 : 1);
    if (start >= text.size()) return {};
    for (const std::string_view name : std::to_array<std::string_view>({"NaN", "Infinity", "-Infinity"})) {
        if (text.substr(start).starts_with(name)) return text.substr(start, name.size());
    }
    return {};
}

constexpr int kMaxRepairs = 4;  // the maximum number of numbers that are replaced by null

}  // namespace

ParsedJson parseJson(std::string_view text, int maxDepth) {
    ParsedJson result;
    std::string repaired;
    std::string_view rest = text;
    for (int repairs = 0; repairs <= kMaxRepairs; ++repairs) {
        Builder builder(result.value, maxDepth);
        if (json::sax_parse(rest.begin(), rest.end(), &builder)) {
            result.repaired = repairs > 0;
            return result;
        }
        if (!builder.refusal().empty()) {
            result.fault = builder.refusal();
            return result;
        }
        const std::string_view number = badNumberAt(rest, builder);
        if (number.empty()) {
            if (repairs == 0) {
                result.fault =
                    "the text is not JSON: unexpected " +
                    (builder.position() > rest.size() ? std::string("end") : text::inQuotes(builder.token())) +
                    " at byte " + std::to_string(builder.position()) +
                    "; a message is one JSON object such as {\"type\":\"undo\"}";
            }
            result.notJson = true;
            return result;
        }
        if (repairs == 0) {
            result.fault = std::string(number) + (builder.overflow() ? " is too large for a number" : " is not JSON") +
                           " (byte " + std::to_string(static_cast<std::size_t>(number.data() - rest.data()) + 1) +
                           "); numbers must be finite";
        }
        const auto start = static_cast<std::size_t>(number.data() - rest.data());
        repaired = std::string(rest.substr(0, start)) + "null" + std::string(rest.substr(start + number.size()));
        rest = repaired;
    }
    return result;
}

}  // namespace oval4d::wire
