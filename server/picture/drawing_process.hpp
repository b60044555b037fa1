#pragma once
// A process that draws for the server. Contexts of one process share llvmpipe's one rasteriser, those of two do not;
// and where the driver falls, the server stands.

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "picture/drawing_channel.hpp"
#include "picture/painter.hpp"
#include "picture/shared_pixels.hpp"

namespace oval4d::picture {

/// The word that makes the program such a process, with the socket as its file 3.
inline constexpr const char* kDrawingCommand = "draw";
inline constexpr int kDrawingSocket = 3;

/// That process from within: carries out the orders that come through this socket until its other end is closed.
void serveDrawing(int socket);

/// A process that was lost: it died, or it hung and was killed.
struct Loss {
    bool hung;
    std::string how;  ///< for the log
};

/// What a server asks of such processes.
struct DrawingTerms {
    DrawingLimits limits;
    std::chrono::duration<double> timeout;    ///< it hangs if it takes longer to begin, or for a picture
    std::function<void(const Loss&)> onLoss;  ///< called by any thread
};

/// One such process: this program, started when it is wanted, and again when it was lost. It ends with this object, or
/// with the program. One object serves one thread at a time. All that waits throws GivenUp, or std::runtime_error: with
/// the fault of the drawing, if two processes were lost one after the other, or if none can be started.
class DrawingProcess {
  public:
    /// `threads` are llvmpipe's where LP_NUM_THREADS does not say how many; 0: none but the process's own.
    DrawingProcess(int threads, DrawingTerms terms);
    ~DrawingProcess();
    DrawingProcess(const DrawingProcess&) = delete;
    DrawingProcess& operator=(const DrawingProcess&) = delete;

    /// Starts it, if it is not running, and does not wait. Throws std::runtime_error.
    void start();

    /// Waits until its shaders are compiled.
    void warmUp(const std::stop_token& stop);

    /// Draws the state's picture: RGBA, rows from the bottom up.
    std::span<const std::uint8_t> draw(const session::State& state, scene::Viewport viewport, SharedPixels& pixels,
                                       Times& times, const std::stop_token& stop);

  private:
    template <typename Talk>
    void attempt(const std::stop_token& stop, Talk talk);
    Patience patience(const std::stop_token& stop) const;
    Passage listen(Said wanted, const session::State* state, const Patience& patience);
    std::string end(bool atOnce);

    const int threads_;
    const DrawingTerms terms_;
    std::unique_ptr<DrawingChannel> channel_;  // null: not running
    bool ready_ = false;
    pid_t process_ = 0;
    std::vector<pid_t> unburied_;  // killed, and not yet ended
    Said said_{};                  // what it said last
    std::string order_, body_;
};

}  // namespace oval4d::picture
