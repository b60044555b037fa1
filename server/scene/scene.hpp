#pragma once
// The complete description of a picture. The renderers and the code that writes `slices` messages use no other data.
// Therefore the picture that the page in the browser draws and the picture that the server draws have exactly the same
// layout.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fields/axis_units.hpp"
#include "scene/camera.hpp"
#include "scene/color.hpp"
#include "scene/fog_look.hpp"
#include "scene/layout.hpp"
#include "scene/look.hpp"
#include "scene/style.hpp"
#include "scene/surface_look.hpp"
#include "slicing/fill.hpp"
#include "slicing/planar_contours.hpp"
#include "slicing/planar_sections.hpp"
#include "slicing/section_name.hpp"
#include "slicing/slice_set.hpp"
#include "slicing/visibility.hpp"

namespace oval4d::scene {

/// The look of one part of the projection: the whole object, or the section of the object by one hyperplane.
struct ProjectionPartLook {
    /// The radii of balls and bars in world units; those with the radius 0 are not drawn.
    double ballRadius = 0, barRadius = 0;
    Color ballColor = 0, barColor = 0;
    double faceOpacity = 0;  ///< the opacity of faces, 0 … 1
    bool operator==(const ProjectionPartLook&) const = default;
};

/// The projection of the whole object from four to three dimensions, together with the projected sections of the object
/// by hyperplanes.
struct ObjectProjection {
    /// The output of slicing::Projector: part 0 is the object, the other parts are its sections.
    slicing::SliceSet elements;
    /// For each face of `elements`, the index of its color in Scene::cellColors. The index is the cell that determines
    /// the color. For a surface, it is the index of the 2-face, or 0 if all 2-faces have one color.
    std::vector<std::uint32_t> faceCells;
    std::vector<ProjectionPartLook> parts;  ///< the look of each part of `elements`
    double scale = 1;                       ///< world units per unit of the object
    /// Whether the steps were too few to find what lies behind other cells. If so, only elements of cells turned away
    /// from the eye were left out (see slicing::Projector::exceededOcclusionSteps()).
    bool onlyTurnedAwayLeftOut = false;
    /// The filled faces of those parts of `elements` of which pieces (convex polygons) are drawn instead of polygons.
    /// These are part 0 if its polygons need not be convex, and the section of the focus slice (the middle one) if
    /// Scene::fill has the faces of this slice.
    slicing::FilledFaces fill;
    std::vector<std::uint32_t> fillCells;  ///< for each face of `fill`, the index of its color, as in `faceCells`

    /// The surface of the focus slice (the middle one) of a field, at its place in the projection.
    struct FocusSurface {
        std::size_t slice;  ///< the index of the focus slice in SliceSet::surfaces
        /// World units per unit of the object in the projected surface. This includes the factor by which the
        /// projection magnifies the hyperplane of the slice.
        double scale;
    };
    std::optional<FocusSurface> focusSurface;  ///< empty if no surfaces are drawn

    /// Returns whether the pieces of `fill` are drawn instead of the polygons of part `part`.
    bool drawsPieces(std::size_t part) const {
        return !fill.empty() && fill.faceBegin[part] < fill.faceBegin[part + 1];
    }
};

/// The matrix of planar sections, which the matrix view shows beside the focus slice (the middle one).
struct SectionMatrix {
    glm::dvec4 point{0};  ///< the focus point, through which all planes pass, in the object's units, after the rotation
    slicing::PlanarSections sections;
    /// The contours of a field whose surfaces are shown (see Scene::surfaces); otherwise empty.
    slicing::MatrixContours contours;
    /// The look of the edges and points of a planar section.
    struct SectionElementLooks {
        std::vector<std::uint32_t> edgeCells;  ///< per edge: the cell that determines the color of the edge
        std::vector<slicing::Visibility> edges, points;
        std::vector<bool> highlighted;  ///< per point: whether the point shows the highlighted element
    };
    std::array<SectionElementLooks, slicing::kPlaneAxes.size()> styles;
};

/// The axes of the histogram of a field's values: the ranges that they show, and the levels that are drawn as lines.
struct HistogramAxes {
    /// For each axis: the distance from the middle of its panel to the left and right edges of the panel, in the
    /// object's units. The middle shows the object's origin.
    std::array<double, 4> reach{1, 1, 1, 1};
    double least = 0, greatest = 1;  ///< the values at the lower and the upper edge of the histogram
    /// A level of the field that is drawn as a line.
    struct LevelLine {
        double value = 0;  ///< the value of the level, from `least` to `greatest`
        Color color = 0;
    };
    std::vector<LevelLine> levelLines;
    std::string quantity;  ///< what the values measure, such as "temperature, K"; empty if unknown

