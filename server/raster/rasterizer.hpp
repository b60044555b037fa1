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
#include "session/session.hpp"
#include "slicing/slicer.hpp"

namespace oval4d::raster {

/// The seconds that each step of drawing one picture took: slicing the object, composing the scene, and rendering it.
struct DrawTimes {
    double slice = 0, compose = 0, draw = 0;
};

/// Draws pictures of session states, in this process or in another one. A rasterizer may be used by one thread at a
/// time.
class Rasterizer {
  public:
    virtual ~Rasterizer() = default;

    /// Prepares for drawing, so that the first picture takes no longer than later ones. Returns when all is ready.
    /// Throws std::runtime_error if pictures cannot be drawn.
    virtual void warmUp() = 0;

    /// Draws the picture of `state`, sets `times`, and returns the pixels in the format of image::Image, which are
    /// valid until the next call. Throws std::runtime_error if drawing fails.
    virtual std::span<const std::uint8_t> draw(const session::State& state, scene::Viewport viewport,
                                               DrawTimes& times) = 0;

    /// Frees cached memory.
    virtual void freeMemory() = 0;
};

/// A rasterizer that draws in this process. The first call of warmUp() or draw() creates the GL context, which is bound
/// to the calling thread.
class LocalRasterizer : public Rasterizer {
  public:
    explicit LocalRasterizer(parallel::ForkJoin* forkJoin = nullptr) : forkJoin_(forkJoin), memory_(forkJoin) {}

    /// Limits the time for filling self-intersecting faces in one picture. `steps`: see slicing::Filler::fill.
    void limitFill(std::size_t steps) { fillSteps_ = steps; }

    void warmUp() override;
    std::span<const std::uint8_t> draw(const session::State& state, scene::Viewport viewport,
                                       DrawTimes& times) override;
    /// Frees the memory that is reused from picture to picture. Keeps the GL context, the shader programs, and the font
    /// with its glyphs.
    void freeMemory() override;

    /// Draws into `pixels`, whose size must match the viewport.
    void draw(const session::State& state, scene::Viewport viewport, std::span<std::uint8_t> pixels, DrawTimes& times);

  private:
    /// Memory that the next picture reuses.
    struct Memory {
        explicit Memory(parallel::ForkJoin* forkJoin) : slicer(forkJoin) {}
        slicing::Slicer slicer;
        slicing::SliceSet slices;
        scene::Composer composer;
        scene::Scene scene;
        std::vector<std::uint8_t> pixels;
    };

    parallel::ForkJoin* forkJoin_;
    std::size_t fillSteps_ = slicing::Filler::kNoLimit;
    std::optional<render::Renderer> renderer_;  // created on first use
    Memory memory_;
};

/// Runs `work` and returns the seconds that it took. This is a template because a std::function would allocate memory.
template <typename Work>
double measureSeconds(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace oval4d::raster
