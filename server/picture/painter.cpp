#include "picture/painter.hpp"

#include <malloc.h>

#include <new>
#include <utility>

#include "picture/drawer.hpp"

namespace oval4d::picture {

namespace {

template <typename Work>
double secondsOf(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// What glibc keeps of memory that is freed, in bytes; by itself it comes to these when it has seen blocks so large.
constexpr int kMapped = 32 << 20;  // larger blocks come from the system one by one, and go back there
constexpr int kKept = 2 * kMapped;

/// Gives back to the system what is free. malloc_trim leaves the end of a thread's arena, however large it is; that is
/// cut off, if it is larger than the threshold, when the thread frees a large block.
void giveBack() {
    mallopt(M_MMAP_THRESHOLD, kMapped);
    mallopt(M_TRIM_THRESHOLD, 0);
    void* const volatile large = ::operator new(1U << 17U);
    ::operator delete(large);
    malloc_trim(0);
    mallopt(M_TRIM_THRESHOLD, kKept);
}

}  // namespace

Painter::Painter() = default;
Painter::~Painter() = default;

void Painter::cut(const session::State& state, geometry::SliceSet& out) {
    times_ = {};
    times_.slice =
        secondsOf([&] { memory_.slicer.slice(*state.polytope, state.orientation, state.hyperplanes(), out); });
}

void Painter::message(const session::State& state, const geometry::SliceSet& slices, std::uint64_t revision,
                      std::optional<double> id, scene::Viewport viewport, protocol::Encoding encoding,
                      std::string& out) {
    compose(state, slices, viewport);
    times_.write = secondsOf(
        [&] { memory_.slicesWriter.write(*state.polytope, slices, memory_.scene, revision, id, encoding, out); });
}

void Painter::leaveDrawingTo(std::unique_ptr<Drawer> drawer) { drawer_ = std::move(drawer); }

void Painter::warmUp() {
    if (drawer_) {
        drawer_->warmUp();
    } else if (!renderer_) {
        renderer_.emplace();
    }
}

void Painter::draw(const session::State& state, scene::Viewport viewport, std::span<std::uint8_t> pixels) {
    warmUp();
    cut(state, memory_.slices);
    compose(state, memory_.slices, viewport);
    times_.draw = secondsOf([&] { renderer_->draw(*state.polytope, memory_.slices, memory_.scene, pixels); });
}

void Painter::frame(const session::State& state, std::string_view stateText, scene::Viewport viewport,
                    std::vector<std::uint8_t>& out, const std::function<void()>& drawn) {
    render::ImageView image{viewport.width, viewport.height, {}};
    if (drawer_) {
        image.pixels = drawer_->draw(state, viewport, times_);
    } else {
        memory_.pixels.resize(render::bytesOf(viewport));
        draw(state, viewport, memory_.pixels);
        image.pixels = memory_.pixels;
    }
    if (drawn) drawn();
    times_.encode = secondsOf([&] { memory_.encoder.encode(image, stateText, out); });
}

void Painter::forget() {
    memory_ = {};
    if (renderer_) renderer_->forget();
    if (drawer_) drawer_->forget();
    giveBack();
}

void Painter::compose(const session::State& state, const geometry::SliceSet& slices, scene::Viewport viewport) {
    times_.compose = secondsOf([&] {
        scene::compose(*state.polytope, slices.planes, state.slices.focus, state.look, viewport, memory_.scene,
                       state.orientation);
        scene::fill(*state.polytope, slices, memory_.scene, fillSteps_);
    });
}

}  // namespace oval4d::picture
