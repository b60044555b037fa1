#pragma once
// The parts of a picture that can be shown or hidden.

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include "serialization/stored_members.hpp"

namespace oval4d::scene {

/// Which parts of a picture are shown.
struct ShownParts {
    bool faces = true, bars = true, balls = true, coordinates = true, labels = true;
    /// Whether the projection of the whole object shows the 2-faces: those that bound the projected cells, or those of
    /// a surface.
    bool projectionFaces = false;
    /// Whether the projection shows what the 4-D eye cannot see (see slicing::Projector::ProjectionOptions::culled).
    bool back = true;
    bool allSections = false;  ///< whether the projection shows the sections of all slices, not only of the focus slice
    bool operator==(const ShownParts&) const = default;
};

/// A part of the picture and its name. The name is used in messages, queries and on the page's command line. The key
/// that shows or hides the part has an action with the same name (protocol/keymap.json).
struct NamedPicturePart {
    std::string_view name;
    bool ShownParts::* flag;
    /// The number of `flag` in stored sessions; it must not change (see serialization/stored_members.hpp).
    std::size_t number;
};

/// All parts of a picture that can be shown or hidden.
inline constexpr auto kParts = std::to_array<NamedPicturePart>({{"faces", &ShownParts::faces, 0},
                                                                {"bars", &ShownParts::bars, 1},
                                                                {"balls", &ShownParts::balls, 2},
                                                                {"coordinates", &ShownParts::coordinates, 3},
                                                                {"labels", &ShownParts::labels, 4},
                                                                {"cells", &ShownParts::projectionFaces, 5},
                                                                {"back", &ShownParts::back, 6},
                                                                {"sections", &ShownParts::allSections, 7}});
static_assert(sizeof(ShownParts) == kParts.size(), "every part has a row");
static_assert(std::ranges::all_of(kParts,
                                  [](const NamedPicturePart& part) {
                                      return std::ranges::count(kParts, part.number, &NamedPicturePart::number) == 1;
                                  }),
              "no two parts have the same number");

void visitStoredMembers(serialization::ReadOrWritten<ShownParts> auto& parts, auto& visit) {
    for (const NamedPicturePart& part : kParts) visit.memberAddedLater(part.number, parts.*part.flag);
}

}  // namespace oval4d::scene
