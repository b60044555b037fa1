#pragma once
// From a session's state to its picture: slices, their message, a PNG file. The one way there, for the service and
// for `oval4d render` alike.

#include <cstdint>
#include <optional>
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

/// Keeps a slicer, a GL context and all memory in between. One painter serves one thread, the one that first draws.
class Painter {
  public:
    /// What a picture may take to fill faces that cross themselves, in the steps of geometry::Filler.
    static constexpr std::size_t kFillSteps = 20'000'000;
    void limitFill(std::size_t steps) { fillSteps_ = steps; }

    /// Cuts the state's polytope. `out` is overwritten and its memory reused.
    void cut(const session::State& state, geometry::SliceSet& out);

    /// The `slices` message of slices that were cut from this state.
    void message(const session::State& state, const geometry::SliceSet& slices, std::uint64_t revision,
                 std::optional<double> id, scene::Viewport viewport, protocol::Encoding encoding, std::string& out);

    /// The picture as a PNG file, with `stateText` (a `state` message) inside. Throws std::runtime_error if no GL
    /// context can be had.
    void frame(const session::State& state, const geometry::SliceSet& slices, std::string_view stateText,
               scene::Viewport viewport, std::vector<std::uint8_t>& out);

    /// Makes the GL context and compiles its shaders, so that the first frame is as fast as the next.
    void warmUp();

    const Times& times() const { return times_; }

  private:
    void compose(const session::State& state, const geometry::SliceSet& slices, scene::Viewport viewport);

    std::size_t fillSteps_ = kFillSteps;
    geometry::Slicer slicer_;
    scene::Scene scene_;
    protocol::SlicesWriter slicesWriter_;
    render::Image image_;
    std::optional<render::Renderer> renderer_;  // made at the first frame: geometry needs no GL
    render::PngEncoder encoder_;
    Times times_;
};

}  // namespace oval4d::picture
