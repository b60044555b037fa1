#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>

#include "raster/rasterizer.hpp"
#include "raster/rasterizer_process.hpp"

namespace oval4d::raster {

/// Holds a multithreaded rasterizer process that the rasterizers of all workers share. This process has one thread per
/// core, but at most 8, so it draws a large picture with the lowest latency. It draws the large pictures that are not
/// concurrent with others. Concurrent pictures are drawn by single-threaded processes, one for each worker: their
/// throughput is higher than if the pictures competed for threads. Small pictures are also drawn by single-threaded
/// processes, because drawing them takes less time than waking threads. Thread-safe.
class SharedRasterizerProcess {
  public:
    /// `morePicturesQueued` returns whether more pictures are queued; it must be callable on any thread. Throws
    /// std::runtime_error if the multithreaded process cannot be started.
    SharedRasterizerProcess(std::size_t cores, RasterizerOptions options, std::function<bool()> morePicturesQueued);

  private:
    friend class WorkerRasterizer;
    const RasterizerOptions options_;
    const std::function<bool()> morePicturesQueued_;
    std::atomic<int> drawing_ = 0;                                   // the number of rasterizers that are drawing
    std::atomic<std::chrono::steady_clock::duration> lastQueued_{};  // clock time of the last concurrent pictures
    std::atomic<double> lastDrawSeconds_ = 0;                        // drawing time of the last picture in seconds
    std::mutex multithreadedInUse_;
    std::optional<RasterizerProcess> multithreaded_;  // guarded by multithreadedInUse_; empty on a single core
};

/// The rasterizer of one worker: draws in its own single-threaded process, or in the multithreaded process that all
/// workers share.
class WorkerRasterizer : public Rasterizer {
  public:
    /// `shared` must outlive this object. Functions that wait for a process throw process::Canceled once `stop` has
    /// been requested.
    WorkerRasterizer(SharedRasterizerProcess& shared, std::stop_token stop);

    void warmUp() override;
    std::span<const std::uint8_t> draw(const session::State& state, scene::Viewport viewport,
                                       DrawTimes& times) override;
    void freeMemory() override;

  private:
    std::span<const std::uint8_t> drawBest(const session::State& state, scene::Viewport viewport, DrawTimes& times);

    SharedRasterizerProcess& shared_;
    const std::stop_token stop_;
    std::optional<SharedPixels> pixels_;  // created on first use, because creation may fail
    RasterizerProcess own_;
};

}  // namespace oval4d::raster
