#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "process/child_process.hpp"
#include "raster/rasterizer.hpp"
#include "raster/rasterizer_messages.hpp"
#include "raster/shared_pixels.hpp"

namespace oval4d::raster {

/// Options of rasterizer processes.
struct RasterizerOptions {
    RasterizerLimits limits;
    std::chrono::duration<double>
        timeout;  ///< for starting, and for drawing a picture; then the process is considered hung
    std::function<void(const process::Loss&)> onLoss;  ///< called on any thread
    std::vector<std::string> environment;              ///< see process::ChildOptions
};

/// A process that draws pictures for the server. Each process has llvmpipe threads of its own, whereas GL contexts
/// within one process share them, and the server survives a crash of the driver. Serves one thread at a time. Functions
/// that wait throw the same exceptions as process::ChildProcess::converse.
class RasterizerProcess {
  public:
    /// `threads`: the number of llvmpipe's threads; 0 means that the main thread does all the drawing.
    RasterizerProcess(int threads, const RasterizerOptions& options);

    /// Starts the process if it is not running, without waiting for it. Throws std::runtime_error.
    void start() { process_.start(); }

    /// Waits until the shaders are compiled.
    void warmUp(const std::stop_token& stop);

    /// Like Rasterizer::draw, but draws into `pixels`.
    std::span<const std::uint8_t> draw(const session::State& state, scene::Viewport viewport, SharedPixels& pixels,
                                       Times& times, const std::stop_token& stop);

  private:
    process::Transfer receiveAnswer(const session::State& state, const process::Channel& channel,
                                    const process::Deadline& deadline);

    void restartAfterResizes(scene::Viewport viewport);

    const RasterizerLimits limits_;
    process::ChildProcess process_;
    scene::Viewport lastViewport_{0, 0};
    std::size_t resized_ = 0;  // bytes of the pictures whose size differed from the previous one
    process::MessageType answer_{};
    std::string request_, body_;
};

}  // namespace oval4d::raster
