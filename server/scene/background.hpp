#pragma once
// The background of a picture, and the color scheme that fits it: for a dark or for a light background.

#include <array>
#include <cstdint>

#include "text/choice.hpp"

namespace oval4d::scene {

/// A color scheme: the colors of a picture that are chosen for a dark, or for a light, background.
enum class ColorScheme : std::uint8_t { dark, light };
inline constexpr auto kSchemes =
    text::completeTable<text::NamedValue<ColorScheme>>({{"dark", ColorScheme::dark}, {"light", ColorScheme::light}});

/// The background of a picture. Stored sessions contain the numbers of the enumerators; therefore these numbers must
/// not change.
enum class Background : std::uint8_t {
    automatic = 0,    ///< dark or light, as the viewer prefers; dark if the preference is unknown; "auto" in messages
    dark = 1,         ///< a nearly black background
    light = 2,        ///< a nearly white background, like that of the web page in its light scheme
    white = 3,        ///< a white background, like paper
    transparent = 4,  ///< transparent in PNG files, otherwise white; all other colors are those for `white`
};
inline constexpr auto kBackgrounds =
    text::completeTable<text::NamedValue<Background>>({{"auto", Background::automatic},
                                                       {"dark", Background::dark},
                                                       {"light", Background::light},
                                                       {"white", Background::white},
                                                       {"transparent", Background::transparent}});
constexpr const auto& choicesOf(Background /*type*/) { return kBackgrounds; }

/// Returns the color scheme for a background. For `automatic`, this is `viewer`, the scheme that the viewer prefers.
constexpr ColorScheme schemeForBackground(Background background, ColorScheme viewer = ColorScheme::dark) {
    if (background == Background::automatic) return viewer;
    return background == Background::dark ? ColorScheme::dark : ColorScheme::light;
}

}  // namespace oval4d::scene
