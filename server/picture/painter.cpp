#include "picture/painter.hpp"

#include <chrono>

namespace oval4d::picture {

namespace {

template <typename Work>
double secondsOf(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

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

void Painter::frame(const session::State& state, const geometry::SliceSet& slices, std::string_view stateText,
                    scene::Viewport viewport, std::vector<std::uint8_t>& out) {
    warmUp();
    compose(state, slices, viewport);
    times_.draw = secondsOf([&] { renderer_->draw(*state.polytope, slices, scene_, image_); });
    times_.encode = secondsOf([&] { encoder_.encode(image_, stateText, out); });
}

void Painter::warmUp() {
    if (!renderer_) renderer_.emplace();
}

void Painter::compose(const session::State& state, const geometry::SliceSet& slices, scene::Viewport viewport) {
    times_.compose = secondsOf([&] {
        scene::compose(*state.polytope, slices.planes, state.slices.focus, state.look, viewport, scene_,
                       state.orientation);
        scene::fill(*state.polytope, slices, scene_, fillSteps_);
    });
}

}  // namespace oval4d::picture
