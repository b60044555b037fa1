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

/// Holds the rasterizer process that all workers of the server share. This process has one drawing thread per core, at
/// most 8, and therefore draws a single large picture faster than the workers' own processes. A worker uses it only if
/// the previous picture of any worker was large, that is, took more than 4 ms to draw; if no other picture is being
/// drawn or queued; and if no two pictures were drawn or queued at the same time in the last 100 ms. Otherwise the
/// worker uses its own single-threaded process: concurrent pictures are drawn with a higher throughput if they do not
/// compete for threads, and for a small picture, waking threads would take longer than drawing. Thread-safe.
class SharedRasterizerProcess {
  public:
    /// `cores` is the number of processor cores; on a single core, there is no shared process. `morePicturesQueued`
    /// returns whether more pictures are queued; any thread may call it. Throws std::runtime_error if the shared
    /// process cannot be started.
    SharedRasterizerProcess(std::size_t cores, RasterizerOptions options, std::function<bool()> morePicturesQueued);

  private:
    friend class WorkerRasterizer;
    const RasterizerOptions options_;
    const std::function<bool()> morePicturesQueued_;
    std::atomic<int> drawing_ = 0;  // the number of workers that are drawing
    // The last time at which a picture was drawn while another one was drawn or queued, counted from the epoch of the
    // clock.
    std::atomic<std::chrono::steady_clock::duration> lastQueued_{};
    std::atomic<double> lastDrawSeconds_ = 0;  // the drawing time of the last picture
    std::mutex multithreadedInUse_;
    std::optional<RasterizerProcess> multithreaded_;  // guarded by multithreadedInUse_; empty on a single core
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
