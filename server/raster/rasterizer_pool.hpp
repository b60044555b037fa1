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

/// The part that the rasterizers of all workers of a server share: a multithreaded rasterizer process with one thread
/// per core (at most 8). It draws a large picture with the lowest latency while no other picture is being drawn.
/// Concurrent pictures are drawn by single-threaded processes, one for each worker, because their throughput is higher
/// than if the pictures competed for threads. Small pictures are also drawn by single-threaded processes, because
/// drawing them takes less time than waking threads. Thread-safe.
class RasterizerPool {
  public:
    /// `morePicturesQueued` returns whether more pictures are queued; it must be callable on any thread. Throws
    /// std::runtime_error if the multithreaded process cannot be started.
    RasterizerPool(std::size_t cores, RasterizerOptions options, std::function<bool()> morePicturesQueued);

  private:
    friend class PooledRasterizer;
    const RasterizerOptions options_;
    const std::function<bool()> morePicturesQueued_;
    std::atomic<int> drawing_ = 0;                                   // the number of rasterizers that are drawing
    std::atomic<std::chrono::steady_clock::duration> lastQueued_{};  // when, since the clock's epoch
    std::atomic<double> lastDrawSeconds_ = 0;                        // drawing time of the last picture in seconds
    std::mutex multithreadedInUse_;
    std::optional<RasterizerProcess> multithreaded_;  // guarded by multithreadedInUse_; none on a single core
};

/// The rasterizer of one worker: draws in its own single-threaded process, or in the multithreaded process of the pool.
class PooledRasterizer : public Rasterizer {
  public:
    /// `pool` must outlive this object. Functions that wait throw process::Canceled once `stop` has been requested.
    PooledRasterizer(RasterizerPool& pool, std::stop_token stop);

    void warmUp() override;
    std::span<const std::uint8_t> draw(const session::State& state, scene::Viewport viewport, Times& times) override;
    void freeMemory() override;

  private:
    std::span<const std::uint8_t> drawBest(const session::State& state, scene::Viewport viewport, Times& times);

    RasterizerPool& pool_;
    const std::stop_token stop_;
    std::optional<SharedPixels> pixels_;  // created on first use, because creation may fail
    RasterizerProcess own_;
};

}  // namespace oval4d::raster
