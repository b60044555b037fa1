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

/// The options of rasterizer processes.
struct RasterizerOptions {
    RasterizerLimits limits;
    /// The maximum time for the start of a rasterizer process, and for each picture that it draws. A process that takes
    /// longer is killed and counts as lost.
    std::chrono::duration<double> timeout;
    /// Called when a process is lost, on the thread that waits for an answer of the process.
    std::function<void(const process::ProcessLoss&)> onLoss;
    /// Environment variables of the process, as "NAME=value" (see process::ChildOptions).
    std::vector<std::string> environment;
};

/// A child process that draws pictures for the server. A separate process has two advantages. First, the server
/// survives a crash of the OpenGL driver. Second, each process has its own threads of the software rasterizer llvmpipe,
/// whereas all GL contexts of one process would share the same threads. If the process dies or hangs, a new process
/// replaces it and repeats the task.
///
/// Only one thread at a time may use this object. warmUp() and draw() throw process::Canceled if a stop is requested
/// through `stop`, and process::ProcessLostError if the replacement is lost, too. They throw std::runtime_error if a
/// process cannot be started or reports an error.
class RasterizerProcess {
  public:
    /// `threads` is the number of threads that llvmpipe (the software rasterizer) starts. If it is 0, the main thread
    /// of the process draws everything.
    RasterizerProcess(int threads, const RasterizerOptions& options);

    /// Starts the process if it is not running. Does not wait until the process is ready. Throws std::runtime_error if
    /// the process cannot be started.
    void start() { process_.start(); }

    /// Starts the process if it is not running, and waits until the process has compiled its shaders and is ready to
    /// draw.
    void warmUp(const std::stop_token& stop);

    /// Draws a picture like Rasterizer::draw(), but into the shared memory `pixels`, which this function resizes if
    /// necessary. Returns the pixels. They are valid until `pixels` is resized again.
    std::span<const std::uint8_t> draw(const scene::PictureRequest& picture, SharedPixels& pixels, DrawTimes& times,
                                       const std::stop_token& stop);

  private:
    // Receives the answer to a draw request. If the process asks for the object, sends it first.
    process::TransferResult receiveAnswerSendingObject(const slicing::Object& source, const process::Channel& channel,
                                                       const process::WaitLimit& limit);

    const RasterizerLimits limits_;
    process::ChildProcess process_;
    process::MessageType answer_{};
    std::string request_, body_;
};

}  // namespace oval4d::raster
