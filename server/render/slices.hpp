#pragma once
// The slices of a scene as shapes in painter's order.

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "geometry/slice_set.hpp"
#include "render/slice_view.hpp"
#include "render/solids.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Sorts and adds. The order is exact for slices that stand clear of each other: slices from far to near; in each,
/// which must be convex, the faces turned away, the bars and balls among them, the faces turned to the eye, then the
/// other bars and balls. Keeps its memory from one picture to the next.
class SlicePainter {
  public:
    /// Adds all slices that are drawn, seen through the scene's camera, and calls `painted` after each: it may draw
    /// what there is so far, and clear it.
    void paint(const geometry::Polytope& polytope, const geometry::SliceSet& slices, const scene::Scene& scene,
               Solids& out, const std::function<void()>& painted);

  private:
    enum class Side : std::uint8_t { away, toward };

    void paintSlice(const SliceView& slice, Solids& out);
    void place(const SliceView& slice);
    void classify(const SliceView& slice);
    void sortByDepth(const SliceView& slice);
    void paintFaces(const SliceView& slice, Side side, Solids& out);
    void paintFrame(const SliceView& slice, Side side, Solids& out);

    std::vector<std::uint32_t> standOrder_;
    std::vector<glm::vec3> points_, corners_, normals_;  // in view axes
    std::vector<Side> faceSide_, edgeSide_, vertexSide_;
    std::vector<std::uint32_t> order_, rank_;           // vertices from far to near, and back
    std::vector<std::uint32_t> edgeBegin_, edgeOrder_;  // edges by their farther vertex
};

}  // namespace oval4d::render
