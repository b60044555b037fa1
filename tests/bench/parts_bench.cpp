// How long each part of a picture takes: 21 slices at 1280 × 720, orientations drawn at random.

#include <benchmark/benchmark.h>

#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "geometry/catalogue.hpp"
#include "geometry/slicer.hpp"
#include "protocol/cpp/codec.hpp"
#include "render/renderer.hpp"
#include "scene/scene.hpp"

namespace oval4d {
namespace {

constexpr int kHalf = 10, kSlices = 2 * kHalf + 1;
constexpr scene::Viewport kViewport{1280, 720};
const char* const kPolytopes[] = {"5-cell", "8-cell", "16-cell", "24-cell", "120-cell", "600-cell"};

/// The way from an orientation to a picture, all memory kept. The orientations are the same in every run.
struct Bench {
    std::shared_ptr<const geometry::Polytope> polytope;
    geometry::Hyperplanes planes;
    std::vector<geometry::Rotation> orientations;
    std::size_t next = 0;
    geometry::Slicer slicer;
    geometry::SliceSet slices;
    scene::Scene scene;
    render::Image image;
    render::PngEncoder encoder;
    std::vector<std::uint8_t> png;

    explicit Bench(benchmark::State& state)
        : polytope(geometry::polytopeOf(*geometry::findEntry(kPolytopes[state.range(0)]))),
          planes{-kHalf, kSlices, polytope->circumradius / kHalf} {
        state.SetLabel(polytope->name);
        std::mt19937 random(4);
        std::normal_distribution<double> normal;
        const auto quaternion = [&] {
            const double a = normal(random), b = normal(random), c = normal(random), d = normal(random);
            return glm::normalize(glm::dquat(a, b, c, d));
        };
        for (int i = 0; i < 64; ++i) {
            const glm::dquat left = quaternion(), right = quaternion();
            orientations.emplace_back(left, right);
        }
    }

    void slice() { slicer.slice(*polytope, orientations[next++ % orientations.size()], planes, slices); }
    void compose() { scene::compose(*polytope, planes, 0, {}, kViewport, scene); }
    void draw(render::Renderer& renderer) { renderer.draw(*polytope, slices, scene, image); }
    void encode() { encoder.encode(image, "{}", png); }
};

render::Renderer& renderer() {
    static render::Renderer instance;
    return instance;
}

void slice(benchmark::State& state) {
    Bench bench(state);
    std::size_t elements = 0;
    for (auto _ : state) {
        bench.slice();
        elements += bench.slices.vertices.size() + bench.slices.edges.size() + bench.slices.faceOf.size();
    }
    state.counters["slices"] =
        benchmark::Counter(static_cast<double>(state.iterations() * kSlices), benchmark::Counter::kIsRate);
    state.counters["elements"] = benchmark::Counter(static_cast<double>(elements), benchmark::Counter::kIsRate);
}

void compose(benchmark::State& state) {
    Bench bench(state);
    bench.slice();
    for (auto _ : state) bench.compose();
}

void draw(benchmark::State& state) {
    Bench bench(state);
    bench.compose();
    for (auto _ : state) {
        state.PauseTiming();
        bench.slice();
        state.ResumeTiming();
        bench.draw(renderer());
    }
}

void encode(benchmark::State& state) {
    Bench bench(state);
    bench.compose();
    for (auto _ : state) {
        state.PauseTiming();
        bench.slice();
        bench.draw(renderer());
        state.ResumeTiming();
        bench.encode();
    }
    state.counters["bytes"] = static_cast<double>(bench.png.size());
}

void frame(benchmark::State& state) {
    Bench bench(state);
    for (auto _ : state) {
        bench.slice();
        bench.compose();
        bench.draw(renderer());
        bench.encode();
    }
}

template <protocol::Encoding encoding>
void message(benchmark::State& state) {
    Bench bench(state);
    bench.compose();
    std::string text;
    for (auto _ : state) {
        state.PauseTiming();
        bench.slice();
        state.ResumeTiming();
        protocol::slicesMessage(*bench.polytope, bench.slices, bench.scene, 1, {}, encoding, text);
    }
    state.counters["bytes"] = static_cast<double>(text.size());
}

void everyPolytope(benchmark::internal::Benchmark* bench) {
    bench->DenseRange(0, std::ssize(kPolytopes) - 1)->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK(slice)->Apply(everyPolytope);
BENCHMARK(compose)->Apply(everyPolytope);
BENCHMARK(draw)->Apply(everyPolytope);
BENCHMARK(encode)->Apply(everyPolytope);
BENCHMARK(frame)->Apply(everyPolytope);
BENCHMARK(message<protocol::Encoding::json>)->Apply(everyPolytope);
BENCHMARK(message<protocol::Encoding::cbor>)->Apply(everyPolytope);

}  // namespace
}  // namespace oval4d
