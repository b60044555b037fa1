// Measures how many pictures per second one process makes, from a state to a PNG file.
//   bench_drawing POLYTOPE DRAWERS ENCODERS SECONDS
// DRAWERS threads draw, each with its own context. If ENCODERS is 0, they also encode their pictures. If ENCODERS is 1,
// each has a second thread that encodes a picture while the next one is drawn. Prints "ready" after the warm-up and
// waits for a line of input, so that several processes can begin at the same time. LP_NUM_THREADS sets the number of
// threads of llvmpipe (the software renderer).

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "image/png.hpp"
#include "raster/rasterizer.hpp"
#include "scene/picture_request.hpp"
#include "session/object_loader.hpp"
#include "session/picture.hpp"
#include "session/query.hpp"

namespace oval4d::bench {
namespace {

using Clock = std::chrono::steady_clock;

session::State stateOf(const std::string& polytope) {
    polytopes::PolytopeCache cache;
    session::ObjectLoader loader(session::Limits{}, cache);
    const auto state = session::stateFromQuery({{"polytope", polytope}, {"slices", "21"}}, session::Limits{}, loader);
    if (!state) throw std::runtime_error(state.error().message);
    session::State made = *state;
    made.slices.spacing = std::sqrt(10.0) / 4 * slicing::infoOf(made.object).circumradius / 10;
    return made;
}

/// A queue that passes images from one thread to another. It holds at most two images.
class Handover {
  public:
    void put(image::Image& image) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return !full_; });
        std::swap(image, image_);
        full_ = true;
        changed_.notify_all();
    }
    bool take(image::Image& image) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return full_ || over_; });
        if (!full_) return false;
        std::swap(image, image_);
        full_ = false;
        changed_.notify_all();
        return true;
    }
    void end() {
        const std::lock_guard lock(mutex_);
        over_ = true;
        changed_.notify_all();
    }

  private:
    std::mutex mutex_;
    std::condition_variable changed_;
    image::Image image_;
    bool full_ = false, over_ = false;
};

class Drawer {
  public:
    Drawer(const session::State& state, parallel::ForkJoin& forkJoin)
        : state_(state), rasterizer_(&forkJoin), encoder_(&forkJoin) {}

    void draw(int i) {
        state_.orientation = geometry::Rotation(geometry::RotationAngles{
            geometry::Plane::xw, 0.3 + i * std::numbers::pi / 97, 0.2 + i * std::numbers::pi / 131});
        const scene::Viewport viewport;
        image.width = viewport.width;
        image.height = viewport.height;
        image.pixels.resize(image::byteCount(viewport.width, viewport.height));
        raster::DrawTimes times;
        session::writePictureRequest(state_, viewport, slicing::Quality::full, picture_);
        rasterizer_.draw(picture_, image.pixels, times);
    }
    void encode() { encoder_.encode(image, "", png_); }

    image::Image image;

  private:
    session::State state_;
    scene::PictureRequest picture_;
    raster::LocalRasterizer rasterizer_;
    image::PngEncoder encoder_;
    std::vector<std::uint8_t> png_;
};

/// Warms up, then decrements `cold`, the number of threads that have not warmed up. Waits until `begun` is true. Then
/// draws pictures for `seconds` seconds, and appends the time that each takes, in seconds, to `latencies`.
void draw(const session::State& state, parallel::ForkJoin& forkJoin, bool pipelined, std::atomic<int>& cold,
          const std::atomic<bool>& begun, double seconds, std::vector<double>& latencies) {
    Drawer drawer(state, forkJoin);
    for (int i = 0; i < 12; ++i) drawer.draw(i), drawer.encode();
    --cold;
    cold.notify_all();
    begun.wait(false);
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    std::optional<std::thread> encoding;
    Handover handover;
    if (pipelined) {
        encoding.emplace([&] {
            image::PngEncoder encoder(&forkJoin);
            image::Image image;
            std::vector<std::uint8_t> png;
            while (handover.take(image)) encoder.encode(image, "", png);
        });
    }
    for (int i = 12; Clock::now() < end; ++i) {
        const auto start = Clock::now();
        drawer.draw(i);
        if (pipelined) {
            handover.put(drawer.image);
        } else {
            drawer.encode();
        }
        latencies.push_back(std::chrono::duration<double>(Clock::now() - start).count());
    }
    handover.end();
    if (encoding) encoding->join();
}

void run(const std::string& polytope, int drawers, bool pipelined, double seconds) {
    const session::State state = stateOf(polytope);
    parallel::ForkJoin forkJoin;
    std::vector<std::vector<double>> latencies(static_cast<std::size_t>(drawers));
    std::vector<std::thread> threads;
    std::atomic<int> cold = drawers;
    std::atomic<bool> begun = false;
    for (auto& each : latencies)
        threads.emplace_back([&] { draw(state, forkJoin, pipelined, cold, begun, seconds, each); });
    for (int left = cold; left > 0; left = cold) cold.wait(left);
    std::puts("ready");
    std::fflush(stdout);
    (void)std::getchar();
    begun = true;
    begun.notify_all();
    for (std::thread& thread : threads) thread.join();
    std::vector<double> all;
    for (const auto& each : latencies) all.insert(all.end(), each.begin(), each.end());
    std::ranges::sort(all);
    std::printf(R"({"rate":%.1f,"median":%.3f})"
                "\n",
                static_cast<double>(all.size()) / seconds, 1e3 * all[all.size() / 2]);
}

}  // namespace
}  // namespace oval4d::bench

int main(int argc, char** argv) {
    const auto number = [&](int i, double otherwise) { return argc > i ? std::atof(argv[i]) : otherwise; };
    try {
        oval4d::bench::run(argc > 1 ? argv[1] : "5-cell", static_cast<int>(number(2, 1)), number(3, 0) != 0,
                           number(4, 1));
    } catch (const std::exception& fault) {
        std::fprintf(stderr, "drawing: %s\n", fault.what());
        return 1;
    }
}
