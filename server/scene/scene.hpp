#pragma once
// The complete description of a picture. The renderers and the code that writes `slices` messages use no other data.
// Therefore a picture that a page draws and a picture that the server draws can be overlaid exactly.

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

/// How a part of the projection of the whole object is drawn.
struct ProjectionPartLook {
    double ballRadius = 0, barRadius = 0;  ///< in world units; balls or bars with the radius 0 are not drawn
    Color ballColor = 0, barColor = 0;
    double faceOpacity = 0;  ///< 0 … 1
    bool operator==(const ProjectionPartLook&) const = default;
};

/// The projection of the whole object from four to three dimensions, together with the projected sections of the object
/// by hyperplanes.
struct ObjectProjection {
    slicing::SliceSet elements;  ///< the output of slicing::Projector: part 0 is the object, other parts are
                                 ///< its sections
    /// For each face of `elements`, the index of its color in Scene::cellColors: the cell that determines the color or,
    /// for a surface, the 2-face, or 0 if all 2-faces have one color.
    std::vector<std::uint32_t> faceCells;
    std::vector<ProjectionPartLook> parts;  ///< for each part of `elements`
    double scale = 1;                       ///< world units per unit of the object
    bool onlyTurnedAwayLeftOut = false;     ///< see slicing::Projector::lacksSteps()
    /// The filled faces of the parts whose pieces are drawn instead of their polygons: of part 0 if its polygons need
    /// not be convex, and of the section of the focus slice if Scene::fill has the faces of this slice.
    slicing::FilledFaces fill;
    std::vector<std::uint32_t> fillCells;  ///< for each face of `fill`, the index of its color, as in `faceCells`

    /// The surface of the focus slice of a field, at its place in the projection.
    struct FocusSurface {
        std::size_t slice;  ///< the index in SliceSet::surfaces
        double scale;       ///< world units per unit of the object: as the projection magnifies the hyperplane
    };
    std::optional<FocusSurface> focusSurface;  ///< empty if no surfaces are drawn

    /// Returns whether the pieces of `fill` are drawn instead of the polygons of this part.
    bool drawsPieces(std::size_t part) const {
        return !fill.empty() && fill.faceBegin[part] < fill.faceBegin[part + 1];
    }
};

/// The matrix of planar sections, which the matrix view shows beside the focus slice.
struct SectionMatrix {
    glm::dvec4 point{0};  ///< the focus point, through which all planes pass, in the object's units, after the rotation
    slicing::PlanarSections sections;
    slicing::MatrixContours contours;  ///< of a field whose surfaces are shown (see Scene::surfaces); else empty
    /// How the edges and points of a section are drawn.
    struct SectionStyle {
        std::vector<std::uint32_t> edgeCells;  ///< per edge: the cell that determines its color
        std::vector<slicing::Visibility> edges, points;
        std::vector<bool> highlighted;  ///< per point: whether the point shows the highlighted element
    };
    std::array<SectionStyle, slicing::kPlaneAxes.size()> styles;
};

/// The axes of the histogram of a field's values: their ranges, and the levels that are drawn as lines.
struct HistogramAxes {
    /// For each axis: the distance from the middle of the panel to the left and right edges of the panel, in the
    /// object's units. The middle shows the object's origin.
    std::array<double, 4> reach{1, 1, 1, 1};
    double least = 0, greatest = 1;  ///< the values at the lower and the upper edge
    /// A level of the field that is drawn as a line.
    struct LevelLine {
        double value = 0;  ///< from `least` to `greatest`
        Color color = 0;
    };
    std::vector<LevelLine> levelLines;
    std::string quantity;  ///< what the values measure, such as "temperature, K"; empty if it is unknown

    /// Returns the height of a value above the lower edge, as a fraction of the height of the histogram.
    double height(double value) const { return (value - least) / (greatest - least); }
};

