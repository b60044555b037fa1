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

/// The rasterizer process that all workers of the server share. This process has one drawing thread per core, at most
/// 8. Therefore it draws a single large picture faster than the workers' own processes. A worker uses the shared
/// process only if three conditions hold:
/// - the previous picture of any worker was large: drawing it took more than 4 ms;
/// - no other picture is being drawn or queued;
/// - no two pictures were drawn or queued at the same time in the last 100 ms.
/// Otherwise, the worker uses its own single-threaded process, for two reasons. More pictures per second are drawn if
/// concurrent pictures do not compete for threads. And for a small picture, waking threads would take longer than
/// drawing. Thread-safe.
class SharedRasterizerProcess {
  public:
    /// `cores` is the number of processor cores; on a single core, there is no shared process. `morePicturesQueued`
    /// returns whether more pictures are queued; any thread may call this function. Throws std::runtime_error if the
    /// shared process cannot be started.
    SharedRasterizerProcess(std::size_t cores, RasterizerOptions options, std::function<bool()> morePicturesQueued);

  private:
    friend class WorkerRasterizer;
    const RasterizerOptions options_;
    const std::function<bool()> morePicturesQueued_;
    std::atomic<int> drawing_ = 0;  // the number of workers that are drawing now
    // The last time at which a picture was drawn while another picture was drawn or queued, counted from the epoch of
    // the clock.
    std::atomic<std::chrono::steady_clock::duration> lastQueued_{};
    std::atomic<double> lastDrawSeconds_ = 0;  // the time that drawing the last picture took, in seconds
    std::mutex multithreadedInUse_;
    // The shared process; guarded by multithreadedInUse_; empty on a single core.
    std::optional<RasterizerProcess> multithreaded_;
};

/// The rasterizer of one worker. Draws in its own single-threaded process, or in the multithreaded process that all
/// workers share (see SharedRasterizerProcess).
class WorkerRasterizer : public Rasterizer {
  public:
    /// `shared` must outlive this object. If a stop is requested through `stop`, warmUp() and draw() throw
    /// process::Canceled.
    WorkerRasterizer(SharedRasterizerProcess& shared, std::stop_token stop);

    void warmUp() override;
    std::span<const std::uint8_t> draw(const scene::PictureRequest& picture, DrawTimes& times) override;
    void freeMemory() override;

  private:
    std::span<const std::uint8_t> drawInFasterProcess(const scene::PictureRequest& picture, DrawTimes& times);

    SharedRasterizerProcess& shared_;
    const std::stop_token stop_;
    std::optional<SharedPixels> pixels_;  // created on first use, because creation may fail
    RasterizerProcess own_;
};

}  // namespace oval4d::raster
