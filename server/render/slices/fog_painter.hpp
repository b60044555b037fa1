#pragma once
// Draws the fog of fields by ray casting, with OpenGL.

#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "render/gl.hpp"
#include "render/projection.hpp"
#include "render/shader_program.hpp"
#include "render/slices/shape_batch.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Draws the fog of slices. For each pixel, follows the ray from the eye through the fog lattice of a slice to the
/// nearest solid shape, and sums emission and absorption (N. Max, "Optical models for direct volume rendering", 1995).
/// Let a be the opacity of a layer of fog that is as thick as the object's circumradius. Then a segment of the ray with
/// the length s, in circumradii, absorbs the fraction 1 − (1 − a)^s of the light. The maximum of a is 1 −
/// kMinTransmittance. Rays skip blocks of the lattice that contain no fog. Requires a current GL context throughout its
/// lifetime.
class FogPainter {
  public:
    /// The minimum fraction of light that passes through a layer of fog as thick as the object's circumradius.
    static constexpr double kMinTransmittance = 1e-4;

    FogPainter();
    ~FogPainter();
    FogPainter(const FogPainter&) = delete;
    FogPainter& operator=(const FogPainter&) = delete;

    /// Prepares for drawing the fog of a scene: loads the fog lattices of the visible slices into textures. `range` is
    /// the range of distances from the eye that the depth buffer covers.
    void begin(const scene::Scene& scene, DepthRange range);

    /// The kinds of shapes that hide fog: `frame` stands for the balls and bars, whose antialiased edges are
    /// translucent, and `surfaces` for the surfaces of the field.
    enum class FogOccluders : std::uint8_t { frame, surfaces };
    /// Copies the depth buffer to a texture for later calls of draw(). All shapes of the kind `occluders`, and no
    /// shapes of the other kind, must have been drawn to the depth buffer.
    void copyOccluderDepths(scene::Viewport viewport, FogOccluders occluders);

    /// A part of the fog between the eye and the nearest surface. `behind` is the fog behind the nearest ball or bar.
    /// This part must be drawn before balls and bars are drawn, so that it is visible through their antialiased edges.
    /// `in_front` is the fog in front of the nearest ball or bar; where there is no ball or bar, it is all of the fog.
    enum class FogPart : std::uint8_t { behind, in_front };
    /// Blends the part `part` of the fog of one slice with the picture. The caller must first call copyOccluderDepths()
    /// for both kinds of occluders, and must draw the slices from far to near. Leaves the depth test enabled.
    void draw(const scene::Scene& scene, std::uint32_t slice, FogPart part);

    /// Frees the memory that is kept for the next picture. Keeps the textures of the last picture, because deleting
    /// them requires the context of this object, and another context may be current. The textures take two bytes for
    /// each lattice point, and two depths for each pixel.
    void freeMemory() { texels_ = blockTexels_ = {}; }

  private:
    // A corner of the box that the fog lattice of a slice fills. Drawing the box runs the shader for the pixels that
    // the box covers.
    struct BoxCorner {
        glm::vec3 clip;   // the clip coordinates x, y and, in clip.z, w
        glm::vec3 place;  // the coordinates of the corner in the slice, in circumradii
    };
    void uploadLattice(const slicing::SliceFog& fog);
    void uploadBlockMask(const slicing::SliceFog& fog, const scene::FogTransferTable& table);
    void deleteLattices();

    ShaderProgram program_;
    struct {
        GLint toDepth, isBehind, eye, walls, wallCount, low, size, step;
    } uniforms_{};
    GLuint table_ = 0, frameDepths_ = 0, surfaceDepths_ = 0;
    // Per slice: the texture of its lattice, and that of its blocks; 0 if the slice has no fog.
    std::vector<GLuint> lattices_, blocks_;
    ViewProjection projection_;
    glm::dmat4 toView_{1};
    std::vector<std::uint8_t> texels_, blockTexels_;
};

}  // namespace oval4d::render
