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
    /// The time allowed for starting the process, and for drawing a picture. A process that takes longer counts as
    /// hung.
    std::chrono::duration<double> timeout;
    std::function<void(const process::ProcessLoss&)> onLoss;  ///< called on any thread
    std::vector<std::string> environment;                     ///< see process::ChildOptions
};

/// A child process that draws pictures for the server. There are two reasons for separate processes. The server
/// survives a crash of the OpenGL driver. Each process has its own threads of the software rasterizer llvmpipe; all GL
/// contexts in one process would share them. May be used by one thread at a time. Functions that wait throw the same
/// exceptions as process::ChildProcess::converse.
class RasterizerProcess {
  public:
    /// `threads` is the number of llvmpipe's threads; 0: the main thread of the process does all the drawing.
    RasterizerProcess(int threads, const RasterizerOptions& options);

    /// Starts the process if it is not running, without waiting until it is ready. Throws std::runtime_error if it
    /// cannot be started.
    void start() { process_.start(); }

    /// Starts the process if it is not running, and waits until it is ready to draw, with its shaders compiled.
    void warmUp(const std::stop_token& stop);

    /// Like Rasterizer::draw, but draws into the memory of `pixels`, which is resized if necessary.
    std::span<const std::uint8_t> draw(const session::State& state, scene::Viewport viewport, SharedPixels& pixels,
                                       DrawTimes& times, const std::stop_token& stop);

  private:
    // Receives the answer to a request. Sends the object first if the process asks for it.
    process::TransferResult receiveAnswer(const session::State& state, const process::Channel& channel,
                                          const process::Deadline& deadline);

    const RasterizerLimits limits_;
    process::ChildProcess process_;
    process::MessageType answer_{};
    std::string request_, body_;
};

}  // namespace oval4d::raster
