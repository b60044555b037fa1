#pragma once
// Drawing of slices whose shapes may intersect, with a depth buffer.

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "render/slices/shape_batch.hpp"
#include "render/slices/slice_view.hpp"

namespace oval4d::render {

/// Prepares layers of shapes for slices that need not be convex. Reuses its memory for the next picture.
class NonconvexSlicePainter {
  public:
    /// Layers in drawing order: opaque faces from near to far; opaque balls and bars from far to near, so that their
    /// antialiased edges blend with what is behind them; faded shapes from far to near, which hide nothing.
    struct Layers {
        ShapeBatch faces, skeleton, faded;
        DepthRange depths;  ///< the range that contains all shapes
    };

    /// Adds all visible slices, with the scene's fill, as seen through the scene's camera. Overwrites `out`.
    void paint(const scene::Scene& scene, Layers& out);

  private:
    enum class Kind : std::uint8_t { ball, bar, patch };
    struct Item {
        float depth;
        Kind kind;
        std::uint32_t slice, number;  // number: the patch in the fill, or the vertex or edge in the slice
    };

    void collect(const SliceView& slice, DepthRange& depths);
    void add(const Item& item, slicing::Visibility visibility);
    void paintItem(const SliceView& slice, const Item& item, const Skeleton& skeleton, ShapeBatch& out);
    void paintPatch(const SliceView& slice, std::uint32_t number, ShapeBatch& out);

    std::vector<SliceTransform> transforms_;   // of the slices
    std::vector<glm::vec3> points_, corners_;  // in view coordinates
    std::vector<Item> faces_, skeleton_, faded_;
};

}  // namespace oval4d::render
