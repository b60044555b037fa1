#pragma once
// Prepares convex slices for drawing with the painter's algorithm (farther shapes first).

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "render/slices/shape_batch.hpp"
#include "render/slices/slice_ref.hpp"
#include "scene/scene.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::render {

/// Adds the shapes of convex slices to a batch, from back to front. The slices are added from far to near. In each
/// slice, this is the order:
/// - the faces that are turned away from the eye;
/// - the bars and balls that belong only to faces turned away from the eye;
/// - the faces that are turned toward the eye;
/// - the bars and balls that belong to at least one face turned toward the eye.
/// This order is correct if slices do not overlap in space. Reuses its memory for the next picture.
class ConvexShapeCollector {
  public:
    /// Adds all visible slices to `out`, as the camera of the scene sees them. Calls `painted` after each slice; this
    /// function may draw the shapes in `out` and clear `out`.
    void collect(const scene::Scene& scene, ShapeBatch& out, const std::function<void()>& painted);

  private:
    /// The side of a face, edge or vertex: turned away from the eye, or toward it.
    enum class FacingDirection : std::uint8_t { away, toward };

    void paintSlice(const SliceRef& slice, ShapeBatch& out);
    void transformVertices(const SliceRef& slice);
    void classifyFrontAndBack(const SliceRef& slice);
    void sortVerticesAndEdgesByDepth(const SliceRef& slice);
    void paintFaces(const SliceRef& slice, FacingDirection side, ShapeBatch& out);
    void paintSkeleton(const SliceRef& slice, FacingDirection side, ShapeBatch& out);

    std::vector<std::uint32_t> placementOrder_;  // the indices of the visible slices, from far to near
    // The points and normals of the current slice and the corners of the current face, in view coordinates.
    std::vector<glm::vec3> points_, corners_, normals_;
    std::vector<FacingDirection> faceSide_, edgeSide_, vertexSide_;
    // order_ has the vertices of the current slice from far to near. rank_ has, for each vertex, its index in order_.
    std::vector<std::uint32_t> order_, rank_;
    std::vector<std::uint32_t> edgeBegin_, edgeOrder_;  // edgeOrder_: the edges, ordered by the rank of their farther
                                                        // vertex; edgeBegin_: per rank, where its edges begin
};

}  // namespace oval4d::render
