#pragma once

#include <array>
#include <cstdint>

#include "export/formats/formats.hpp"
#include "text/choice.hpp"

namespace oval4d::exports {

/// The exported part: the focus slice alone, or all slices.
enum class SliceSelection : std::uint8_t { focus, oval };
/// The filled slice, or its balls and bars merged into one body ("frame" in messages).
enum class Body : std::uint8_t { solid, skeleton };
enum class Label : std::uint8_t { none, engraved, separate };

inline constexpr auto kExtents =
    std::to_array<text::Choice<SliceSelection>>({{"focus", SliceSelection::focus}, {"oval", SliceSelection::oval}});
inline constexpr auto kBodies = std::to_array<text::Choice<Body>>({{"solid", Body::solid}, {"frame", Body::skeleton}});
inline constexpr auto kLabels = std::to_array<text::Choice<Label>>(
    {{"none", Label::none}, {"engraved", Label::engraved}, {"separate", Label::separate}});

inline constexpr double kMinSize = 1, kMaxSize = 10'000;  ///< millimeters

/// The options of an export request.
struct ExportRequest {
    const Format* format = formatNamed("stl");
    SliceSelection extent = SliceSelection::focus;
    Body body = Body::solid;
    double size = 60;  ///< the diameter of the object's circumscribed sphere in millimeters
    Label label = Label::none;
};

}  // namespace oval4d::exports
