#include "raster/rasterizer_pool.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace oval4d::raster {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// The time after concurrent pictures for which more concurrent pictures are expected.
constexpr auto kCrowded = 100ms;
// A picture that takes longer than this to draw, in seconds, counts as large.
constexpr double kLarge = 0.004;
constexpr std::size_t kMostThreads = 8;  // more threads would wait for the thread that gives them work

}  // namespace

RasterizerPool::RasterizerPool(std::size_t cores, RasterizerOptions options, std::function<bool()> morePicturesQueued)
    : options_(std::move(options)), morePicturesQueued_(std::move(morePicturesQueued)) {
    if (cores < 2) return;
    multithreaded_.emplace(static_cast<int>(std::min(cores, kMostThreads)), options_);
    multithreaded_->start();
}

PooledRasterizer::PooledRasterizer(RasterizerPool& pool, std::stop_token stop)
    : pool_(pool), stop_(std::move(stop)), own_(0, pool.options_) {}

void PooledRasterizer::warmUp() {
    own_.warmUp(stop_);
    const std::unique_lock lock(pool_.multithreadedInUse_, std::try_to_lock);
    if (lock && pool_.multithreaded_) pool_.multithreaded_->warmUp(stop_);
}

std::span<const std::uint8_t> PooledRasterizer::draw(const session::State& state, scene::Viewport viewport,
                                                     Times& times) {
    const auto drawn = drawBest(state, viewport, times);
    pool_.lastDrawSeconds_ = times.draw;
    return drawn;
}

void PooledRasterizer::freeMemory() {
    if (pixels_) pixels_->resize(0);
}

std::span<const std::uint8_t> PooledRasterizer::drawBest(const session::State& state, scene::Viewport viewport,
                                                         Times& times) {
    struct Counted {
        std::atomic<int>& drawing;
        const bool alone = drawing++ == 0;
        ~Counted() { --drawing; }
    } const counted{pool_.drawing_};
    if (!pixels_) pixels_.emplace();
    const auto now = Clock::now().time_since_epoch();
    if (!counted.alone || pool_.morePicturesQueued_()) {
        pool_.lastQueued_ = now;
    } else if (now - pool_.lastQueued_.load() > kCrowded && pool_.lastDrawSeconds_ > kLarge) {
        const std::unique_lock lock(pool_.multithreadedInUse_, std::try_to_lock);
        if (lock && pool_.multithreaded_) return pool_.multithreaded_->draw(state, viewport, *pixels_, times, stop_);
    }
    return own_.draw(state, viewport, *pixels_, times, stop_);
}

}  // namespace oval4d::raster
