#pragma once
// Draws the surfaces of fields.

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/projection.hpp"
#include "render/shader_program.hpp"
#include "render/slices/shape_batch.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// A vertex of a surface.
struct SurfaceVertex {
    glm::vec3 clip;       ///< clip coordinates x, y, w
    glm::vec3 normal;     ///< in view coordinates, toward the eye
    std::uint32_t color;  ///< as returned by rgba(), not multiplied by alpha
};

/// The triangles of all surfaces of a scene, in drawing order. Reuses its memory for the next picture.
class SurfaceBatch {
  public:
    /// Whose surfaces are collected: those of all slices, of the nearer ones or of the farther ones, or the surfaces of
    /// the focus slice that the projection of the whole object shows. The nearer and the farther slices have about half
    /// of the triangles each.
    enum class Selection : std::uint8_t { slices, nearer_slices, farther_slices, projection };

    /// The place of the surfaces of a slice in the picture.
    struct Place {
        std::uint32_t slice;  ///< the index of the slice
        glm::dvec3 position;  ///< the origin of the slice, in world coordinates
        double scale;         ///< world units per unit of the object
    };

    /// Collects surfaces of a scene. Afterward, opaqueIndices() has the opaque surfaces, from the nearest slice to the
    /// farthest. If caps close a surface, opaqueIndices() omits the triangles of this surface that face
    /// away from the eye, because the surface hides them. translucentIndices() has the translucent surfaces, from the
    /// farthest slice to the nearest; within a slice, from the innermost level to the outermost; and within a level,
    /// first the triangles that face away from the eye. Extends `depths` to include the depths of the surfaces.
    ///
    /// The silhouettes of closed opaque surfaces get fringes: strips outside of them, one pixel wide, whose opacity
    /// decreases outward to 0. Blended with what is behind them, they antialias the silhouettes.
    void collect(const scene::Scene& scene, DepthRange& depths, Selection selection = Selection::slices);

    const std::vector<SurfaceVertex>& vertices() const { return vertices_; }
    /// Returns the opaque triangles, each as three indices of vertices. The entries from fringesBegin() on are the
    /// triangles of the fringes.
    const std::vector<std::uint32_t>& opaqueIndices() const { return opaqueIndices_; }
    std::size_t fringesBegin() const { return fringesBegin_; }
    const std::vector<std::uint32_t>& translucentIndices() const { return translucentIndices_; }
    /// Returns the places of the collected slices, from the farthest to the nearest. Empty if the scene has neither
    /// surfaces nor fog, or if the projection was selected and shows no surfaces.
    const std::vector<Place>& placesFarToNear() const { return order_; }
    /// Returns, for each entry of placesFarToNear(), the end of its triangles: an index in translucentIndices().
    const std::vector<std::size_t>& translucentEnds() const { return translucentEnds_; }

  private:
    // An edge of a triangle that faces the eye. Seen from the eye, the triangle is on the left of the edge. Both ends
    // of the edge also belong to triangles that face away. `from` and `to` are indices of points, `triangle` is the
    // index of the triangle.
    struct RimEdge {
        std::uint32_t from, to, triangle;
    };

    void keepHalf(const scene::Scene& scene, Selection half);
    void addLevel(const scene::Scene& scene, std::size_t slice, const scene::SurfaceLook::LevelLook& level);
    void addFringesOfLastLevel(const scene::Scene& scene, std::size_t slice,
                               const scene::SurfaceLook::LevelLook& level);
    void findSilhouette(const slicing::SliceSurface& surface);
    std::uint32_t colorOf(const scene::Scene& scene, std::size_t slice, const scene::SurfaceLook::LevelLook& level,
                          bool ofCap, std::uint32_t point, float alpha) const;

    Projection projection_;
    std::vector<Place> order_;  // from the farthest to the nearest
    std::vector<std::size_t> translucentEnds_;
    std::vector<glm::vec3> points_, normals_;  // those of the current slice, in view coordinates
    std::vector<std::uint32_t> number_;        // per point of the slice: its index in vertices_, or kNone
    // Per point of the slice: the index in vertices_ of the vertex of a cap that was last made at this point, or kNone.
    std::vector<std::uint32_t> capNumber_;
    std::vector<SurfaceVertex> vertices_;
    // Three indices of vertices per triangle. facing_ has the triangles of the current level that face the eye.
    std::vector<std::uint32_t> opaqueIndices_, translucentIndices_, facing_, fringes_;
    std::size_t fringesBegin_ = 0;
    std::vector<std::uint32_t> front_;       // the triangles of the current slice and level that face the eye
    std::vector<std::uint8_t> touchesBack_;  // per point: 1 if it belongs to a triangle that faces away from the eye
    std::vector<RimEdge> silhouette_;        // the silhouette of the current level in the current slice
    std::vector<glm::vec2> outward_;  // per point of the silhouette: a vector away from the surface, in the picture
};

/// Draws surfaces with diffuse and specular light.
class SurfaceProgram {
  public:
    explicit SurfaceProgram(const scene::Style& style);

    /// Draws triangles of `surfaces`, given by the indices of their vertices. The depth buffer covers `range`. The
    /// depth test must be enabled.
    void draw(DepthRange range, const SurfaceBatch& surfaces, const std::vector<std::uint32_t>& indices);

    /// Copies triangles of `surfaces`, given as for draw(), for later calls of drawPart().
    void load(DepthRange range, const SurfaceBatch& surfaces, const std::vector<std::uint32_t>& indices);
    /// Draws the triangles given by the entries `begin` … `end` − 1 of the indices that were loaded last. The depth
    /// test must be enabled.
    void drawPart(std::size_t begin, std::size_t end) { program_.drawPart(begin, end); }

  private:
    ShaderProgram program_;
    GLint toDepth_;
};

}  // namespace oval4d::render
