#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "parallel/fork_join.hpp"
#include "render/renderer.hpp"
#include "scene/composer.hpp"
#include "scene/picture_request.hpp"
#include "slicing/slicer.hpp"

namespace oval4d::raster {

/// The time that each step of drawing a picture took, in seconds: slicing the object, composing the scene, and
/// rendering the scene.
struct DrawTimes {
    double slice = 0, compose = 0, draw = 0;
};

/// The interface of rasterizers, which draw pictures in this process or in another one. Only one thread at a time may
/// use a rasterizer.
class Rasterizer {
  public:
    virtual ~Rasterizer() = default;

    /// Prepares for drawing, so that the first picture takes no longer than later pictures. Returns when the rasterizer
    /// is ready to draw. Throws std::runtime_error if pictures cannot be drawn.
    virtual void warmUp() = 0;

    /// Draws a picture, and sets `times` to the times of the steps. Returns the pixels, with the layout of
    /// image::Image. They are valid until the next call of draw() or freeMemory(). Throws std::runtime_error if drawing
    /// fails.
    virtual std::span<const std::uint8_t> draw(const scene::PictureRequest& picture, DrawTimes& times) = 0;

    /// Frees the memory that this object keeps between pictures. The next picture then takes longer to draw.
    virtual void freeMemory() = 0;
};

/// A rasterizer that draws in this process. The first call of warmUp() or draw() creates the GL context. From then on,
/// only the thread that made this call may use and destroy the rasterizer.
class LocalRasterizer : public Rasterizer {
  public:
    /// If `forkJoin` is not null, the rasterizer slices and draws on two cores. `forkJoin` must outlive this object.
    explicit LocalRasterizer(parallel::ForkJoin* forkJoin = nullptr) : forkJoin_(forkJoin), workspace_(forkJoin) {}

    /// Sets the maximum number of steps in which the self-intersecting faces of one picture are filled (see
    /// slicing::FaceFiller::fill()).
    void limitFaceFilling(std::size_t steps) { fillSteps_ = steps; }
    /// Sets the maximum number of steps of the search, in one picture, for elements that lie behind other cells (see
    /// slicing::OcclusionFinder::findDrawnElements()).
    void limitOcclusion(std::size_t steps) { occlusionSteps_ = steps; }

    void warmUp() override;
    std::span<const std::uint8_t> draw(const scene::PictureRequest& picture, DrawTimes& times) override;
    /// Frees the memory that this object keeps between pictures, except what Renderer::freeMemory() keeps, such as the
    /// GL context.
    void freeMemory() override;

    /// Draws a picture into `pixels`, and sets `times`. Throws std::invalid_argument if `pixels` does not have the size
    /// of the viewport (see image::byteCount()).
    void draw(const scene::PictureRequest& picture, std::span<std::uint8_t> pixels, DrawTimes& times);

  private:
    // The objects that this rasterizer keeps between pictures, so that the next picture needs no new memory.
    struct Workspace {
        explicit Workspace(parallel::ForkJoin* forkJoin) : slicer(forkJoin) {}
        slicing::Slicer slicer;
        slicing::SurfaceDetail detail;
        slicing::SliceSet slices;
        scene::Composer composer;
        scene::Scene scene;
        std::vector<std::uint8_t> pixels;
    };

    parallel::ForkJoin* forkJoin_;
    std::size_t fillSteps_ = slicing::FaceFiller::kNoLimit;
    std::size_t occlusionSteps_ = slicing::OcclusionFinder::kDefaultSteps;
    std::optional<render::Renderer> renderer_;  // created when it is first used
    Workspace workspace_;
};

/// Runs `work` and returns how long it took, in seconds. This function is a template because a parameter of the type
/// std::function might allocate memory.
template <typename Work>
double measureSeconds(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace oval4d::raster
