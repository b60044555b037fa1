#include "picture/drawer.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace oval4d::picture {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// So long after pictures came at the same time they are expected to do so again.
constexpr auto kCrowded = 100ms;
// A picture that takes longer to draw is a large one; seconds.
constexpr double kLarge = 0.004;
constexpr std::size_t kMostThreads = 8;  // more would wait for the one that prepares their work

}  // namespace

Studio::Studio(std::size_t cores, DrawingTerms terms, std::function<bool()> crowded)
    : terms_(std::move(terms)), crowded_(std::move(crowded)) {
    if (cores < 2) return;
    soloist_.emplace(static_cast<int>(std::min(cores, kMostThreads)), terms_);
    soloist_->start();
}

Drawer::Drawer(Studio& studio, std::stop_token stop)
    : studio_(studio), stop_(std::move(stop)), own_(0, studio.terms_) {}

void Drawer::warmUp() {
    own_.warmUp(stop_);
    const std::unique_lock lock(studio_.soloing_, std::try_to_lock);
    if (lock && studio_.soloist_) studio_.soloist_->warmUp(stop_);
}

std::span<const std::uint8_t> Drawer::draw(const session::State& state, scene::Viewport viewport, Times& times) {
    const auto drawn = drawBest(state, viewport, times);
    studio_.lastTook_ = times.draw;
    return drawn;
}

void Drawer::forget() {
    if (pixels_) pixels_->take(0);
}

std::span<const std::uint8_t> Drawer::drawBest(const session::State& state, scene::Viewport viewport, Times& times) {
    struct Counted {
        std::atomic<int>& drawing;
        const bool alone = drawing++ == 0;
        ~Counted() { --drawing; }
    } const counted{studio_.drawing_};
    if (!pixels_) pixels_.emplace();
    const auto now = Clock::now().time_since_epoch();
    if (!counted.alone || studio_.crowded_()) {
        studio_.lastCrowded_ = now;
    } else if (now - studio_.lastCrowded_.load() > kCrowded && studio_.lastTook_ > kLarge) {
        const std::unique_lock lock(studio_.soloing_, std::try_to_lock);
        if (lock && studio_.soloist_) return studio_.soloist_->draw(state, viewport, *pixels_, times, stop_);
    }
    return own_.draw(state, viewport, *pixels_, times, stop_);
}

}  // namespace oval4d::picture
