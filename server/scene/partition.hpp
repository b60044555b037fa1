#pragma once
// The faces of slices that are not convex, filled and cut so that they can be drawn from far to near: a binary space
// partition (Fuchs, Kedem and Naylor, "On visible surface generation by a priori tree structures", 1980).

#include <cstdint>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "geometry/fill.hpp"
#include "geometry/polytope.hpp"
#include "geometry/slicer.hpp"
#include "scene/coverage.hpp"

namespace oval4d::scene {

struct Presences;

/// A tree for each slice. All is in the slices' own axes and units. Keeps its memory between calls.
class Partition {
  public:
    static constexpr std::uint32_t kNone = 0xffffffffU;     ///< of nodes: a region without faces in it
    static constexpr std::uint32_t kCovered = 0xfffffffeU;  ///< of nodes: a region that cannot be seen

    /// A convex part of a face: the loop of the corners from `begin` to `end` − 1; none where it is covered.
    struct Piece {
        std::uint32_t patch, begin, end;
        double area;
    };
    /// The pieces from `begin` to `end` − 1 lie in the plane dot(normal, x) = offset; all those of the node `below` (or
    /// kNone, kCovered) on the one side of it, of `above` on the other.
    struct Node {
        glm::dvec3 normal;
        double offset;
        std::uint32_t below, above;
        std::uint32_t begin, end;

        double height(const glm::dvec3& x) const { return glm::dot(normal, x) - offset; }
    };
    /// From where one slice is seen: the eye in the slice's axes, the way from there to pixels (after division by the
    /// fourth coordinate), how many of them a unit takes, and whether the slice is drawn at all.
    struct View {
        glm::dvec3 eye;
        glm::dmat4 toPixels;
        double pixelsPerUnit;
        bool drawn = true;
    };

    /// Fills the faces of the slices, but for hidden ones, and makes the trees; or clears them all where the polytope
    /// is convex, since then its slices are, and need none. With `views`, one for each slice, the trees are for these:
    /// what so many faces cover that less than a level of colour is left of it is left out, and pieces of a few square
    /// pixels are not cut any more, but stand on one side of a plane as a whole. Without, they are for any eye.
    void build(const geometry::Polytope& polytope, const geometry::SliceSet& slices, const Presences& presences,
               std::span<const View> views = {});
    void clear() { roots_.clear(); }

    bool empty() const { return roots_.empty(); }
    std::uint32_t root(std::size_t slice) const { return roots_[slice]; }
    const Node& node(std::uint32_t number) const { return nodes_[number]; }
    const Piece& piece(std::uint32_t number) const { return pieces_[number]; }
    const geometry::Fill::Patch& patch(const Piece& piece) const { return fill_.patches[piece.patch]; }
    const glm::dvec3& corner(std::uint32_t number) const { return corners_[number]; }

    /// Lengths below this are taken for 0: what lies so near to a plane lies in it.
    double tiny() const { return tiny_; }

    /// Calls visit(piece) for every piece of a slice, from far to near as seen from `eye`.
    template <typename Visit>
    void fromFarToNear(std::size_t slice, const glm::dvec3& eye, Visit&& visit) const {
        if (!empty()) walk(roots_[slice], eye, visit);
    }

  private:
    enum class Where : std::uint8_t { in, below, above, across };
    struct Plane {
        glm::dvec3 normal;
        double offset;
    };

    void take(std::size_t slice, const Presences& presences);
    void begin(const View* view);
    std::uint32_t grow(std::size_t begin, int depth);
    void lay(Piece& piece);
    Plane planeOf(const Piece& piece) const { return {patch(piece).normal, patch(piece).offset}; }
    Plane choose(std::size_t begin, std::size_t end);
    bool parts(const Plane& plane, std::size_t begin, std::size_t end) const;
    double cost(const Plane& plane, std::size_t begin, std::size_t end) const;
    Where whereIs(const Piece& piece, const Plane& plane) const;
    void cut(const Piece& piece, const Plane& plane, Piece& below, Piece& above);
    void addCorner(const glm::dvec3& corner);
    glm::vec2 pixelOf(const glm::dvec3& corner) const;
    double areaOf(const Piece& piece) const;
    std::span<const glm::vec2> outlineOf(const Piece& piece) const {
        return {outline_.data() + piece.begin, piece.end - piece.begin};
    }

    template <typename Visit>
    void walk(std::uint32_t number, const glm::dvec3& eye, Visit&& visit) const {
        if (number >= kCovered) return;
        const Node& at = nodes_[number];
        const bool isAbove = at.height(eye) > 0;
        walk(isAbove ? at.below : at.above, eye, visit);
        for (std::uint32_t i = at.begin; i < at.end; ++i) {
            if (pieces_[i].begin < pieces_[i].end) visit(pieces_[i]);
        }
        walk(isAbove ? at.above : at.below, eye, visit);
    }

    geometry::Filler filler_;
    geometry::Fill fill_;
    double tiny_ = 0;
    std::size_t most_ = 0;  // pieces: beyond, nothing more is cut
    std::vector<std::uint32_t> roots_;
    std::vector<Node> nodes_;
    std::vector<Piece> pieces_;
    std::vector<glm::dvec3> corners_;

    // Of the slice at hand.
    const View* view_ = nullptr;
    double smallest_ = 0;  // area
    Coverage coverage_;
    std::vector<glm::vec2> outline_;  // the corners in the picture
    std::vector<int> weights_;        // of each patch
    std::vector<Piece> todo_, near_;  // todo_ is a stack of lists
    std::vector<double> middles_, heights_;
};

}  // namespace oval4d::scene
