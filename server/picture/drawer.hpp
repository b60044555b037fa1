#pragma once
// Which process draws.

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>

#include "picture/drawing_process.hpp"

namespace oval4d::picture {

/// What the drawers of a server share. For a large picture that is alone there is a process with as many threads as
/// there are cores, so that it is drawn soonest. Of pictures at the same time each is drawn by a process without
/// threads: there are more of them in a second than of such as wait for each other's threads. So are small ones, which
/// are done before threads are awake.
class Studio {
  public:
    /// `crowded` tells whether pictures wait; it is called by any thread. Throws std::runtime_error.
    Studio(std::size_t cores, DrawingTerms terms, std::function<bool()> crowded);

  private:
    friend class Drawer;
    const DrawingTerms terms_;
    const std::function<bool()> crowded_;
    std::atomic<int> drawing_ = 0;                                    // how many drawers are at it
    std::atomic<std::chrono::steady_clock::duration> lastCrowded_{};  // since the clock's epoch
    std::atomic<double> lastTook_ = 0;                                // seconds to draw the last picture
    std::mutex soloing_;
    std::optional<DrawingProcess> soloist_;  // guarded by soloing_; nothing where there is but one core
};

/// A worker's way to its pictures. One drawer serves one thread.
class Drawer {
  public:
    /// When `stop` says so, all that waits throws GivenUp.
    Drawer(Studio& studio, std::stop_token stop);

    /// Waits until shaders are compiled. Throws std::runtime_error.
    void warmUp();

    /// As DrawingProcess::draw; the pixels stay until the next picture.
    std::span<const std::uint8_t> draw(const session::State& state, scene::Viewport viewport, Times& times);

    /// Lets go of the last picture.
    void forget();

  private:
    std::span<const std::uint8_t> drawBest(const session::State& state, scene::Viewport viewport, Times& times);

    Studio& studio_;
    const std::stop_token stop_;
    std::optional<SharedPixels> pixels_;  // made when first wanted, since that may fail
    DrawingProcess own_;
};

}  // namespace oval4d::picture
