#pragma once
// Draws density strips and histograms, which replace the lines of parallel coordinates. An object with many vertices
// has a density strip; a field has a histogram of its values.

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "render/shader_program.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Draws the density strip or the histogram of a scene, as textures. The colors of a strip are interpolated between the
/// colors of the axes. Each panel of a histogram has the color of its axis. Requires a current GL context throughout
/// its lifetime.
class DensityStripOrHistogramPainter {
  public:
    DensityStripOrHistogramPainter();
    ~DensityStripOrHistogramPainter();
    DensityStripOrHistogramPainter(const DensityStripOrHistogramPainter&) = delete;
    DensityStripOrHistogramPainter& operator=(const DensityStripOrHistogramPainter&) = delete;

    /// Draws the density strip or the histogram. Does nothing if the scene shows neither.
    void drawStripOrHistogram(const scene::Scene& scene);

  private:
    struct PlotVertex {
        glm::vec2 at{0};     // the clip coordinates of the vertex, −1 … 1
        glm::vec2 texel{0};  // the texture coordinates of the vertex, 0 … 1 from the upper left corner
        std::uint32_t color = 0;
    };

    void uploadTones(const std::vector<std::uint8_t>& tones, int columns);
    void addVerticalSide(const scene::Scene& scene, double x, double column, scene::Color color);
    void addQuadBetweenLastSides();

    ShaderProgram program_;
    GLuint texture_ = 0;
    int columns_ = 0, rows_ = 0;  // the size of the texture
    std::vector<PlotVertex> corners_;
    std::vector<std::uint32_t> indices_;
};

}  // namespace oval4d::render
