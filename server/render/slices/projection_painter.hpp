#pragma once
// Draws the projection of the whole object, with a depth buffer.

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "render/slices/shape_batch.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Prepares the shapes of the projection of the whole object and of the sections in it. Its bars cross in front of each
/// other everywhere, so they need a depth buffer. Reuses its memory for the next picture.
class ProjectionPainter {
  public:
    /// The layers in drawing order: the object's opaque balls and bars from far to near, so that their antialiased
    /// edges blend with the shapes behind them; then faces, sections and faded shapes from far to near, which do not
    /// hide other shapes.
    struct Layers {
        ShapeBatch solid, translucent;
        DepthRange depths;  ///< contains the depths of all shapes
    };

    /// Overwrites `out` with the scene's projection, which must be shown, as the scene's camera sees it.
    void paint(const scene::Scene& scene, Layers& out);

  private:
    enum class Kind : std::uint8_t { ball, bar, face };
    struct Item {
        float depth;  // distance from the eye along the view axis
        Kind kind;
        std::uint32_t part, number;  // number: index of the vertex, edge or face in the projection's elements
    };

    void collect(const scene::Scene& scene, std::uint32_t part);
    void paintItem(const scene::Scene& scene, const Item& item, ShapeBatch& out);

    std::vector<glm::vec3> points_, corners_;  // in view coordinates
    std::vector<Item> solid_, translucent_;
};

}  // namespace oval4d::render
