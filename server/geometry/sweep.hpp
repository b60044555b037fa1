#pragma once
// A convex polytope cut by a hyperplane that rises through it.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "geometry/passing.hpp"
#include "geometry/polytope.hpp"
#include "geometry/settling.hpp"
#include "geometry/slice_set.hpp"

namespace oval4d::geometry {

/// A hyperplane rises through the polytope, and what it cuts is kept: where it cuts an edge there is a vertex of the
/// slice, where a 2-face one edge, where a cell one face. The section of a 2-face runs from the edge where its loop
/// comes up through the hyperplane to the one where it goes down, and the section of a cell goes on, across an edge,
/// with the next 2-face around that edge: both change only where an edge begins to be cut. Between two levels of
/// vertices nothing changes but where the points are. Keeps its scratch memory between calls.
class Sweep {
  public:
    /// Takes up a polytope and finds what `planes` hyperplanes cut of it. The levels, which count these alone, must
    /// live until `cut` has returned. False where rounding errors in the vertices make it so that a hyperplane cuts a
    /// 2-face or a cell twice.
    bool begin(const Polytope& polytope, Levels levels, int planes);

    /// Of all slices. Those in hyperplanes that vertices lie in become smaller.
    SliceSize size() const { return size_; }

    /// Makes the slices numbers `first` … of `out`, whose turned vertices are there and which has room, with their
    /// elements from `at` on; `at` becomes where they end. Where the polytope touches a hyperplane from one side,
    /// `touching` has its slice by hyperplane, as a set of one; it is empty where there is none. False as above.
    bool cut(const Polytope& polytope, std::span<SliceSet* const> touching, int first, SliceSize& at, SliceSet& out);

  private:
    // The point of an edge at w is at + (w − at.w) · perRise.
    struct alignas(16) Ray {
        glm::dvec4 at;
        glm::dvec3 perRise;
    };
    struct Span {
        std::int32_t from, to;
    };
    // Whether there are vertices between a hyperplane and the one below, or any in it.
    enum class Risen : std::uint8_t { no, over, into };
    void findSteps(const Polytope& polytope, int planes);
    bool findElements(const Polytope& polytope, int planes);
    void rise(const Polytope& polytope, const std::vector<glm::dvec4>& turned, int plane);
    void beginEdge(const Polytope& polytope, std::uint32_t edge, const std::vector<glm::dvec4>& turned);
    SliceSize sizeOfSlice() const { return {edges_.size(), faces_.size(), cells_.size(), 2 * faces_.size()}; }
    bool write(int plane, int end, SliceSize at, SliceSet& out);
    void writeVertices(int plane, int end, SliceSize at, SliceSet& out);
    void writeEdges(SliceSize at, SliceSet& out);
    bool writeFaces(SliceSize at, SliceSet& out) const;

    Levels levels_;
    SliceSize size_;
    int first_ = 0;
    Passing edges_, faces_, cells_;
    std::vector<Span> faceSpan_;
    std::vector<Risen> risen_;  // by hyperplane
    std::vector<int> steps_;    // the first hyperplane, those that are risen to over vertices, and past the last one
    std::vector<Ray> ray_;      // by edge that is cut
    std::vector<std::uint32_t> vertex_;  // by edge that is cut: its slice vertex
    std::vector<std::uint32_t> line_;    // by 2-face that is cut: its slice edge
    // The loop of 2-face f comes up through the hyperplane at edge end_[2 f] and goes down at edge end_[2 f + 1]. In
    // its cell number i the section runs to end 2 f + i: from there it goes on to the end next_[2 f + i].
    std::vector<std::uint32_t> end_, next_;
    std::vector<std::uint32_t> home_;  // by cell that is cut: an end that its section runs to
    Settling settling_;
};

}  // namespace oval4d::geometry
