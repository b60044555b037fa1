#pragma once
// Finds what the cells of an object hide from an eye in four dimensions. The cells are projected from four to three
// dimensions.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "geometry/cell_complex.hpp"
#include "geometry/jagged_array.hpp"

namespace oval4d::slicing {

/// Returns what the side from `a` to `b` of a loop adds to the winding number of the loop around 0. In the other
/// direction, from `b` to `a`, the side adds the opposite number, in spite of rounding errors. So a closed surface has
/// no gaps between its faces.
int windingOfSide(const glm::dvec2& a, const glm::dvec2& b);

/// The projections of the cells of a cell complex, and a search for what they hide. Reuses its memory. Only one thread
/// at a time may use this object.
///
/// Each point of R⁴ is given by its image. The coordinates x, y and z of the image are the projection of the point from
/// R⁴ to R³. The fourth coordinate, the height, increases toward the eye along each line of sight. The image is made by
/// a projective map that takes the eye to the point at infinity of the fourth axis. Such a map takes lines to lines and
/// hyperplanes to hyperplanes, and it makes all lines of sight parallel.
///
/// A cell hides a point if two conditions hold: the point lies below the hyperplane of the cell, and the boundary of
/// the projected cell winds around the projected point (nonzero winding number). A point below the common boundary of
/// two such cells must be hidden, too, although it is inside neither projection. Therefore each point is tested after a
/// tiny shift in each of four directions, and counts as hidden if it is hidden after all of them. Every half-space
/// contains at least one of these directions.
class ProjectedCells {
  public:
    /// The length of the tiny shifts in the test whether a point is hidden, as a fraction of size().
    static constexpr double kTinyShift = 1e-10;

    using Triangle = std::array<std::uint32_t, 3>;  ///< the indices of three vertices

    /// A box in R³ with sides parallel to the axes.
    struct Box {
        glm::dvec3 least, most;
        bool intersects(const Box& other) const;
        void include(const glm::dvec3& point);
    };
    /// A cell that may hide something: it is not seen edge-on.
    struct Occluder {
        std::uint32_t cell;
        Box box;
        double top;         ///< the greatest height of the cell's vertices
        glm::dvec4 normal;  ///< a unit vector that points upward; the hyperplane of the cell is dot(normal, x) = offset
        double offset;
        double tolerance;  ///< a point at most this far below the hyperplane is not hidden by the cell
        /// Returns how far a point lies below the hyperplane of the cell, minus the tolerance.
        double depthOf(const glm::dvec4& point) const;
    };
    /// A segment of a straight line, or a point if both ends are equal.
    struct Segment {
        glm::dvec4 from, to;
    };

    /// Sets the cells of `complex`, which must exist as long as this object is used. `images` has the image of each
    /// vertex, and `hides` says for each cell whether it may hide anything. Allows `steps` steps from now on.
    void setCells(const geometry::CellComplex& complex, std::span<const glm::dvec4> images,
                  const std::vector<bool>& hides, std::size_t steps);

    /// Returns the image of each vertex, turned in R³ by a fixed rotation, so that 2-faces are unlikely to be parallel
    /// to an axis. All points that the functions of this class take or return are turned by this rotation.
    const std::vector<glm::dvec4>& points() const { return points_; }
    /// Returns the greatest distance from 0 of a point in points().
    double size() const { return size_; }
    /// Returns the cells that may hide something.
    const std::vector<Occluder>& occluders() const { return occluders_; }
    /// Returns the indices of all occluders: 0, 1, 2, …
    std::span<const std::uint32_t> allOccluders() const { return allOccluders_; }
    /// Returns the cells that contain this vertex or this edge.
    std::span<const std::uint32_t> cellsOfVertex(std::uint32_t vertex) const { return cellsOfVertex_[vertex]; }
    std::span<const std::uint32_t> cellsOfEdge(std::uint32_t edge) const { return cellsOfEdge_[edge]; }

    /// Excludes these cells, and no others, from hiding anything, until the next call.
    void excludeCells(std::span<const std::uint32_t> cells);
    bool isExcluded(std::uint32_t cell) const { return excludedIn_[cell] == test_; }

    /// Returns whether cells hide the whole segment, apart from gaps shorter than about 10⁻⁶ of its length.
    /// `candidates` are indices of occluders. They must include all occluders that hide a part of the segment.
    bool isHidden(const Segment& segment, std::span<const std::uint32_t> candidates);

    /// A part of a segment, from 0 at its beginning to 1 at its end.
    using SegmentPart = std::pair<double, double>;

    /// Writes the parts of the segment that no cell hides to `out`, in ascending order, apart from those shorter than
    /// about 10⁻⁶ of the segment. Gaps so short between them are left out, too. There are such parts if and only if the
    /// segment is not hidden (see isHidden()). Overwrites `out`.
    void findVisibleParts(const Segment& segment, std::span<const std::uint32_t> candidates,
                          std::vector<SegmentPart>& out);

    /// Counts `steps` steps of work. A step is the comparison of a part of an element with a cell, or with a triangle
    /// of the boundary of a cell.
    void countSteps(std::size_t steps);
    /// Returns whether more steps have been counted than setCells() allowed. If so, isHidden() may return false
    /// although the segment is hidden.
    bool isExhausted() const { return exhausted_; }

  private:
    void findIncidences(const geometry::CellComplex& complex);
    void findOccluders(const std::vector<bool>& hides);
    std::optional<glm::dvec4> normalOf(std::span<const Triangle> triangles) const;
    std::span<const Triangle> trianglesOf(std::uint32_t cell) const;
    Segment shifted(const Segment& segment, const glm::dvec3& direction) const;
    bool findCovered(const Segment& segment, std::span<const std::uint32_t> candidates);
    bool addVisible();
    bool addHiddenParts(const Occluder& occluder, const Segment& segment, const Box& box);
    std::optional<double> crossingOf(const Segment& segment, const Triangle& triangle) const;
    int windingOf(std::uint32_t cell, const glm::dvec3& point);

    std::size_t stepsLeft_ = 0;
    bool exhausted_ = false;

    std::uint64_t object_ = 0;  // the serial number of the object to which the next four members belong
    // The boundaries of all cells; as seen from outside the cells, the triangles are all counterclockwise or all
    // clockwise.
    std::vector<Triangle> triangles_;
    // Per cell: the index of its first triangle; then the number of triangles.
    std::vector<std::uint32_t> triangleBegin_;
    // Per vertex and per edge: the cells that contain it, in ascending order.
    geometry::JaggedArray cellsOfVertex_, cellsOfEdge_;

    std::vector<glm::dvec4> points_;
    double size_ = 0;
    std::vector<Occluder> occluders_;
    std::vector<std::uint32_t> allOccluders_;

    std::vector<std::uint32_t> excludedIn_;  // per cell: the number of the last test in which the cell is excluded
    std::uint32_t test_ = 0;                 // the number of the current test, which began with the last excludeCells()
    std::size_t lastHiding_ = 0;             // the index of the last occluder that hid a whole segment

    std::vector<double> cuts_;  // where a cell may begin or cease to hide a segment, as fractions of the segment
    std::vector<SegmentPart> covered_, visible_;  // the hidden parts of a segment, and the parts that are not hidden
};

}  // namespace oval4d::slicing
