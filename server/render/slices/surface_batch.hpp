#pragma once
// Collects the surfaces of fields as triangles, and draws them with OpenGL.

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
    glm::vec3 clip;       ///< the clip coordinates x, y and, in clip.z, w
    glm::vec3 normal;     ///< the normal in view coordinates, toward the eye
    std::uint32_t color;  ///< the color, as returned by rgba(), not multiplied by alpha
};

/// The triangles of the surfaces of a scene, in drawing order. Reuses its memory for the next picture.
class SurfaceBatch {
  public:
    /// The slices whose surfaces are collected: all slices, only the nearer slices, or only the farther slices. The
    /// nearer and the farther slices have about half of the triangles each. `projection` stands for the surfaces of the
    /// focus slice (the middle one) as the projection of the whole object shows them.
    enum class SliceSelection : std::uint8_t { slices, nearer_slices, farther_slices, projection };

    /// The place of one slice, with its surfaces, in the picture.
    struct SurfacePlacement {
        std::uint32_t slice;  ///< the index of the slice
        glm::dvec3 position;  ///< the origin of the slice, in world coordinates
        double scale;         ///< the number of world units per unit of the object
    };

    /// Collects surfaces of a scene. Afterward, opaqueIndices() has the opaque surfaces, from the nearest slice to the
    /// farthest. If caps (parts of the domain's boundary) close a surface, the surface hides its own triangles that
    /// face away from the eye; these triangles are left out. translucentIndices() has the translucent surfaces, from
    /// the farthest slice to the nearest. Within a slice, they are ordered from the innermost level to the outermost;
    /// within a level, the triangles that face away from the eye come first. Extends `depths` to include the depths of
    /// the surfaces.
    ///
    /// The silhouettes of closed opaque surfaces get fringes: strips outside of the silhouettes, one pixel wide, whose
    /// opacity decreases outward to 0. Blended with what is behind them, the fringes antialias the silhouettes.
    void collect(const scene::Scene& scene, DepthRange& depths, SliceSelection selection = SliceSelection::slices);

    const std::vector<SurfaceVertex>& vertices() const { return vertices_; }
    /// Returns the corners of the opaque triangles: three indices of vertices for each triangle. The entries from
    /// antialiasingFringesBegin() on belong to the triangles of the fringes.
    const std::vector<std::uint32_t>& opaqueIndices() const { return opaqueIndices_; }
    std::size_t antialiasingFringesBegin() const { return fringesBegin_; }
    const std::vector<std::uint32_t>& translucentIndices() const { return translucentIndices_; }
    /// Returns the places of the collected slices, from the farthest to the nearest. The list is empty if the scene has
    /// neither surfaces nor fog, or if the projection was selected and shows no surfaces.
    const std::vector<SurfacePlacement>& slicesFarToNear() const { return order_; }
    /// Returns, for each entry of slicesFarToNear(), the index in translucentIndices() at which the triangles of this
    /// slice end.
    const std::vector<std::size_t>& translucentEnds() const { return translucentEnds_; }

  private:
    // An edge of a triangle that faces the eye. Seen from the eye, the triangle is on the left of the edge. Both ends
    // of the edge also belong to triangles that face away from the eye. `from` and `to` are indices of points, and
    // `triangle` is the index of the triangle.
    struct SilhouetteEdge {
        std::uint32_t from, to, triangle;
    };

    void keepOnlySlicesIn(const scene::Scene& scene, SliceSelection half);
    void addLevel(const scene::Scene& scene, std::size_t slice, const scene::SurfaceLook::LevelLook& level);
    void addAntialiasingFringes(const scene::Scene& scene, std::size_t slice,
                                const scene::SurfaceLook::LevelLook& level);
    void findSilhouette(const slicing::SliceSurface& surface);
    std::uint32_t colorOf(const scene::Scene& scene, std::size_t slice, const scene::SurfaceLook::LevelLook& level,
                          bool ofCap, std::uint32_t point, float alpha) const;

    ViewProjection projection_;
    std::vector<SurfacePlacement> order_;  // the places of the slices, from the farthest to the nearest
    std::vector<std::size_t> translucentEnds_;
    std::vector<glm::vec3> points_, normals_;  // the points and normals of the current slice, in view coordinates
    // Per point of the slice: the index in vertices_ of the vertex made for the point, or kNone.
    std::vector<std::uint32_t> number_;
    // Per point of the slice: the index in vertices_ of the vertex that was last made for a cap at this point, or
    // kNone.
    std::vector<std::uint32_t> capNumber_;
    std::vector<SurfaceVertex> vertices_;
    // Three indices of vertices per triangle. facing_ has those triangles of the current level that face the eye.
    std::vector<std::uint32_t> opaqueIndices_, translucentIndices_, facing_, fringes_;
    std::size_t fringesBegin_ = 0;
    std::vector<std::uint32_t> front_;  // the indices of the triangles of the current slice and level that face the eye
    // Per point: 1 if the point belongs to a triangle that faces away from the eye, else 0.
    std::vector<std::uint8_t> touchesBack_;
    std::vector<SilhouetteEdge> silhouette_;  // the edges of the silhouette of the current level in the current slice
    // Per point of the silhouette: a vector in the picture that points away from the surface; its length does not
    // matter.
    std::vector<glm::vec2> outward_;
};

/// The shader program that draws surfaces with diffuse and specular light.
class SurfaceProgram {
  public:
    explicit SurfaceProgram(const scene::PictureStyle& style);

    /// Draws triangles of `surfaces`, given by three indices of vertices each. The depth buffer covers `range`. The
    /// depth test must be enabled.
    void draw(DepthRange range, const SurfaceBatch& surfaces, const std::vector<std::uint32_t>& indices);

    /// Copies triangles of `surfaces`, given by three indices of vertices each, for later calls of drawIndexRange().
    void uploadTriangles(DepthRange range, const SurfaceBatch& surfaces, const std::vector<std::uint32_t>& indices);
    /// Draws the triangles whose corners are the entries `begin` … `end` − 1 of the indices that uploadTriangles() has
    /// copied last. The depth test must be enabled.
    void drawIndexRange(std::size_t begin, std::size_t end) { program_.drawIndexRange(begin, end); }

  private:
    ShaderProgram program_;
    GLint toDepth_;
};

}  // namespace oval4d::render
