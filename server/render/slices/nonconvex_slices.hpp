#pragma once
// Prepares slices whose shapes may intersect for drawing with a depth buffer.

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "render/slices/shape_batch.hpp"
#include "render/slices/slice_ref.hpp"

namespace oval4d::render {

/// Sorts the shapes of slices that may be nonconvex into layers, and converts the shapes to patches (flat polygons).
/// Reuses its memory for the next picture.
class NonconvexShapeCollector {
  public:
    /// The layers of a picture, in drawing order. `faces` has the opaque faces, from near to far. `skeleton` has the
    /// opaque balls and bars, from far to near, so that their antialiased edges blend with the shapes behind them.
    /// `faded` has the faded shapes, from far to near; they do not hide other shapes.
    struct Layers {
        ShapeBatch faces, skeleton, faded;
        DepthRange depths;  ///< contains the depths of all shapes
    };

    /// Overwrites `out` with the shapes of all visible slices, as the camera of the scene sees them. Takes the faces
    /// from Scene::fill.
    void collect(const scene::Scene& scene, Layers& out);

  private:
    enum class ShapeKind : std::uint8_t { ball, bar, face };
    struct SortedShape {
        float depth;  // the distance from the eye along the view axis
        ShapeKind kind;
        // `number` is the index of a face in Scene::fill, or of a vertex or edge of the slice.
        std::uint32_t slice, number;
    };

    void collectShapesOf(const SliceRef& slice, DepthRange& depths);
    void addUnlessHidden(const SortedShape& item, slicing::Visibility visibility);
    void addShape(const SliceRef& slice, const SortedShape& item, const SkeletonStyle& skeleton, ShapeBatch& out);
    void addFace(const SliceRef& slice, std::uint32_t number, ShapeBatch& out);

    std::vector<SliceTransform> transforms_;  // one transform per slice
    // The vertices of the current slice and the corners of the current face, in view coordinates.
    std::vector<glm::vec3> points_, corners_;
    std::vector<SortedShape> faces_, skeleton_, faded_;
};

}  // namespace oval4d::render
