#pragma once
// The parts of a picture that can be shown or hidden.

#include <array>
#include <string_view>

namespace oval4d::scene {

/// Whether each part of a picture is shown.
struct Parts {
    bool faces = true, bars = true, balls = true, coordinates = true, labels = true;
    /// In the projection of the whole object: the 2-faces, which bound the projected cells or form the surface.
    bool projectionFaces = false;
    bool back = true;  ///< in the projection: the elements that belong only to cells turned away from the 4-D eye
    bool allSections = false;  ///< in the projection: the sections of all slices, not only of the focus slice
    bool operator==(const Parts&) const = default;
};

/// A part of the picture and its name, which is used in messages, queries, stored sessions and on the page's command
/// line. The action of the key that shows or hides the part (protocol/keymap.json) has the same name.
struct NamedPart {
    std::string_view name;
    bool Parts::* flag;
};

/// All parts. Stored sessions contain the flags in this order; therefore a new row must be the last one.
inline constexpr auto kParts = std::to_array<NamedPart>({{"faces", &Parts::faces},
                                                         {"bars", &Parts::bars},
                                                         {"balls", &Parts::balls},
                                                         {"coordinates", &Parts::coordinates},
                                                         {"labels", &Parts::labels},
                                                         {"cells", &Parts::projectionFaces},
                                                         {"back", &Parts::back},
                                                         {"sections", &Parts::allSections}});
static_assert(sizeof(Parts) == kParts.size(), "every part has a row");

}  // namespace oval4d::scene
