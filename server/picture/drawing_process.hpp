#pragma once
// A process that draws for the server. Contexts of one process share llvmpipe's one rasteriser, those of two do not;
// and where the driver falls, the server stands.

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "picture/drawing_channel.hpp"
#include "picture/painter.hpp"
#include "picture/shared_pixels.hpp"

namespace oval4d::picture {

/// The word that makes the program such a process, with the socket as its file 3.
inline constexpr const char* kDrawingCommand = "draw";
inline constexpr int kDrawingSocket = 3;

/// That process from within: carries out the orders that come through this socket until its other end is closed.
void serveDrawing(int socket);

/// What was the end of a process, for the log.
using OnDeath = std::function<void(const std::string&)>;

/// One such process: this program, and started again when it has died. It ends with this object, or with the program.
/// One object serves one thread at a time.
class DrawingProcess {
  public:
    /// Starts it. `threads` are llvmpipe's where LP_NUM_THREADS does not say how many; 0: none but the process's own.
    /// `died` is called whenever the process is found dead. Throws std::runtime_error.
    DrawingProcess(int threads, DrawingLimits limits, OnDeath died);
    ~DrawingProcess();
    DrawingProcess(const DrawingProcess&) = delete;
    DrawingProcess& operator=(const DrawingProcess&) = delete;

    /// Waits until its shaders are compiled.
    void warmUp();

    /// Draws the state's picture: RGBA, rows from the bottom up. Throws std::runtime_error with the fault of the
    /// drawing, or if the process has died of this picture twice.
    std::span<const std::uint8_t> draw(const session::State& state, scene::Viewport viewport, SharedPixels& pixels,
                                       Times& times);

  private:
    bool listen(Said wanted, const session::State* state);
    void start();
    void bury();

    const int threads_;
    const DrawingLimits limits_;
    const OnDeath died_;
    std::unique_ptr<DrawingChannel> channel_;  // null: not running
    pid_t process_ = 0;
    std::string end_;  // of the last one
    std::string order_, body_;
};

}  // namespace oval4d::picture
