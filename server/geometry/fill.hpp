#pragma once
// What the faces of slices enclose, as convex pieces: for drawing, and for bodies made of slices that are not convex.

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "geometry/polytope.hpp"
#include "geometry/slice_set.hpp"

namespace oval4d::geometry {

/// The winding rule is nonzero: a point of a face's plane belongs to the face where all loops of one cell in one
/// hyperplane, taken together, wind around it a number of times that is not 0.
///
/// A patch is such a face; slice i owns the patches [patchBegin[i], patchBegin[i + 1]). Patch p owns the pieces
/// [pieceBegin[p], pieceBegin[p + 1]): convex polygons that do not overlap, unless it is rough. Piece k is the loop
/// corners[cornerBegin[k]] … corners[cornerBegin[k + 1] − 1], counter-clockwise seen from outside (where the winding
/// is negative, from inside).
struct Fill {
    struct Patch {
        glm::dvec3 normal;  ///< of length 1, outward; its plane is where dot(normal, x) = offset
        double offset;
        std::uint32_t of;                   ///< as SliceSet::faceOf
        std::uint32_t firstLoop, lastLoop;  ///< the faces firstLoop … lastLoop − 1 of the SliceSet
        int winding;                        ///< the most that its loops wind around a place, either way; 0: rough
    };
    std::vector<std::uint32_t> patchBegin, pieceBegin, cornerBegin;
    std::vector<Patch> patches;
    std::vector<glm::dvec3> corners;

    bool empty() const { return patches.empty(); }
    void clear();
};

/// Fills slices; keeps its memory between calls. One filler serves one thread at a time.
class Filler {
  public:
    static constexpr std::size_t kNoLimit = ~std::size_t{0};

    /// All slices of `slices`, which were cut from a polytope of this circumradius. `out` is overwritten and its
    /// memory reused. A face of n sides that cross at k places takes n² + n · k steps at most. One for which fewer than
    /// these are left of `steps` is filled roughly: each loop by the triangles from its middle to its sides, which
    /// together are what the loop winds around if every side is seen from the middle, as on a star polygon.
    void fill(const SliceSet& slices, double circumradius, Fill& out, std::size_t steps = kNoLimit);

  private:
    // A side of a loop, from its lower end to its upper one; the plane's coordinates are x, y.
    struct Side {
        glm::dvec2 low, high;
        double slope;            // of x over y
        int winding;             // what is gained from left to right
        std::uint32_t from, to;  // levels
        double middle;           // x half-way up the strip at hand
        double at(double y) const;
    };
    // A piece that is being drawn upward: its two chains so far, the last points left open, and where they lead.
    struct Piece {
        static constexpr std::size_t kMost = 16;
        std::array<glm::dvec2, kMost> left, right;
        std::size_t lefts, rights;
        std::uint32_t leftSide, rightSide;
        bool positive, continued;
    };
    struct Plane {
        glm::dvec3 origin, x, y;
    };

    void fillFace(const SliceSet& slices, std::size_t slice, std::uint32_t begin, std::uint32_t end, Fill& out);
    bool findPlane(const SliceSet& slices, std::size_t slice, std::uint32_t begin, std::uint32_t end, Fill::Patch& out);
    bool take(std::size_t steps);
    void findLevels();
    int sweep(Fill& out);
    void fillRoughly(const SliceSet& slices, std::uint32_t begin, std::uint32_t end, Fill& out) const;
    void orderActive(double y);
    void addSpan(std::uint32_t left, std::uint32_t right, bool positive, double bottom);
    bool goesOn(const Piece& piece, const Side& left, const Side& right, double bottom) const;
    void close(const Piece& piece, double top, Fill& out) const;

    std::size_t left_ = 0;  // steps
    double tiny_ = 0;       // lengths below it are 0
    Plane plane_{};
    std::vector<glm::dvec3> points_;
    std::vector<Side> sides_;
    std::vector<double> levels_;          // heights at which a side begins, ends or crosses another
    std::vector<std::uint32_t> waiting_;  // sides by where they begin
    std::vector<std::uint32_t> active_;   // sides through the strip at hand, from left to right
    std::vector<Piece> open_;
};

}  // namespace oval4d::geometry
