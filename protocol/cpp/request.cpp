#include "protocol/cpp/request.hpp"

#include <array>
#include <utility>

namespace oval4d::protocol {

namespace {

constexpr auto kColourings =
    std::to_array<std::pair<scene::Colouring, std::string_view>>({{scene::Colouring::cell, "cell"},
                                                                  {scene::Colouring::kind, "kind"},
                                                                  {scene::Colouring::w, "w"},
                                                                  {scene::Colouring::plain, "plain"}});

}  // namespace

std::string_view wireName(scene::Colouring colouring) {
    for (const auto& [value, name] : kColourings) {
        if (value == colouring) return name;
    }
    return {};
}

std::optional<scene::Colouring> colouringNamed(std::string_view name) {
    for (const auto& [value, own] : kColourings) {
        if (own == name) return value;
    }
    return {};
}

}  // namespace oval4d::protocol