/// A picture: its layout, its slices, and how they are drawn.
struct Scene : PictureLayout {
    const slicing::SliceSet* slices = &slicing::kNoSlices;  ///< never null; must outlive the scene
    std::string title;                                      ///< the object's name
    double circumradius = 1;                                ///< the object's circumradius, in the object's units
    Look look;
    Viewport viewport;
    double scale = 1;  ///< world units per unit of the object
    /// One per cell. For a surface, whose 2-faces only the projection shows: one per 2-face or one for all of them if
    /// ShownParts::projectionFaces is true, else none (see CellPainter::updateFaceColors()).
    std::vector<Color> cellColors;
    /// For each face of `slices`, the cell that determines the face's color. Empty if the list would be equal to
    /// SliceSet::faceSource.
    std::vector<std::uint32_t> faceCells;
    slicing::VisibilityBySource visibilities;
    slicing::PartsShowingElement highlight;    ///< the vertices and edges of slices that show the highlighted element
    slicing::SectionNamePair sectionNames;     ///< of the section in the focus slice
    ObjectProjection projection;               ///< valid if projectionPlacement.shown
    SectionMatrix sectionMatrix;               ///< valid if matrix.shown
    double faceOpacity = style().faceOpacity;  ///< 0 … 1
    /// Whether drawing the slices needs a depth buffer, because the order in which their shapes hide each other is not
    /// known in advance: for fields, surfaces and nonconvex polytopes, whose faces may cross each other. If true, faces
    /// are opaque, and the triangles of `fill` are drawn instead of the polygons of the faces.
    bool needsDepthBuffer = false;
    slicing::FilledFaces fill;             ///< the filled faces; empty for a field, if faces are hidden, and if
                                           ///< `needsDepthBuffer` is false
    SurfaceLook surfaces;                  ///< how SliceSet::surfaces are drawn; empty if none are drawn
    FogTable fog;                          ///< how SliceSet::fogs are drawn; empty if no fog is drawn
    std::vector<std::uint32_t> fillCells;  ///< for each face of `fill`, the cell that determines its color
    /// If showsDensity(), the tones of the density plot (DensityPlot::tones()); if showsHistogram(), those of the
    /// histograms of a field (slicing::CoordinateValueHistograms::tones()); otherwise without meaning.
    std::vector<std::uint8_t> plotTones;
    HistogramAxes histogram;         ///< valid if showsHistogram()
    fields::PictureUnits axisUnits;  ///< of a field; unknown for all other objects

    /// Returns the style of the picture, which depends on its background.
    const Style& style() const { return scene::style(look.background); }
    /// Returns the radius of the balls at the vertices of slices, in world units, before SliceSet::ballScale multiplies
    /// it. If ShownParts::balls is false, balls with the radius and color of the bars join the bars, and the points of
    /// a cloud have this radius, too. Returns 0 if no balls are drawn.
    double drawnBallRadius() const {
        if (look.parts.balls) return ballRadius;
        return look.parts.bars || !slices->ballScale.empty() ? barRadius : 0;
    }
    /// Returns the color of the balls with the radius drawnBallRadius().
    Color drawnBallColor() const { return look.parts.balls ? style().ball : style().bar; }
    /// Returns whether slices are removed from the part of the picture that belongs to the parallel coordinates. Slices
    /// extend into this part only if the viewer has moved the camera.
    bool clearsCoordinatesArea() const { return look.parts.coordinates && look.orbit != CameraOrbit{}; }
    /// Returns the cell that determines the color of a face of `slices`.
    std::uint32_t coloringCellOfFace(std::size_t face) const {
        return faceCells.empty() ? slices->faceSource[face] : faceCells[face];
    }
    /// Returns whether the parallel coordinates are drawn as densities, because the vertices are too many for lines.
    bool showsDensity() const { return look.parts.coordinates && coordinates.isDensityStrip; }
    /// Returns whether the histogram of a field's values is shown.
    bool showsHistogram() const { return look.parts.coordinates && coordinates.panel > 0; }
};

}  // namespace oval4d::scene
