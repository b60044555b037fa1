#pragma once
// Filled faces of slices, decomposed into convex polygons. This form is used to draw and export nonconvex slices (also
// in the projection of the object) and projections of objects whose 2-faces are not convex.

#include <array>
#include <compare>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "polytopes/polytope.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

/// The filled faces of slices. A hyperplane may cut a cell in several loops. Together, the loops bound one face, which
/// is filled by the nonzero winding rule: a point of the plane belongs to the face if the sum of the winding numbers of
/// the loops around the point is not 0.
///
/// Slice i has the faces faceBegin[i] … faceBegin[i + 1] − 1. A face consists of pieces: convex polygons that do not
/// overlap, unless the face is filled roughly (see FaceFiller::fill()). Face f has the pieces pieceBegin[f] …
/// pieceBegin[f + 1] − 1. Piece k is the loop corners[cornerBegin[k]] … corners[cornerBegin[k + 1] − 1]. Seen from
/// outside, a piece is counterclockwise if the winding number inside it is positive, and clockwise if the winding
/// number is negative.
struct FilledFaces {
    struct FilledFace {
        glm::dvec3 normal;  ///< a unit vector, outward; the plane of the face is dot(normal, x) = offset
        double offset;
        std::uint32_t source;  ///< the source number (which cell or 2-face was cut), as in SliceSet::faceSource
        std::uint32_t firstLoop, endLoop;  ///< the face's loops are the faces firstLoop … endLoop − 1 of the SliceSet
        int winding;  ///< the maximum of |winding number| in the face; 0 if the face is filled roughly, or is not flat
    };
    std::vector<std::uint32_t> faceBegin, pieceBegin, cornerBegin;
    std::vector<FilledFace> faces;
    std::vector<glm::dvec3> corners;

    bool empty() const { return faces.empty(); }
    void clear();
};

/// Decomposes the faces of slices into convex polygons with a sweep line. Reuses its memory between calls. Only one
/// thread at a time may use a face filler.
class FaceFiller {
  public:
    static constexpr std::size_t kNoLimit = ~std::size_t{0};

    /// Fills the faces of the first `count` slices, or of all slices if there are fewer, and writes them to `out`. The
    /// other slices have no faces in `out`. `circumradius` is that of the sliced polytope. Overwrites `out` and reuses
    /// its memory. Returns how many of `steps` are left.
    ///
    /// `steps` limits the time for all faces together: a face whose loops have n sides that cross at k points takes at
    /// most 2 n² + n · k steps. If too few steps are left for a face, the face is filled roughly: each of its loops
    /// becomes the triangles between the sides of the loop and the mean of its corners. These triangles cover exactly
    /// the interior of the loop if the loop is star-shaped about the mean, as star polygons are. A face with a single
    /// loop that is not flat, as in surfaces, is always filled with such triangles, and takes no steps. The triangles
    /// contain the sides of the loop, so neighboring faces meet.
    std::size_t fill(const SliceSet& slices, double circumradius, FilledFaces& out, std::size_t steps = kNoLimit,
                     std::size_t count = kNoLimit);

  private:
    // A side of a loop, from its lower to its upper end, in the coordinates (x, y) of the plane of the face. Horizontal
    // sides are left out.
    struct LoopSide {
        glm::dvec2 low, high;
        double slope;               // the slope of the side, dx/dy
        int winding;                // the change of the winding number across the side, from left to right
        std::uint32_t from, to;     // the levels of the lower and the upper end: indices into levels_
        double middle;              // x at half the height of the current strip (the region between two levels)
        double at(double y) const;  // returns x at height y
    };
    // A convex piece that is being built from the bottom up. It has a left and a right chain of corners so far, and the
    // sides that the two chains currently follow.
    struct ConvexPiece {
        static constexpr std::size_t kMaxCorners = 16;  // the maximum number of corners in a chain
        std::array<glm::dvec2, kMaxCorners> left, right;
        std::size_t leftCount, rightCount;
        std::uint32_t leftSide, rightSide;
        // hasPositiveWinding: whether the winding number in the piece is positive. continued: whether the piece extends
        // into the current strip (the region between two levels).
        bool hasPositiveWinding, continued;
    };
    // The place where the left side of an open piece arrives at the current level: its x coordinate, and the index of
    // the piece.
    struct PieceAtLevel {
        double x;
        std::uint32_t piece;
        auto operator<=>(const PieceAtLevel&) const = default;
    };
    // A plane in space: one of its points, and two orthonormal axes.
    struct FaceFrame {
        glm::dvec3 origin, x, y;
    };

    void fillFace(const SliceSet& slices, std::size_t slice, std::uint32_t begin, std::uint32_t end, FilledFaces& out);
    bool findFaceFrame(const SliceSet& slices, std::size_t slice, std::uint32_t begin, std::uint32_t end,
                       FilledFaces::FilledFace& out);
    bool isFlat(const FilledFaces::FilledFace& face) const;
    bool spendSteps(std::size_t steps);
    void findLoopSides(const SliceSet& slices, std::uint32_t begin, std::uint32_t end);
    void findSweepEvents();
    int sweep(FilledFaces& out);
    void fillRoughly(const SliceSet& slices, std::uint32_t begin, std::uint32_t end, FilledFaces& out) const;
    void sortActiveSides(double y);
    void addRegionBetweenSides(std::uint32_t left, std::uint32_t right, bool hasPositiveWinding, double bottom);
    bool canExtendPiece(const ConvexPiece& piece, const LoopSide& left, const LoopSide& right, double bottom) const;
    void closePiece(const ConvexPiece& piece, double top, FilledFaces& out) const;

    std::size_t stepsLeft_ = 0;
    double epsilon_ = 0;  // lengths up to this value are treated as 0
    FaceFrame faceFrame_{};
    std::vector<glm::dvec3> points_;  // the corners of the loops of the current face
    std::vector<LoopSide> sides_;
    std::vector<double> levels_;  // each height y at which a side begins, ends or crosses another, in ascending order
    std::vector<std::uint32_t> waiting_;  // the indices of all sides, sorted by their lower levels
    // The indices of the sides in the current strip (between two levels), from left to right.
    std::vector<std::uint32_t> active_;
    std::vector<ConvexPiece> open_;  // the pieces that may continue in the next strip
    // The places where open pieces from below arrive at the current strip, from left to right.
    std::vector<PieceAtLevel> arrivals_;
};

}  // namespace oval4d::slicing
