// How long each part of a picture takes: 21 slices at 1280 × 720, orientations drawn at random.

#include <benchmark/benchmark.h>

#include <string>

#include "geometry/catalogue.hpp"
#include "path.hpp"
#include "protocol/cpp/codec.hpp"

namespace oval4d::bench {
namespace {

const char* const kPolytopes[] = {"5-cell", "8-cell", "16-cell", "24-cell", "120-cell", "600-cell"};

Path pathOf(benchmark::State& state) {
    const char* const name = kPolytopes[state.range(0)];
    state.SetLabel(name);
    return Path(geometry::polytopeOf(*geometry::findEntry(name)));
}

void slice(benchmark::State& state) {
    Path path = pathOf(state);
    std::size_t elements = 0;
    for (auto _ : state) {
        path.slice();
        elements += path.elements();
    }
    state.counters["slices"] =
        benchmark::Counter(static_cast<double>(state.iterations() * path.planes.count), benchmark::Counter::kIsRate);
    state.counters["elements"] = benchmark::Counter(static_cast<double>(elements), benchmark::Counter::kIsRate);
}

void compose(benchmark::State& state) {
    Path path = pathOf(state);
    path.slice();
    for (auto _ : state) path.compose();
}

void draw(benchmark::State& state) {
    Path path = pathOf(state);
    path.compose();
    for (auto _ : state) {
        state.PauseTiming();
        path.slice();
        state.ResumeTiming();
        path.draw();
    }
}

void encode(benchmark::State& state) {
    Path path = pathOf(state);
    path.compose();
    for (auto _ : state) {
        state.PauseTiming();
        path.slice();
        path.draw();
        state.ResumeTiming();
        path.encode();
    }
    state.counters["bytes"] = static_cast<double>(path.png.size());
}

void frame(benchmark::State& state) {
    Path path = pathOf(state);
    for (auto _ : state) path.frame();
}

template <protocol::Encoding encoding>
void message(benchmark::State& state) {
    Path path = pathOf(state);
    path.compose();
    std::string text;
    for (auto _ : state) {
        state.PauseTiming();
        path.slice();
        state.ResumeTiming();
        protocol::slicesMessage(*path.polytope, path.slices, path.scene, 1, {}, encoding, text);
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
}  // namespace oval4d::bench
