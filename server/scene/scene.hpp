#pragma once
// The complete description of a picture. Renderers, message writers and exporters use no other data. Therefore the
// picture that a page draws and a frame from the server can be overlaid exactly.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/camera.hpp"
#include "scene/color.hpp"
#include "scene/layout.hpp"
#include "scene/look.hpp"
#include "scene/style.hpp"
#include "slicing/fill.hpp"
#include "slicing/planar_sections.hpp"
#include "slicing/section_name.hpp"
#include "slicing/slice_set.hpp"
#include "slicing/visibility.hpp"

namespace oval4d::scene {

/// How a part of the projection of the whole object is drawn.
struct ProjectionPart {
    double ballRadius = 0, barRadius = 0;  ///< in world units; balls or bars with the radius 0 are not drawn
    Color ballColor = 0, barColor = 0;
    double faceOpacity = 0;  ///< 0 … 1
    bool operator==(const ProjectionPart&) const = default;
};

/// The projection of the whole object from four to three dimensions, together with the projected sections of the object
/// by hyperplanes.
struct ObjectProjection {
    slicing::SliceSet elements;            ///< as slicing::Projector writes them: part 0 is the object
    std::vector<std::uint32_t> faceCells;  ///< for each face of `elements`, the cell that determines its color
    std::vector<ProjectionPart> parts;     ///< for each part of `elements`
    double scale = 1;                      ///< world units per unit of the object
};

/// The matrix of planar sections, which the matrix view shows beside the focus slice.
struct SectionMatrix {
    glm::dvec4 point{0};  ///< the focus point, through which all planes pass, in the object's units
    slicing::PlanarSections sections;
    /// How a section is drawn: for each of its edges, and for each of its points.
    struct SectionStyle {
        std::vector<std::uint32_t> edgeCells;  ///< the cell that determines the edge's color
        std::vector<slicing::Visibility> edges, points;
        std::vector<bool> highlighted;  ///< whether the point shows the highlighted element
    };
    std::array<SectionStyle, slicing::kPlaneAxes.size()> styles;
};

/// A picture: its layout, its slices, and how they are drawn.
struct Scene : Layout {
    const slicing::SliceSet* slices = &slicing::kNoSlices;  ///< never null; must outlive the scene
    std::string title;                                      ///< the object's name
    double circumradius = 1;                                ///< the object's circumradius, in the object's units
    Look look;
    Viewport viewport;
    double scale = 1;                      ///< world units per unit of the object
    double ballRadius = 0, barRadius = 0;  ///< in world units
    std::vector<Color> cellColors;         ///< one per cell
    /// For each face of `slices`, the cell that determines the face's color. Empty if SliceSet::faceSource has the same
    /// content.
    std::vector<std::uint32_t> faceCells;
    slicing::Visibilities visibilities;
    slicing::ElementSources highlight;         ///< what shows the highlighted element; empty if there is none
    slicing::SectionNames sectionNames;        ///< of the focus slice
    ObjectProjection projection;               ///< valid if projectionPlacement.shown
    SectionMatrix sectionMatrix;               ///< valid if matrix.shown
    double faceOpacity = style().faceOpacity;  ///< 0 … 1
    /// Whether faces may cross each other. If so, they are opaque, and `fill` is drawn instead of their loops.
    bool crossing = false;
    slicing::Fill fill;                     ///< the filled faces, if `crossing` is set and faces are shown; else empty
    std::vector<std::uint32_t> patchCells;  ///< for each patch of `fill`, the cell that determines its color
    std::vector<std::uint8_t> density;      ///< DensityPlot::tones() for the density strip; valid if showsDensity()

    /// Returns the cell that determines the color of a face of `slices`.
    std::uint32_t cellOfFace(std::size_t face) const {
        return faceCells.empty() ? slices->faceSource[face] : faceCells[face];
    }
    /// Returns whether the density strip is shown.
    bool showsDensity() const { return look.parts.coordinates && coordinates.density; }
};

}  // namespace oval4d::scene
