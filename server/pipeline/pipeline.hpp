#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "image/png.hpp"
#include "parallel/fork_join.hpp"
#include "parallel/ownership.hpp"
#include "raster/rasterizer.hpp"
#include "scene/composer.hpp"
#include "session/session.hpp"
#include "slicing/slicer.hpp"
#include "wire/request.hpp"
#include "wire/slices.hpp"

namespace oval4d::pipeline {

/// The seconds that each step of the last call took.
struct Times : raster::Times {
    double write = 0, encode = 0;
};

/// Converts a session's state to what a client displays: state → slices → scene → `slices` message, or state → pixels →
/// PNG file. Used by the server and the command line. Keeps its memory between calls. One pipeline serves one thread at
/// a time.
class Pipeline {
  public:
    /// The default limit on the work of filling intersecting faces, in the steps of slicing::Filler.
    static constexpr std::size_t kFillSteps = 20'000'000;

    /// Draws frames with `rasterizer`.
    Pipeline(std::unique_ptr<raster::Rasterizer> rasterizer, parallel::ForkJoin* forkJoin,
             std::size_t fillSteps = kFillSteps);

    /// Slices the state's object. Overwrites `out` and reuses its memory.
    void cut(const session::State& state, slicing::SliceSet& out);

    /// Writes the `slices` message of slices that were cut from this state.
    void message(const session::State& state, const slicing::SliceSet& slices, std::uint64_t revision,
                 std::optional<double> id, scene::Viewport viewport, wire::Encoding encoding, std::string& out);

    /// Makes the picture of the state as a PNG file that contains `stateText`, a `state` message. Calls `drawn`, if
    /// given, when only encoding is left. Throws std::runtime_error if it cannot be drawn, most likely because no GL
    /// context can be created.
    void frame(const session::State& state, std::string_view stateText, scene::Viewport viewport,
               std::vector<std::uint8_t>& out, const std::function<void()>& drawn = {});

    /// Waits until the first frame can be drawn as fast as later ones. Throws std::runtime_error if frames cannot be
    /// drawn.
    void warmUp() { rasterizer_->warmUp(); }

    /// Frees cached memory, which has the size of the largest picture so far; allocating it again takes a few
    /// milliseconds. Meant to be called when idle.
    void freeMemory();

    const Times& times() const { return times_; }

  private:
    /// Memory that the next call reuses.
    struct Memory {
        explicit Memory(parallel::ForkJoin* forkJoin) : slicer(forkJoin), encoder(forkJoin) {}
        slicing::Slicer slicer;
        scene::Composer composer;
        scene::Scene scene;
        wire::SlicesWriter slicesWriter;
        image::PngEncoder encoder;
    };

    const std::unique_ptr<raster::Rasterizer> rasterizer_;
    parallel::ForkJoin* const forkJoin_;
    const std::size_t fillSteps_;
    Memory memory_;
    Times times_;
    parallel::OneAtATime inUse_;
};

}  // namespace oval4d::pipeline
