#pragma once
// The layout of a picture: the positions of slices, labels, camera, axes and parallel coordinates.

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

/// The placement of one slice and its label in world space.
struct SlicePlacement {
    int index = 0;           ///< the index n of the hyperplane
    double w = 0;            ///< the w of the hyperplane, in the object's units
    glm::dvec3 position{0};  ///< the position of the slice's origin
    /// "w = −0.25" for the focus slice, followed by the name of the section if there is one; "−0.25" for others; empty
    /// if it is not shown.
    std::string label;
    glm::dvec3 labelAt{0};  ///< the center of the label's top edge
    double labelSize = 1;   ///< the height of the label, as a fraction of Style::textHeight
    bool focus = false;     ///< whether this is the focus slice
    bool drawn = true;      ///< false in the single view for all slices but the focus slice
    bool operator==(const SlicePlacement&) const = default;
};

/// The layout of the parallel coordinates. Vertex i is in row i / perRow and column i % perRow. The vertex has four
/// vertical lines, for its x, y, z and w. Each line extends from the row's zero line up or down; a line of length
/// `amplitude` represents the circumradius. All lengths are fractions of the viewport's height; positions are measured
/// from the viewport's lower left corner. If there are more than kMaxVerticesAsLines vertices, a density strip is drawn
/// instead: a single column, whose four lines are axes from −circumradius to +circumradius.
struct CoordinatesLayout {
    int rows = 1, perRow = 1;
    double left = 0;        ///< the left edge of the first column
    double zero = 0;        ///< the height of the top row's zero line above the bottom of the viewport
    double rowStep = 0;     ///< the distance from a row's zero line down to that of the next row
    double columnStep = 0;  ///< the distance from one vertex to the next
    double lineStep = 0;    ///< the distance from one of the four lines of a vertex to the next
    double lineWidth = 0;
    double amplitude = 0;  ///< the length of a line whose value is the circumradius
    bool named = true;     ///< whether the columns have labels P0, P1, … below them, or the strip's axes x, y, z, w
    bool density = false;  ///< whether a density strip is drawn
    bool operator==(const CoordinatesLayout&) const = default;
};

/// The maximum number of vertices whose parallel coordinates are drawn as lines. For more vertices, a density strip is
/// drawn.
inline constexpr std::size_t kMaxVerticesAsLines = 300;

/// The layout of the axes in the upper left corner: the distances of their center from the left and top edges, and the
/// length of each axis. All are fractions of the viewport's height.
struct AxesLayout {
    double x = 0, y = 0, length = 0;
    bool operator==(const AxesLayout&) const = default;
};

/// The place of the projection of the whole object.
struct ProjectionPlacement {
    bool shown = false;
    glm::dvec3 position{0};  ///< the position of its center, in world space
    double radius = 1;       ///< of the sphere that contains it, in world units
    bool operator==(const ProjectionPlacement&) const = default;
};

/// The layout of the matrix of planar sections. The panel in row i and column j, from the upper left, shows the section
/// by the plane of the axes i and j (0 … 3 for x, y, z, w): axis j to the right, axis i upward. The panels on the
/// diagonal name the axes. All lengths are fractions of the viewport's height; positions are measured from its lower
/// left corner.
struct MatrixLayout {
    bool shown = false;
    double left = 0, bottom = 0;            ///< the lower left corner of the matrix
    double panel = 0;                       ///< the side of a panel
    double step = 0;                        ///< the distance from a panel to the next
    double lineWidth = 0, pointRadius = 0;  ///< of the edges and points of sections
    /// From the center of a panel, which is the object's origin, to the panel's sides, in circumradii.
    static constexpr double kReach = 1.08;

    /// Returns the center of a panel.
    glm::dvec2 center(int row, int column) const {
        return {left + column * step + panel / 2, bottom + (3 - row) * step + panel / 2};
    }
    /// Returns the length that represents one unit of an object with this circumradius.
    double scale(double circumradius) const { return panel / 2 / (kReach * circumradius); }
    /// A panel that shows a section: its row and column are the axes upward and to the right.
    struct Panel {
        int row, column;
    };
    /// Returns the panel at a position; nothing outside the panels and on the diagonal.
    std::optional<Panel> panelAt(glm::dvec2 position) const;
    bool operator==(const MatrixLayout&) const = default;
};

/// The layout of a whole picture.
struct Layout {
    Camera camera;
    double sliceRadius = 1;  ///< the radius of the object's circumscribed sphere, in world units
    std::vector<SlicePlacement> placements;
    ProjectionPlacement projectionPlacement;
    CoordinatesLayout coordinates;
    AxesLayout axes;
    MatrixLayout matrix;
};

/// Lays out the slices of an object with `vertices` vertices. `focus` is the index n of the focus slice; `ballRadius`
/// is the radius of balls as a fraction of the slice radius; `focusName` is what the focus slice's label says after w.
/// Overwrites `out` and reuses its memory.
void layOut(const geometry::Hyperplanes& planes, int focus, std::size_t vertices, double ballRadius, const Look& look,
            Viewport viewport, std::string_view focusName, Layout& out);

}  // namespace oval4d::scene
