#pragma once
// Prepares the projection of the whole object for drawing with a depth buffer.

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "render/slices/depth_order.hpp"
#include "render/slices/shape_batch.hpp"
#include "render/slices/shape_rasterizer.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Sorts the shapes of the projection of the whole object, and of the sections that are shown in it, into layers, and
/// converts them to patches. Drawing them needs a depth buffer, because bars of the projection cross each other
/// everywhere in the picture. The projection must be drawn before the slices, which hide it wherever they are drawn.
/// Reuses its memory for the next picture.
class ProjectionShapeCollector {
  public:
    /// The layers, in drawing order, each from far to near. `solid` has the opaque balls and bars of the object;
    /// because of the order, their antialiased edges blend with the shapes behind them. `translucent` has faces,
    /// sections and faded shapes; none of these hides other shapes.
    struct Layers {
        ShapeBatch solid, translucent;
        DepthRange depths;  ///< contains the depths of all shapes

        /// Returns a rectangle of a picture of this size that contains all pixels of the shapes. Only this part of the
        /// depth buffer must be cleared for them.
        PixelArea pixelArea(scene::Viewport viewport) const;
    };

    /// Overwrites `out` with the projection, as the camera of the scene sees it. The scene must show the projection.
    void collect(const scene::Scene& scene, Layers& out);

  private:
    enum class ShapeKind : std::uint8_t { ball, bar, face, piece };
    struct ProjectedShape {
        float depth;  // the distance from the eye along the view axis
        ShapeKind kind;
        // number: the index of a vertex, edge or face in ObjectProjection::elements, or of a piece in
        // ObjectProjection::fill
        std::uint32_t part, number;
    };

    void collectPart(const scene::Scene& scene, std::uint32_t part);
    void addShape(const scene::Scene& scene, const ProjectedShape& item, ShapeBatch& out);
    void addPolygon(scene::Color color, float opacity, ShapeBatch& out) const;

    // In view coordinates: the vertices of the projection, the corners of its fill, and those of the current polygon.
    std::vector<glm::vec3> points_, fillPoints_, corners_;
    std::vector<ProjectedShape> solid_, translucent_;  // by part, kind and number
    DepthOrder order_;
};

}  // namespace oval4d::render
