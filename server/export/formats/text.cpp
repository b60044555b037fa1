#include "export/formats/text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "scene/slice_label.hpp"

namespace oval4d::exports {

namespace {

template <typename Number>
void appendShortest(std::string& out, Number number) {
    std::array<char, 32> digits{};
    const auto [end, fault] = std::to_chars(digits.data(), digits.data() + digits.size(), number);
    out.append(digits.data(), end);
}

}  // namespace

void appendDecimal(std::string& out, double number) { appendShortest(out, number); }
void appendDecimal(std::string& out, float number) { appendShortest(out, number); }

void appendDecimal(std::string& out, const glm::dvec3& point) {
    appendDecimal(out, point.x);
    out += ' ';
    appendDecimal(out, point.y);
    out += ' ';
    appendDecimal(out, point.z);
}

std::string labelOfW(const geometry::Hyperplanes& planes, int i, double origin) {
    return "w = " + scene::labelNumber(origin + planes.w(i), scene::labelDecimals(planes));
}

std::string removeNonXmlCharacters(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::string_view rest = text.substr(i);
        if (rest.starts_with("\xEF\xBF\xBE") || rest.starts_with("\xEF\xBF\xBF")) {
            i += 2;
        } else if (static_cast<unsigned char>(text[i]) >= 0x20) {
            out += text[i];
        }
    }
    return out;
}

std::string xmlEscaped(std::string_view text) {
    constexpr auto kEntities = std::to_array<std::pair<char, std::string_view>>(
        {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&apos;"}});
    std::string out;
    for (const char c : removeNonXmlCharacters(text)) {
        const auto entity = std::ranges::find(kEntities, c, &std::pair<char, std::string_view>::first);
        if (entity != kEntities.end()) {
            out += entity->second;
        } else {
            out += c;
        }
    }
    return out;
}

}  // namespace oval4d::exports
