#pragma once
// Lays out a picture: the places of the slices, their labels, the camera, the axes and the parallel coordinates.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "geometry/hyperplanes.hpp"
#include "scene/camera.hpp"
#include "scene/look.hpp"

namespace oval4d::scene {

/// The place of one slice and of its label in world space.
struct SlicePlacement {
    int index = 0;           ///< the index n of the slice's hyperplane (see geometry::Hyperplanes)
    double w = 0;            ///< the w of the slice's hyperplane, in the object's coordinates
    glm::dvec3 position{0};  ///< the place of the slice's point x = y = z = 0
    /// The text of the label, with w in the coordinates of the object's file: "−0.25". For the focus slice (the middle
    /// one), the text is "w = −0.25". A comma and the name of the section follow, if the section has a name and there
    /// is room for it. Empty if the label is not shown.
    std::string label;
    glm::dvec3 labelAt{0};  ///< the center of the top edge of the label's text, in world space
    double labelSize = 1;   ///< the font size of the label, as a multiple of PictureStyle::textHeight
    bool focus = false;     ///< whether the slice is the focus slice
    bool drawn = true;      ///< whether the slice is drawn: see showsAllSlices()
    bool operator==(const SlicePlacement&) const = default;
};

/// The layout of the parallel coordinates. All lengths are fractions of the viewport's height. Positions are measured
/// from the viewport's lower left corner. There are three forms:
/// - Lines: vertex i is in row i / perRow and column i % perRow, and has four vertical lines, for its x, y, z and w.
///   Each line extends from the row's zero line, up for a positive coordinate and down for a negative one. A line of
///   the length `amplitude` represents the circumradius.
/// - A density strip, for more than kMaxVerticesAsLines vertices. The strip has four vertical axes, at `left` + k ·
///   `lineStep` for axis k (0 … 3), from −circumradius at `zero` − `amplitude` to +circumradius at `zero` +
///   `amplitude`. The lines of single vertices (see density_strip_lines.hpp) run from the middle of one axis to the
///   middle of the next.
/// - A histogram, for a field: the panel of axis k (0 … 3) extends from `left` + k · `lineStep` to the right by
///   `panel`, and from `zero` − `amplitude` up to `zero` + `amplitude`.
struct ParallelCoordinatesLayout {
    int rows = 1, perRow = 1;
    double left = 0;        ///< the left edge of the first column, axis or panel
    double zero = 0;        ///< the height of the zero line of the top row, or of the middle of the axes or panels
    double rowStep = 0;     ///< the distance from the zero line of a row down to the zero line of the next row
    double columnStep = 0;  ///< for lines: the distance from one vertex to the next in its row
    double lineStep = 0;    ///< the distance from one of the four lines, axes or panels to the next one
    double lineWidth = 0;   ///< the width of all lines and axes
    /// For lines: the length that represents the circumradius; else: half the height of the plot.
    double amplitude = 0;
    bool named = true;  ///< whether there are labels: P0, P1, … below the vertices, or x, y, z, w below the axes
    bool isDensityStrip = false;  ///< whether a density strip is drawn
    double panel = 0;             ///< the width of each panel of a field's histogram; 0 if no histogram is drawn

