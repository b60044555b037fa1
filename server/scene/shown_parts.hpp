#pragma once
// The parts of a picture that can be shown or hidden.

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include "serialization/stored_members.hpp"

namespace oval4d::scene {

/// Whether each part of a picture is shown.
struct ShownParts {
    bool faces = true, bars = true, balls = true, coordinates = true, labels = true;
    /// In the projection of the whole object: the 2-faces, which bound the projected cells or form the surface.
    bool projectionFaces = false;
    bool back =
        true;  ///< in the projection: what the 4-D eye cannot see (see slicing::Projector::ProjectionOptions::culled)
    bool allSections = false;  ///< in the projection: the sections of all slices, not only of the focus slice
    bool operator==(const ShownParts&) const = default;
};

/// A part of the picture and its name, which is used in messages, queries and on the page's command line. The action of
/// the key that shows or hides the part (protocol/keymap.json) has the same name.
struct NamedPart {
    std::string_view name;
    bool ShownParts::* flag;
    std::size_t number;  ///< of the flag in stored sessions; it must not change: see serialization/stored_members.hpp
};

/// All parts.
inline constexpr auto kParts = std::to_array<NamedPart>({{"faces", &ShownParts::faces, 0},
                                                         {"bars", &ShownParts::bars, 1},
                                                         {"balls", &ShownParts::balls, 2},
                                                         {"coordinates", &ShownParts::coordinates, 3},
                                                         {"labels", &ShownParts::labels, 4},
                                                         {"cells", &ShownParts::projectionFaces, 5},
                                                         {"back", &ShownParts::back, 6},
                                                         {"sections", &ShownParts::allSections, 7}});
static_assert(sizeof(ShownParts) == kParts.size(), "every part has a row");
static_assert(std::ranges::all_of(kParts,
                                  [](const NamedPart& part) {
                                      return std::ranges::count(kParts, part.number, &NamedPart::number) == 1;
                                  }),
              "no two parts have the same number");

void visitStoredMembers(serialization::ReadOrWritten<ShownParts> auto& parts, auto& visit) {
    for (const NamedPart& part : kParts) visit.addedMember(part.number, parts.*part.flag);
}

}  // namespace oval4d::scene
