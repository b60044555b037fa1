#pragma once
// The options of an export.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "export/export_contents.hpp"
#include "export/formats/formats.hpp"
#include "geometry/range.hpp"
#include "text/choice.hpp"

namespace oval4d::exports {

/// The shape of a slice's body: the filled slice, or its balls and bars merged into one body. A projection is always
/// exported as balls and bars.
enum class BodyKind : std::uint8_t { solid, skeleton };
/// Where the object's name and the slice's w are written. `none`: nowhere; `engraved`: in a face of the body;
/// `separate`: on a plate next to the body.
enum class LabelPlacement : std::uint8_t { none, engraved, separate };

inline constexpr auto kBodies =
    text::completeTable<text::NamedValue<BodyKind>>({{"solid", BodyKind::solid},
                                                     {"skeleton", BodyKind::skeleton},
                                                     {"frame", BodyKind::skeleton}});  // "frame" is a former name
inline constexpr auto kLabels = text::completeTable<text::NamedValue<LabelPlacement>>(
    {{"none", LabelPlacement::none}, {"engraved", LabelPlacement::engraved}, {"separate", LabelPlacement::separate}});
constexpr const auto& choicesOf(BodyKind /*type*/) { return kBodies; }
constexpr const auto& choicesOf(LabelPlacement /*type*/) { return kLabels; }

/// The bounds of ExportRequest::size for bodies and for drawings, in millimeters.
inline constexpr double kMinSize = 1, kMaxSize = 10'000;
inline constexpr double kMinDrawingSize = 10, kMaxDrawingSize = 5000;
/// Returns these bounds for the files of a format.
inline geometry::Range sizeRangeOf(const Format& format) {
    return format.writeDrawing != nullptr ? geometry::Range{kMinDrawingSize, kMaxDrawingSize}
                                          : geometry::Range{kMinSize, kMaxSize};
}

/// The options of an export. `body` and `label` apply only to formats with bodies; `size` applies to formats with
/// bodies and to drawings.
struct ExportRequest {
    const Format* format = formatNamed("stl");  ///< a row of formats(); not null
    ExportContentsKind contents = ExportContentsKind::focus;
    BodyKind body = BodyKind::solid;
    /// In millimeters: the diameter of the object's circumscribed sphere or, for a drawing, the larger of its width and
    /// height.
    double size = 60;
    LabelPlacement label = LabelPlacement::none;
    /// For ExportContentsKind::oval: slices that replace those of the session. At most one of `chosenW` and
    /// `fittedSlices` is given. If neither is, the slices are those of the session.
    /// - `chosenW`: slices at these values of w, in the coordinates of the object's file (see
    ///   ObjectInfo::originInFile), and in this order.
    /// - `fittedSlices`: the number of equal parts into which the object's extent along w is divided; there is a slice
    ///   in the middle of each part. No slice is empty if the object is a convex polytope.
    std::vector<double> chosenW = {};
    std::optional<int> fittedSlices = {};
    /// Whether the surfaces of a field are exact: those of its piecewise linear interpolation (see
    /// slicing::ClosedSurfaceSlicer). Ignored for other objects, and for files without surfaces.
    bool exact = false;

    /// Returns whether `chosenW` or `fittedSlices` is given.
    bool choosesSlices() const { return !chosenW.empty() || fittedSlices.has_value(); }
    bool operator==(const ExportRequest&) const = default;
};

/// Calls `visit` with the name of each option beside the format, as in messages and queries, and with its value.
template <typename Visitor>
void forEachOption(ExportRequest& request, const Visitor& visit) {
    auto& [format, contents, body, size, label, chosenW, fittedSlices, exact] = request;
    visit("of", contents);
    visit("body", body);
    visit("size", size);
    visit("label", label);
    visit("at", chosenW);
    visit("fit", fittedSlices);
    visit("exact", exact);
}

/// Returns the default options for a format, which is a row of formats().
inline ExportRequest defaultRequestFor(const Format& format) {
    ExportRequest request{.format = &format, .contents = format.contents.front()};
    if (format.writeDrawing != nullptr) request.size = kDrawingSize;
    return request;
}

}  // namespace oval4d::exports
