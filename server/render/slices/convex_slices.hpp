#pragma once
// Drawing of convex slices with the painter's algorithm.

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "render/slices/shape_batch.hpp"
#include "render/slices/slice_view.hpp"
#include "scene/scene.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::render {

/// Adds the shapes of convex slices in back-to-front order: slices from far to near and, in each slice, back faces, the
/// bars and balls between them, front faces, and the remaining bars and balls. The order is exact if slices do not
/// overlap in space. Reuses its memory for the next picture.
class ConvexSlicePainter {
  public:
    /// Adds all visible slices, as seen through the scene's camera. Calls `painted` after each slice; it may draw the
    /// shapes so far and clear `out`.
    void paint(const scene::Scene& scene, ShapeBatch& out, const std::function<void()>& painted);

  private:
    enum class Side : std::uint8_t { away, toward };

    void paintSlice(const SliceView& slice, ShapeBatch& out);
    void place(const SliceView& slice);
    void classify(const SliceView& slice);
    void sortByDepth(const SliceView& slice);
    void paintFaces(const SliceView& slice, Side side, ShapeBatch& out);
    void paintSkeleton(const SliceView& slice, Side side, ShapeBatch& out);

    std::vector<std::uint32_t> placementOrder_;
    std::vector<glm::vec3> points_, corners_, normals_;  // in view coordinates
    std::vector<Side> faceSide_, edgeSide_, vertexSide_;
    std::vector<std::uint32_t> order_, rank_;           // vertices from far to near; the inverse permutation
    std::vector<std::uint32_t> edgeBegin_, edgeOrder_;  // edges grouped by their farther vertex
};

}  // namespace oval4d::render
