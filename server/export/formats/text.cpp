#include "export/formats/text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>

namespace oval4d::exports {

namespace {

template <typename Number>
void appendShortest(std::string& out, Number number) {
    std::array<char, 32> digits{};
    const auto [end, fault] = std::to_chars(digits.data(), digits.data() + digits.size(), number);
    out.append(digits.data(), end);
}

}  // namespace

void append(std::string& out, double number) { appendShortest(out, number); }
void append(std::string& out, float number) { appendShortest(out, number); }

void append(std::string& out, const glm::dvec3& point) {
    append(out, point.x);
    out += ' ';
    append(out, point.y);
    out += ' ';
    append(out, point.z);
}

std::string labelOfW(double w, double spacing) {
    const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(spacing))) + 1, 2, 9);
    std::array<char, 48> text{};
    std::snprintf(text.data(), text.size(), "%.*f", decimals, std::abs(w));
    const bool zero = std::abs(w) < 0.5 * std::pow(10, -decimals);
    return "w = " + std::string(zero ? "0" : (w < 0 ? "\u2212" : "") + std::string(text.data()));
}

std::string xmlEscaped(std::string_view text) {
    constexpr auto kEntities = std::to_array<std::pair<char, std::string_view>>(
        {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&apos;"}});
    std::string out;
    for (const char c : text) {
        const auto entity = std::ranges::find(kEntities, c, &std::pair<char, std::string_view>::first);
        if (entity != kEntities.end()) {
            out += entity->second;
        } else if (static_cast<unsigned char>(c) >= 0x20) {
            out += c;
        }
    }
    return out;
}

}  // namespace oval4d::exports
