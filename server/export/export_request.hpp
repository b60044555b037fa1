#pragma once
// The options of an export, which the user chooses.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "export/export_contents.hpp"
#include "export/formats/formats.hpp"
#include "geometry/range.hpp"
#include "text/choice.hpp"

namespace oval4d::exports {

/// The shape of a slice's body. `solid` is the filled slice. `skeleton` is one body made of the slice's balls and bars.
/// A projection is always a skeleton.
enum class BodyKind : std::uint8_t { solid, skeleton };
/// The place for the text with the object's name and the slice's w: nowhere (`none`), cut into a face of the body
/// (`engraved`), or on a plate next to the body (`separate`).
enum class LabelPlacement : std::uint8_t { none, engraved, separate };

inline constexpr auto kBodies =
    text::completeTable<text::NamedValue<BodyKind>>({{"solid", BodyKind::solid},
                                                     {"skeleton", BodyKind::skeleton},
                                                     {"frame", BodyKind::skeleton}});  // former name, still accepted
inline constexpr auto kLabels = text::completeTable<text::NamedValue<LabelPlacement>>(
    {{"none", LabelPlacement::none}, {"engraved", LabelPlacement::engraved}, {"separate", LabelPlacement::separate}});
constexpr const auto& choicesOf(BodyKind /*type*/) { return kBodies; }
constexpr const auto& choicesOf(LabelPlacement /*type*/) { return kLabels; }

/// The bounds of ExportRequest::size for bodies and for drawings, in millimeters.
inline constexpr double kMinSize = 1, kMaxSize = 10'000;
inline constexpr double kMinDrawingSize = 10, kMaxDrawingSize = 5000;
/// Returns the bounds of ExportRequest::size, in millimeters, for the files of a format.
inline geometry::NumberRange sizeRangeOf(const Format& format) {
    return format.writeDrawing != nullptr ? geometry::NumberRange{kMinDrawingSize, kMaxDrawingSize}
                                          : geometry::NumberRange{kMinSize, kMaxSize};
}

/// The options of an export. `body` and `label` apply only to formats with bodies. `size` applies to formats with
/// bodies and to drawings.
struct ExportRequest {
    const Format* format = formatNamed("stl");  ///< the file format; one of formats(), not null
    ExportContentsKind contents = ExportContentsKind::focus;
    BodyKind body = BodyKind::solid;
    /// In millimeters: the diameter of the object's circumscribed sphere or, for a drawing, the larger of its width and
    /// height.
    double size = 60;
    LabelPlacement label = LabelPlacement::none;
    /// The slices for ExportContentsKind::oval. At most one of these two options is given. Without both, the file has
    /// the slices of the session.
    /// - `chosenW`: there is a slice at each of these values of w, in this order. The values are in the coordinates of
    ///   the object's file (see ObjectInfo::originInFile).
    /// - `fittedSlices`: the object's extent along w is divided into this number of equal parts, and there is a slice
    ///   in the middle of each part. If the object is a convex polytope, no slice is empty.
    std::vector<double> chosenW = {};
    std::optional<int> fittedSlices = {};
    /// Whether the surfaces of a field are computed exactly from its piecewise linear interpolation (see
    /// slicing::ClosedSurfaceSlicer). Ignored for other objects, and for files without surfaces.
    bool exact = false;

    /// Returns whether `chosenW` or `fittedSlices` is given.
    bool choosesSlices() const { return !chosenW.empty() || fittedSlices.has_value(); }
    bool operator==(const ExportRequest&) const = default;
};

/// Calls `visit` with the name and the value of each option except the format. The names are those in messages and
/// queries.
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

/// Returns the default options for a format. `format` must be a row of formats().
inline ExportRequest defaultRequestFor(const Format& format) {
    ExportRequest request{.format = &format, .contents = format.contents.front()};
    if (format.writeDrawing != nullptr) request.size = kDrawingSize;
    return request;
}

}  // namespace oval4d::exports
