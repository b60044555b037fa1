#pragma once
// The options of an export.

#include <array>
#include <cstdint>

#include "export/extent.hpp"
#include "export/formats/formats.hpp"
#include "text/choice.hpp"

namespace oval4d::exports {

/// The shape of a slice's body: the filled slice, or its balls and bars merged into one body. A projection is always
/// exported as balls and bars.
enum class Body : std::uint8_t { solid, skeleton };
/// Where the object's name and the slice's w are written. `none`: nowhere; `engraved`: in a face of the body;
/// `separate`: on a plate next to the body.
enum class Label : std::uint8_t { none, engraved, separate };

inline constexpr auto kBodies = std::to_array<text::Choice<Body>>(
    {{"solid", Body::solid}, {"skeleton", Body::skeleton}, {"frame", Body::skeleton}});  // "frame": the former name
inline constexpr auto kLabels = std::to_array<text::Choice<Label>>(
    {{"none", Label::none}, {"engraved", Label::engraved}, {"separate", Label::separate}});

inline constexpr double kMinSize = 1, kMaxSize = 10'000;  ///< bounds of ExportRequest::size, in millimeters

/// The options of an export. `body`, `size` and `label` apply only to formats with bodies.
struct ExportRequest {
    const Format* format = formatNamed("stl");  ///< a row of formats(); not null
    Extent extent = Extent::focus;
    Body body = Body::solid;
    double size = 60;  ///< the diameter of the object's circumscribed sphere in millimeters
    Label label = Label::none;
};

/// Returns the default options for a format, which is a row of formats().
inline ExportRequest requestFor(const Format& format) { return {.format = &format, .extent = format.extents.front()}; }

}  // namespace oval4d::exports
