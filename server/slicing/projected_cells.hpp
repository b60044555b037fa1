#pragma once
// The cells of an object, projected from four to three dimensions, as they hide what lies behind them.

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

/// Returns how the side from `a` to `b` of a loop contributes to the winding number of the loop around 0. The two
/// directions of a side contribute opposite numbers, also with rounding errors, so that a closed surface has no gaps.
int windingOfSide(const glm::dvec2& a, const glm::dvec2& b);

/// The images of the cells of a cell complex, and the search for what they hide. Reuses its memory. Only one thread at
/// a time may use this object.
///
/// Points are given by their images: x, y, z are the projection of the point from R⁴ to R³, and the fourth coordinate,
/// the height, increases toward the eye along each line of sight. The image is made by a projective map that takes the
/// eye to the point at infinity of the fourth axis. Such a map takes lines to lines and hyperplanes to hyperplanes, and
/// it makes all lines of sight parallel.
///
/// A point is hidden by a cell if it lies below the hyperplane of the cell, and if the boundary of the projected cell
/// winds around the projected point (nonzero winding number). A point below the common boundary of two such cells is
/// hidden, too: a point counts as hidden only if it is hidden after a tiny shift in each of four directions, one of
/// which leads into every half-space.
class ProjectedCells {
  public:
    /// The length of these shifts, as a fraction of size().
    static constexpr double kTinyShift = 1e-10;

    using Triangle = std::array<std::uint32_t, 3>;  ///< vertices

    /// A box in R³ with sides parallel to the axes.
    struct Box {
        glm::dvec3 least, most;
        bool meets(const Box& other) const;
        void include(const glm::dvec3& point);
    };
    /// A cell that can hide something: it is not seen edge-on.
    struct Occluder {
        std::uint32_t cell;
        Box box;
        double top;         ///< the greatest height of its vertices
        glm::dvec4 normal;  ///< unit length, upward; the hyperplane is dot(normal, x) = offset
        double offset;
        double tolerance;  ///< points at most so far below the hyperplane are not hidden
        /// Returns how far a point lies below the hyperplane, beyond the tolerance.
        double depthOf(const glm::dvec4& point) const;
    };
    /// A segment of a straight line, or a point if both ends are equal.
    struct Segment {
        glm::dvec4 from, to;
    };

    /// Sets the cells of `complex`, which must exist as long as this object is used. `images` has the image of each
    /// vertex. Allows `steps` steps from now on.
    void place(const geometry::CellComplex& complex, std::span<const glm::dvec4> images, std::size_t steps);

    /// Returns the image of each vertex, turned in R³ by a fixed rotation, so that 2-faces are unlikely to be parallel
    /// to an axis. All points in the interface of this class are turned in this way.
    const std::vector<glm::dvec4>& points() const { return points_; }
    /// Returns the greatest distance of any of these points from 0.
    double size() const { return size_; }
    /// Returns the cells that can hide something.
    const std::vector<Occluder>& occluders() const { return occluders_; }
    /// Returns the indices of all occluders: 0, 1, 2, …
    std::span<const std::uint32_t> allOccluders() const { return allOccluders_; }
    /// Returns the cells that contain a vertex or an edge.
    std::span<const std::uint32_t> cellsOfVertex(std::uint32_t vertex) const { return cellsOfVertex_[vertex]; }
    std::span<const std::uint32_t> cellsOfEdge(std::uint32_t edge) const { return cellsOfEdge_[edge]; }

    /// Lets these cells, and no others, hide nothing until the next call.
    void exclude(std::span<const std::uint32_t> cells);
    bool isExcluded(std::uint32_t cell) const { return excludedIn_[cell] == test_; }

    /// Returns whether cells hide the whole segment, apart from gaps shorter than about 10⁻⁶ of it. `candidates` are
    /// indices of occluders, among which all must be that hide a part of the segment.
    bool isHidden(const Segment& segment, std::span<const std::uint32_t> candidates);

    /// Counts steps: comparisons of a part of an element with a cell, or with a triangle of the boundary of a cell.
    void spend(std::size_t steps);
    /// Returns whether more steps have been counted than are allowed. If so, isHidden() may return false too often.
    bool isExhausted() const { return exhausted_; }

  private:
    void prepare(const geometry::CellComplex& complex);
    void findOccluders();
    std::optional<glm::dvec4> normalOf(std::span<const Triangle> triangles) const;
    std::span<const Triangle> trianglesOf(std::uint32_t cell) const;
    bool isCovered(const Segment& segment, std::span<const std::uint32_t> candidates);
    bool cover(const Occluder& occluder, const Segment& segment, const Box& box);
    std::optional<double> crossingOf(const Segment& segment, const Triangle& triangle) const;
    int windingOf(std::uint32_t cell, const glm::dvec3& point);

    std::size_t stepsLeft_ = 0;
    bool exhausted_ = false;

    std::uint64_t object_ = 0;                           // the serial number of the object to which these belong:
    std::vector<Triangle> triangles_;                    // the boundaries of all cells; seen from outside,
                                                         // counterclockwise, or all the other way around
    std::vector<std::uint32_t> triangleBegin_;           // per cell: its first triangle; then the number of triangles
    geometry::JaggedArray cellsOfVertex_, cellsOfEdge_;  // some cells several times

    std::vector<glm::dvec4> points_;
    double size_ = 0;
    std::vector<Occluder> occluders_;
    std::vector<std::uint32_t> allOccluders_;

    std::vector<std::uint32_t> excludedIn_;  // per cell: the last test in which the cell hides nothing
    std::uint32_t test_ = 0;                 // the number of the current test, which exclude() begins
    std::size_t lastHiding_ = 0;             // the index of the last occluder that hid a whole segment

    std::vector<double> cuts_;                        // where a cell begins or ceases to hide a segment
    std::vector<std::pair<double, double>> covered_;  // the hidden parts of a segment, from 0 to 1
};

}  // namespace oval4d::slicing
