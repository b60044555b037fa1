#pragma once
// From a session's state to its picture: slices, their message, a PNG file. The one way there, for the service and
// for `oval4d render` alike.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/slicer.hpp"
#include "protocol/cpp/request.hpp"
#include "protocol/cpp/slices.hpp"
#include "render/image.hpp"
#include "render/renderer.hpp"
#include "scene/scene.hpp"
#include "session/session.hpp"

namespace oval4d::picture {

/// Seconds spent by the last call on each of its steps.
struct Times {
    double slice = 0, compose = 0, write = 0, draw = 0, encode = 0;
};

/// What is thrown where a picture is waited for when a stop is asked for. No std::exception: it is no fault to report.
struct GivenUp {};

class Drawer;

/// Keeps a slicer, a GL context and all memory in between. One painter serves one thread, the one that first draws.
class Painter {
  public:
    Painter();
    ~Painter();

    /// What a picture may take to fill faces that cross themselves, in the steps of geometry::Filler.
    static constexpr std::size_t kFillSteps = 20'000'000;
    void limitFill(std::size_t steps) { fillSteps_ = steps; }

    /// Cuts the state's polytope. `out` is overwritten and its memory reused.
    void cut(const session::State& state, geometry::SliceSet& out);

    /// The `slices` message of slices that were cut from this state.
    void message(const session::State& state, const geometry::SliceSet& slices, std::uint64_t revision,
                 std::optional<double> id, scene::Viewport viewport, protocol::Encoding encoding, std::string& out);

    /// The state's picture as a PNG file, with `stateText` (a `state` message) inside. `drawn` is called, if there is
    /// one, when all that is left to do is to encode. Throws std::runtime_error if it cannot be drawn, above all where
    /// no GL context can be had.
    void frame(const session::State& state, std::string_view stateText, scene::Viewport viewport,
               std::vector<std::uint8_t>& out, const std::function<void()>& drawn = {});

    /// From now on frames are drawn by `drawer`.
    void leaveDrawingTo(std::unique_ptr<Drawer> drawer);

    /// Draws the state's picture into `pixels`, as Renderer::draw has it.
    void draw(const session::State& state, scene::Viewport viewport, std::span<std::uint8_t> pixels);

    /// Compiles the shaders, so that the first frame is as fast as the next. Throws std::runtime_error if no GL context
    /// can be had.
    void warmUp();

    /// Lets go of what is kept from one picture to the next, all but the GL context: it is as large as any picture has
    /// made it, and takes some milliseconds to make anew. To be called after a pause of this length.
    void forget();
    static constexpr std::chrono::seconds kPause{3};

    const Times& times() const { return times_; }

  private:
    /// Reused by the next picture.
    struct Memory {
        geometry::Slicer slicer;
        geometry::SliceSet slices;
        scene::Scene scene;
        protocol::SlicesWriter slicesWriter;
        std::vector<std::uint8_t> pixels;
        render::PngEncoder encoder;
    };

    void compose(const session::State& state, const geometry::SliceSet& slices, scene::Viewport viewport);

    std::size_t fillSteps_ = kFillSteps;
    std::unique_ptr<Drawer> drawer_;
    std::optional<render::Renderer> renderer_;  // made at the first frame: geometry needs no GL
    Memory memory_;
    Times times_;
};

}  // namespace oval4d::picture
