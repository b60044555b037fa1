#include "picture/painter.hpp"

#include <chrono>
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

}  // namespace

Painter::Painter() = default;
Painter::~Painter() = default;

void Painter::cut(const session::State& state, geometry::SliceSet& out) {
    times_ = {};
    times_.slice = secondsOf([&] { slicer_.slice(*state.polytope, state.orientation, state.hyperplanes(), out); });
}

void Painter::message(const session::State& state, const geometry::SliceSet& slices, std::uint64_t revision,
                      std::optional<double> id, scene::Viewport viewport, protocol::Encoding encoding,
                      std::string& out) {
    compose(state, slices, viewport);
    times_.write =
        secondsOf([&] { slicesWriter_.write(*state.polytope, slices, scene_, revision, id, encoding, out); });
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
    cut(state, slices_);
    compose(state, slices_, viewport);
    times_.draw = secondsOf([&] { renderer_->draw(*state.polytope, slices_, scene_, pixels); });
}

void Painter::frame(const session::State& state, std::string_view stateText, scene::Viewport viewport,
                    std::vector<std::uint8_t>& out, const std::function<void()>& drawn) {
    render::ImageView image{viewport.width, viewport.height, {}};
    if (drawer_) {
        image.pixels = drawer_->draw(state, viewport, times_);
    } else {
        pixels_.resize(render::bytesOf(viewport));
        draw(state, viewport, pixels_);
        image.pixels = pixels_;
    }
    if (drawn) drawn();
    times_.encode = secondsOf([&] { encoder_.encode(image, stateText, out); });
}

void Painter::compose(const session::State& state, const geometry::SliceSet& slices, scene::Viewport viewport) {
    times_.compose = secondsOf([&] {
        scene::compose(*state.polytope, slices.planes, state.slices.focus, state.look, viewport, scene_,
                       state.orientation);
        scene::fill(*state.polytope, slices, scene_, fillSteps_);
    });
}

}  // namespace oval4d::picture
