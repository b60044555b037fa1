#pragma once
// Finds the contours of the levels of a field in planes: what the panels of a HyperSlice matrix show of a field (see
// planar_sections.hpp).

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "fields/field.hpp"
#include "geometry/rotation.hpp"
#include "slicing/planar_sections.hpp"
#include "slicing/surface_detail.hpp"
#include "slicing/surfaces/field_section.hpp"

namespace oval4d::slicing {

/// The contours of the levels of a field, as polygonal lines, in a plane that is parallel to two coordinate axes. A
/// closed line ends at the point at which it begins.
struct PlanarContours {
    std::vector<glm::dvec2> points;  ///< the coordinates of the points along the two axes, in the units of the object
    std::vector<std::uint32_t> begin{0};  ///< per line: the index of its first point; then the number of points
    std::vector<std::uint32_t> level;     ///< per line: the index of its level in FieldSettings::levels

    std::size_t lineCount() const { return level.size(); }
    /// Returns the points of line i: at least two.
    std::span<const glm::dvec2> line(std::size_t i) const {
        return std::span(points).subspan(begin[i], begin[i + 1] - begin[i]);
    }
    void clear() {
        points.clear();
        begin.assign(1, 0);
        level.clear();
    }
};

/// The contours of a field in the six planes of kPlaneAxes.
using MatrixContours = std::array<PlanarContours, kPlaneAxes.size()>;

/// The least and the greatest number of lattice squares along the side of a panel of the matrix.
inline constexpr double kMinContourSquares = 8, kMaxContourSquares = 160;

/// The maximum number of points of the contours in one plane. If there are more points, the lattice is made coarser, as
/// long as it has more than a quarter of kMaxContourSquares across the diameter of the field's circumscribed sphere.
inline constexpr std::size_t kMaxContourPoints = 20'000;

/// Returns the maximum time, in nanoseconds, to evaluate a field at the lattice points of all six planes together: a
/// tenth of the time for surfaces. The time of an evaluation is estimated by ScalarFunction::cost(). If the evaluation
/// would take longer, the lattices are made coarser, down to kMinContourSquares along the side of a panel.
constexpr double maxContourTime(Quality quality) { return 0.1 * surfaceLimits(quality).time; }

/// Returns the lattice step of the contours of `field` in the units of the object. `side` is the side of a panel in
/// these units, and `pixels` its side in pixels. The lattice squares are as wide as the lattice cubes of surfaces in
/// pictures (see pixelsPerCube()), or wider if maxContourTime() would be exceeded. For files, whose size in pixels is
/// not known, the lattice is as fine as allowed.
double contourStep(const fields::Field& field, double side, double pixels, Quality quality);

/// Finds the contours of a field in planes by marching squares. Reuses its memory. Only one thread at a time may use a
/// tracer.
class PlanarContourTracer {
  public:
    /// Finds the contours of `levels` of `field`, rotated by `orientation`, in the six planes through `point`, and
    /// writes them to `out`. The coordinates of `point` are those after the rotation. The function is evaluated only in
    /// the domain: at the points of a square lattice, and where the sides of lattice squares meet the boundary of the
    /// domain. Between these points, the function is interpolated linearly. The step of the lattice is `step`, or
    /// greater if a plane would have more than kMaxContourPoints points of contours. No line passes through a square if
    /// the function has no value at one of the square's corners. In drafts, contours may lack details of the function
    /// that are smaller than the step. Overwrites `out`.
    void trace(const fields::Field& field, const geometry::Rotation& orientation, const glm::dvec4& point,
               std::span<const double> levels, double step, Quality quality, MatrixContours& out);

  private:
    // A half-plane: the points p with dot(normal, p) ≤ offset. `normal` is a unit vector.
    struct HalfPlane {
        glm::dvec2 normal;
        double offset;

        // Returns the distance of a point from the boundary: positive inside, negative outside.
        double depthOf(const glm::dvec2& p) const;
    };
    struct Segment {
        std::array<glm::dvec2, 2> ends;
    };
    // One end of a segment. The number `end` is 2 s + k for the end k (0 or 1) of the segment with the index s.
    struct SegmentEnd {
        glm::dvec2 at;
        std::uint32_t end;
    };

    void setSectionPlane(const fields::Field& field, const glm::dmat4& toFunction, const std::array<int, 2>& axes,
                         const glm::dvec4& point);
    bool findBoxSides(const fields::Field& field, const glm::dmat4& toFunction);
    void cutBySides();
    bool isInDomain(const glm::dvec2& p) const;
    void layOutLattice(double step);
    void addCell(const std::array<glm::dvec2, 4>& corners, const std::array<std::uint32_t, 4>& indices);
    void addSegments(std::span<const std::uint32_t> corners, double level);
    void joinSegments(std::uint32_t level, PlanarContours& out);

    FieldSection section_;          // the plane of the contours, where z is 0
    std::vector<HalfPlane> sides_;  // half-planes whose intersection is the part of the plane in the domain
    std::vector<glm::dvec2> polygon_, cutPolygon_;
    std::vector<glm::dvec3> points_;  // the points at which the function is evaluated; z is 0
    std::vector<float> values_;       // per point of points_: the value of the function
    // Per lattice point: its index in points_, or kNone if it lies outside the domain.
    std::vector<std::uint32_t> latticePoints_;
    // The lattice cells: the lattice squares, cut by the domain. cellCorners_ has the indices in points_ of the corners
    // of all cells, and cellBegin_ the index in cellCorners_ of each cell's first corner.
    std::vector<std::uint32_t> cellBegin_, cellCorners_;
    // Where the contour of one level crosses the sides of one cell, in their order around the cell.
    std::vector<glm::dvec2> crossings_;
    std::vector<Segment> segments_;         // the segments of the contours of one level
    std::vector<SegmentEnd> ends_;          // the ends of all segments, sorted by their places
    std::vector<std::uint32_t> nodeOf_;     // per end: the index of its node (a place where ends meet)
    std::vector<std::uint32_t> nodeBegin_;  // per node: the index in ends_ of its first end; then the number of ends
    std::vector<char> isJoined_;            // per segment: 1 if it belongs to a line already, else 0
};

}  // namespace oval4d::slicing
