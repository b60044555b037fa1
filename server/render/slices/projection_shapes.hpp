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

/// Converts the shapes of the projection of the whole object, and of the sections that are shown in the projection, to
/// patches (flat polygons), and sorts them into layers. Drawing the layers needs a depth buffer, because bars of the
/// projection cross each other everywhere in the picture. The projection must be drawn before the slices, because a
/// slice must cover the projection wherever both overlap. Reuses its memory for the next picture.
class ProjectionShapeCollector {
  public:
    /// The layers, in drawing order, each from far to near. `solid` has the opaque balls and bars of the object.
    /// Because of the order, their antialiased edges blend with the shapes behind them. `translucent` has faces,
    /// sections and faded shapes, which do not hide other shapes.
    struct Layers {
        ShapeBatch solid, translucent;
        DepthRange depths;  ///< contains the depths of all shapes

        /// Returns a rectangle that contains all pixels of the shapes in a picture with the size of `viewport`. Only
        /// this part of the depth buffer must be cleared for the shapes.
        PixelArea pixelArea(scene::Viewport viewport) const;
    };

    /// Overwrites `out` with the projection of the whole object, as the camera of the scene sees it. The scene must
    /// show the projection.
    void collect(const scene::Scene& scene, Layers& out);

  private:
    enum class ShapeKind : std::uint8_t { ball, bar, face, piece };
    struct ProjectedShape {
        float depth;  // the distance from the eye along the view axis
        ShapeKind kind;
        // `number` is the index of a vertex, edge or face in ObjectProjection::elements, or of a piece in
        // ObjectProjection::fill.
        std::uint32_t part, number;
    };

    void collectPart(const scene::Scene& scene, std::uint32_t part);
    void addShape(const scene::Scene& scene, const ProjectedShape& item, ShapeBatch& out);
    void addPolygon(scene::Color color, float opacity, ShapeBatch& out) const;

    // In view coordinates: the vertices of the projection, the corners of its filled faces, and the corners of the
    // current polygon.
    std::vector<glm::vec3> points_, fillPoints_, corners_;
    std::vector<ProjectedShape> solid_, translucent_;  // the shapes of the two layers
    DepthSorter order_;
};

}  // namespace oval4d::render
