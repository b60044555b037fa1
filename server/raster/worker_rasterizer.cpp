#include "raster/worker_rasterizer.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace oval4d::raster {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// If two pictures were drawn or queued at the same time less than this time ago, the next pictures are expected to
// overlap in time, too.
constexpr auto kCrowded = 100ms;
// If drawing the last picture took more than this number of seconds, the next picture is expected to be large.
constexpr double kLarge = 0.004;
// The maximum number of threads of the shared process. With more, llvmpipe's threads would wait for the thread that
// gives them work.
constexpr std::size_t kMostThreads = 8;

}  // namespace

SharedRasterizerProcess::SharedRasterizerProcess(std::size_t cores, RasterizerOptions options,
                                                 std::function<bool()> morePicturesQueued)
    : options_(std::move(options)), morePicturesQueued_(std::move(morePicturesQueued)) {
    if (cores < 2) return;
    multithreaded_.emplace(static_cast<int>(std::min(cores, kMostThreads)), options_);
    multithreaded_->start();
}

WorkerRasterizer::WorkerRasterizer(SharedRasterizerProcess& shared, std::stop_token stop)
    : shared_(shared), stop_(std::move(stop)), own_(0, shared.options_) {}

void WorkerRasterizer::warmUp() {
    own_.warmUp(stop_);
    const std::unique_lock lock(shared_.multithreadedInUse_, std::try_to_lock);
    if (lock && shared_.multithreaded_) shared_.multithreaded_->warmUp(stop_);
}

std::span<const std::uint8_t> WorkerRasterizer::draw(const scene::PictureRequest& picture, DrawTimes& times) {
    const auto drawn = drawInFasterProcess(picture, times);
    shared_.lastDrawSeconds_ = times.draw;
    return drawn;
}

void WorkerRasterizer::freeMemory() {
    if (pixels_) pixels_->resize(0);
}

std::span<const std::uint8_t> WorkerRasterizer::drawInFasterProcess(const scene::PictureRequest& picture,
                                                                    DrawTimes& times) {
    struct DrawingCounter {
        std::atomic<int>& drawing;
        const bool alone = drawing++ == 0;
        ~DrawingCounter() { --drawing; }
    } const counted{shared_.drawing_};
    if (!pixels_) pixels_.emplace();
    const auto now = Clock::now().time_since_epoch();
    if (!counted.alone || shared_.morePicturesQueued_()) {
        shared_.lastQueued_ = now;
    } else if (now - shared_.lastQueued_.load() > kCrowded && shared_.lastDrawSeconds_ > kLarge) {
        const std::unique_lock lock(shared_.multithreadedInUse_, std::try_to_lock);
        if (lock && shared_.multithreaded_) return shared_.multithreaded_->draw(picture, *pixels_, times, stop_);
    }
    return own_.draw(picture, *pixels_, times, stop_);
}

}  // namespace oval4d::raster
