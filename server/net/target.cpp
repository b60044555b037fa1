#include "net/target.hpp"

#include <charconv>

namespace oval4d::net {

namespace {

std::optional<std::string> decoded(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            out += text[i];
            continue;
        }
        const std::string_view digits = text.substr(i + 1, 2);
        unsigned char byte = 0;
        const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
        if (fault != std::errc{} || end != digits.data() + 2) return {};
        out += static_cast<char>(byte);
        i += 2;
    }
    return out;
}

std::string_view takeUntil(std::string_view& text, char separator) {
    const std::size_t at = text.find(separator);
    const std::string_view head = text.substr(0, at);
    text.remove_prefix(at == std::string_view::npos ? text.size() : at + 1);
    return head;
}

}  // namespace

std::optional<Target> parseTarget(std::string_view text) {
    if (!text.starts_with('/')) return {};
    Target target;
    auto path = decoded(takeUntil(text, '?'));
    if (!path) return {};
    target.path = std::move(*path);
    while (!text.empty()) {
        std::string_view pair = takeUntil(text, '&');
        if (pair.empty()) continue;
        auto name = decoded(takeUntil(pair, '='));
        auto value = decoded(pair);
        if (!name || !value) return {};
        target.query.emplace_back(std::move(*name), std::move(*value));
    }
    return target;
}

}  // namespace oval4d::net