    /// Returns the height of a value above the lower edge, as a fraction of the height of the histogram.
    double heightOf(double value) const { return (value - least) / (greatest - least); }
};

/// The complete description of a picture: its layout, its slices, and how everything is drawn.
struct Scene : PictureLayout {
    /// The slices that the scene shows; never null; they must outlive the scene.
    const slicing::SliceSet* slices = &slicing::kNoSlices;
    std::string title;        ///< the name of the object
    double circumradius = 1;  ///< the object's circumradius, in the object's units
    Look look;
    Viewport viewport;
    double scale = 1;  ///< world units per unit of the object
    /// One color per cell. A surface has no cells; only its projection shows 2-faces, if ShownParts::projectionFaces is
    /// true. The list then has one color per 2-face, or one color for all of them (see
    /// CellColorAssigner::updateFaceColors()); otherwise it is empty.
    std::vector<Color> cellColors;
    /// For each face of `slices`, the cell that determines the color of the face. Empty if the list would be equal to
    /// SliceSet::faceSource.
    std::vector<std::uint32_t> faceCells;
    slicing::VisibilityBySource visibilities;
    slicing::PartsShowingElement highlight;    ///< the vertices and edges of slices that show the highlighted element
    slicing::SliceAndHullNames sectionNames;   ///< the names of the section in the focus slice
    ObjectProjection projection;               ///< valid if projectionPlacement.shown is true
    SectionMatrix sectionMatrix;               ///< the planar sections in the matrix; valid if matrix.shown is true
    double faceOpacity = style().faceOpacity;  ///< the opacity of the faces of slices, 0 … 1
    /// Whether drawing the slices needs a depth buffer, because the order in which their shapes hide each other is not
    /// known in advance. True for fields, for surfaces, and for nonconvex polytopes, of which faces may cross each
    /// other. If true, faces are opaque, and the pieces of `fill` are drawn instead of the polygons of the faces.
    bool needsDepthBuffer = false;
    /// The filled faces of slices; empty for a field, if faces are hidden, and if `needsDepthBuffer` is false.
    slicing::FilledFaces fill;
    SurfaceLook surfaces;                  ///< how SliceSet::surfaces are drawn; empty if no surfaces are drawn
    FogTransferTable fog;                  ///< how SliceSet::fogs are drawn; empty if no fog is drawn
    std::vector<std::uint32_t> fillCells;  ///< for each face of `fill`, the cell that determines the color of the face
    /// The tones (0 … 255) of the density plot if showsDensityStrip() is true (see DensityPlot::tones()), or of the
    /// histograms of a field if showsHistogram() is true (see slicing::CoordinateValueHistograms::tones()). Otherwise
    /// without meaning.
    std::vector<std::uint8_t> plotTones;
    HistogramAxes histogram;         ///< valid if showsHistogram() is true
    fields::PictureUnits axisUnits;  ///< the units of a field's axes and values; unknown for all other objects

    /// Returns the fixed colors and sizes of the picture, which depend on its background.
    const PictureStyle& style() const { return scene::style(look.background); }
    /// Returns the radius of the balls at the vertices of slices, in world units, before SliceSet::ballScale multiplies
    /// the radius. If ShownParts::balls is false, balls with the radius and color of the bars join the bars; the points
    /// of a cloud have this radius, too. Returns 0 if no balls are drawn.
    double drawnBallRadius() const {
        if (look.parts.balls) return ballRadius;
        return look.parts.bars || !slices->ballScale.empty() ? barRadius : 0;
    }
    /// Returns the color of the balls whose radius is drawnBallRadius().
    Color drawnBallColor() const { return look.parts.balls ? style().ball : style().bar; }
    /// Returns whether slices are not drawn in the part of the picture that belongs to the parallel coordinates. Slices
    /// extend into this part only if the viewer has moved the camera.
    bool clearsCoordinatesArea() const { return look.parts.coordinates && look.orbit != CameraOrbit{}; }
    /// Returns the cell that determines the color of the face with the index `face` in `slices`.
    std::uint32_t coloringCellOfFace(std::size_t face) const {
        return faceCells.empty() ? slices->faceSource[face] : faceCells[face];
    }
    /// Returns whether the parallel coordinates are drawn as a density strip, because there are too many vertices for
    /// lines.
    bool showsDensityStrip() const { return look.parts.coordinates && coordinates.isDensityStrip; }
    /// Returns whether the histogram of a field's values is shown.
    bool showsHistogram() const { return look.parts.coordinates && coordinates.panel > 0; }
};

}  // namespace oval4d::scene