    /// Returns the height of the upper end of the part of the picture that belongs to the parallel coordinates, from
    /// the lower edge of the picture.
    double top() const { return zero + amplitude + 0.01; }
    /// Returns whether each vertex has lines of its own, so that there is neither a density strip nor a histogram.
    bool hasLines() const { return !isDensityStrip && panel == 0; }
    bool operator==(const ParallelCoordinatesLayout&) const = default;
};

/// The maximum number of vertices whose parallel coordinates are drawn as lines. For more vertices, a density strip is
/// drawn instead.
inline constexpr std::size_t kMaxVerticesAsLines = 300;

/// The layout of the axes symbol, which shows the directions of the axes in the upper left corner. `x` and `y` are the
/// distances of its center from the left and the top edge of the picture. `length` is the length of each axis. All are
/// fractions of the viewport's height.
struct AxesSymbolLayout {
    double x = 0, y = 0, length = 0;
    bool operator==(const AxesSymbolLayout&) const = default;
};

/// The place and the size of the projection of the whole object. The projection overlaps no slice until the viewer
/// moves the camera. Slices are always drawn over the projection. Radii are in world units.
struct ProjectionPlacement {
    bool shown = false;
    glm::dvec3 position{0};  ///< the center of the projection, in world space
    double radius = 1;       ///< the radius of a sphere that contains the projection with its balls
    /// The radius of the object's circumscribed sphere, before the perspective magnifies the object.
    double objectRadius = 1;
    double ballRadius = 0, barRadius = 0;  ///< the radii of the balls and bars of the whole object
    bool operator==(const ProjectionPlacement&) const = default;
};

/// The layout of the matrix of planar sections in the picture. Rows and columns are counted from the upper left; axes
/// are numbered 0 … 3 for x, y, z, w. The panel in row i and column j shows the section by the plane of the axes i and
/// j. Axis j points to the right, and axis i upward. The panels on the diagonal show the names of the axes. All lengths
/// are fractions of the viewport's height. Positions are measured from the viewport's lower left corner.
struct SectionMatrixLayout {
    bool shown = false;
    double left = 0, bottom = 0;  ///< the lower left corner of the matrix of panels
    double panel = 0;             ///< the side of a panel
    double step = 0;              ///< the distance from the left or lower side of a panel to that of the next panel
    double lineWidth = 0, pointRadius = 0;  ///< the width of the edges and the radius of the points of sections
    /// The distance, in circumradii, from the center of a panel to each of its sides. The center shows the object's
    /// origin.
    static constexpr double kReach = 1.08;

    /// Returns the center of the panel in this row and column (0 … 3).
    glm::dvec2 center(int row, int column) const {
        return {left + column * step + panel / 2, bottom + (3 - row) * step + panel / 2};
    }
    /// Returns the length in a panel, in viewport heights, of one unit of an object with the circumradius
    /// `circumradius`.
    double panelScale(double circumradius) const { return panel / 2 / (kReach * circumradius); }
    /// The row and column (0 … 3) of a panel that shows a section. `row` is also the axis that points upward, and
    /// `column` the axis that points to the right.
    struct Panel {
        int row, column;
    };
    /// Returns the panel at `position`, in viewport heights from the lower left corner of the viewport. Returns an
    /// empty optional outside the panels, on the diagonal, and if the matrix is not shown.
    std::optional<Panel> panelAt(glm::dvec2 position) const;
    bool operator==(const SectionMatrixLayout&) const = default;
};

/// The layout of a whole picture.
struct PictureLayout {
    Camera camera;
    double sliceRadius = 1;                ///< the object's circumradius at the scale of the slices, in world units
    double ballRadius = 0, barRadius = 0;  ///< the radii of the balls and bars of slices, in world units
    std::vector<SlicePlacement> placements;
    ProjectionPlacement projectionPlacement;
    ParallelCoordinatesLayout coordinates;
    AxesSymbolLayout axes;
    SectionMatrixLayout matrix;
};

/// The properties of an object that determine the layout.
struct LayoutObjectInfo {
    std::size_t vertices = 0;
    bool isField = false;
    double originW = 0;  ///< the w of geometry::ObjectInfo::originInFile, which labels add to w
    /// The radius of balls at the thickness 1, as a fraction of the object's circumradius: the result of
    /// slicing::relativeBallRadius().
    double relativeBallRadius = 0;
    bool operator==(const LayoutObjectInfo&) const = default;
};

/// Lays out a picture. `planes` are the hyperplanes of the slices, and `focus` is the index n of the focus slice, the
/// middle one (see geometry::Hyperplanes). `focusName` is the text that follows w in the label of the focus slice, if
/// there is room for it. Overwrites `out` and reuses its memory.
void layOutPicture(const geometry::Hyperplanes& planes, int focus, const LayoutObjectInfo& content, const Look& look,
                   Viewport viewport, std::string_view focusName, PictureLayout& out);

}  // namespace oval4d::scene
