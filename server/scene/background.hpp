#pragma once
// The background of a picture, and whether the colors on it are chosen for a dark or a light ground.

#include <array>
#include <cstdint>

#include "text/choice.hpp"

namespace oval4d::scene {

/// Whether the colors of a picture are chosen for a dark or a light ground.
enum class Scheme : std::uint8_t { dark, light };
inline constexpr auto kSchemes =
    std::to_array<text::Choice<Scheme>>({{"dark", Scheme::dark}, {"light", Scheme::light}});

/// The background of a picture. Stored sessions contain the numbers of the enumerators.
enum class Background : std::uint8_t {
    automatic = 0,    ///< dark or light, as the viewer prefers; dark if this is not known; "auto" in messages
    dark = 1,         ///< nearly black
    light = 2,        ///< nearly white, like the page in its light scheme
    white = 3,        ///< like paper
    transparent = 4,  ///< none in PNG files, white elsewhere; the other colors are those for `white`
};
inline constexpr auto kBackgrounds =
    std::to_array<text::Choice<Background>>({{"auto", Background::automatic},
                                             {"dark", Background::dark},
                                             {"light", Background::light},
                                             {"white", Background::white},
                                             {"transparent", Background::transparent}});
constexpr const auto& choicesOf(Background /*type*/) { return kBackgrounds; }

/// Returns the scheme of the colors on a background, for a viewer who prefers pictures of the scheme `viewer`.
constexpr Scheme schemeOn(Background background, Scheme viewer = Scheme::dark) {
    if (background == Background::automatic) return viewer;
    return background == Background::dark ? Scheme::dark : Scheme::light;
}

}  // namespace oval4d::scene
