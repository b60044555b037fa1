#include "text_files/number.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

#include "text/ascii.hpp"
#include "text/words.hpp"

namespace oval4d::text_files {

namespace {

constexpr const char* kNotANumber = "is not a number";
constexpr const char* kNotFinite = "is not a finite number";
constexpr std::string_view kMinusSign = "\xE2\x88\x92";  // the minus sign U+2212

// Returns a word without the sign at its beginning, if there is one. Sets `negative` to whether the sign is a minus
// sign.
std::string_view withoutSign(std::string_view word, bool& negative) {
    negative = word.starts_with('-') || word.starts_with(kMinusSign);
    if (word.starts_with(kMinusSign)) return word.substr(kMinusSign.size());
    return word.starts_with('-') || word.starts_with('+') ? word.substr(1) : word;
}

bool isNotFinite(std::string_view unsignedWord) {
    const std::string name = text::normalizedName(unsignedWord);
    // A NaN may have a payload in parentheses, such as nan(ind) in Visual C++.
    const bool isNanWithPayload = name.starts_with("nan(") && name.ends_with(')');
    return name == "nan" || isNanWithPayload || name == "inf" || name == "infinity" || name == "1.#inf" ||
           name == "1.#qnan";
}

bool isExponentLetter(char c) { return c == 'e' || c == 'E' || c == 'd' || c == 'D'; }

// Returns whether the absolute value of a number is less than 1. The number has the form of ParsedCoordinate::text. The
// number may be outside the range of doubles.
bool isBelowOne(std::string_view number) {
    const std::size_t end = std::min(number.find('e'), number.size());
    const std::size_t point = std::min(number.find('.'), end);
    const std::size_t first = number.find_first_of("123456789");
    if (first >= end) return true;
    const auto places = static_cast<long long>(point) - static_cast<long long>(first);
    if (end == number.size()) return places <= 0;
    long long exponent = 0;
    const std::string_view digits = number.substr(end + 1);
    const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
    if (error == std::errc::result_out_of_range) return digits.starts_with('-');
    return exponent <= -places;
}

// Returns the error message (ParsedCoordinate::fault) for a word with a comma, such as "0,5" or "1,". The decimal mark
// of the text is the point.
std::string commaFaultOf(std::string_view word) {
    CoordinateReader reader;
    if (word.ends_with(',') && reader.read(word.substr(0, word.size() - 1)).fault.empty())
        return "ends with a comma; write blanks between numbers";
    if (!word.ends_with(',') && word.find(',') != std::string_view::npos &&
        reader.read(word, DecimalMark::comma).fault.empty())
        return "has a decimal comma; write a decimal point";
    return kNotANumber;
}

}  // namespace

ParsedCoordinate CoordinateReader::read(std::string_view word, DecimalMark mark) {
    const auto failed = [](std::string fault) { return ParsedCoordinate{0, {}, std::move(fault)}; };
    bool negative = false;
    const std::string_view digits = withoutSign(word, negative);
    if (bool second = false; withoutSign(digits, second) != digits) return failed(kNotANumber);
    if (isNotFinite(digits)) return failed(kNotFinite);
    const bool hasComma = digits.find(',') != std::string_view::npos;
    if (hasComma && digits.find('.') != std::string_view::npos)
        return failed("has a comma and a point; write numbers without separators of thousands");
    text_.assign(negative ? "-" : "");
    bool exponent = false;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (digits[i] == ',' && mark == DecimalMark::comma) {
            text_ += '.';
        } else if (!exponent && i > 0 && isExponentLetter(digits[i])) {
            exponent = true;
            text_ += 'e';
            bool negativeExponent = false;
            const std::string_view rest = withoutSign(digits.substr(i + 1), negativeExponent);
            if (negativeExponent) text_ += '-';
            i = digits.size() - rest.size() - 1;
        } else {
            text_ += digits[i];
        }
    }
    ParsedCoordinate result;
    const char* const end = text_.data() + text_.size();
    const auto [stop, error] = std::from_chars(text_.data(), end, result.value);
    if (stop != end || error == std::errc::invalid_argument)
        return failed(hasComma && mark == DecimalMark::point ? commaFaultOf(word) : kNotANumber);
    if (error == std::errc{} && !std::isfinite(result.value)) return failed(kNotFinite);
    const bool tooSmall = error == std::errc::result_out_of_range && isBelowOne(text_);
    if (tooSmall) result.value = 0;
    if ((error != std::errc{} && !tooSmall) || std::abs(result.value) > kMaxCoordinate)
        return failed("is beyond ±1e14, the range of coordinates");
    result.text = text_;
    return result;
}

bool isNumber(std::string_view word, DecimalMark mark) {
    CoordinateReader reader;
    return reader.read(word, mark).fault != kNotANumber;
}

bool beginsLikeANumber(std::string_view word) {
    bool negative = false;
    std::string_view rest = withoutSign(word, negative);
    if (isNotFinite(rest)) return true;
    if (rest.starts_with('.') || rest.starts_with(',')) rest.remove_prefix(1);
    return !rest.empty() && text::isDigit(rest.front());
}

}  // namespace oval4d::text_files
