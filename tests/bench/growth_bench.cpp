// How building, slicing and whole frames grow with the polytope, the slices and the pixels. `size` is what the time
// is set against: elements built, elements cut, slices, pixels. tests/bench/growth makes a table of it.

#include <benchmark/benchmark.h>

#include "path.hpp"

namespace oval4d::bench {
namespace {

constexpr std::int64_t kSixHundredCell = 5;

double sizeOf(const geometry::Polytope& p) {
    return static_cast<double>(p.vertices.size() + p.edges.size() + p.faces.size() + p.cells.size());
}

void growBuild(benchmark::State& state) {
    const Subject& subject = kSubjects[state.range(0)];
    state.SetLabel(subject.name);
    for (auto _ : state) benchmark::DoNotOptimize(subject.build());
    state.counters["size"] = sizeOf(*bench::subject(state.range(0)));
}

// One step of the path, or all of it, for every polytope …
template <void (Path::*step)()>
void growWithPolytope(benchmark::State& state) {
    Path path(subject(state.range(0)));
    state.SetLabel(path.polytope->name);
    std::size_t elements = 0;
    for (auto _ : state) {
        (path.*step)();
        elements += path.elements();
    }
    state.counters["size"] = static_cast<double>(elements) / static_cast<double>(state.iterations());
}

// … and for every number of slices.
template <void (Path::*step)()>
void growWithSlices(benchmark::State& state) {
    Path path(subject(kSixHundredCell), static_cast<int>(state.range(0)));
    state.SetLabel(std::to_string(state.range(0)) + " slices of the 600-cell");
    for (auto _ : state) (path.*step)();
    state.counters["size"] = static_cast<double>(state.range(0));
}

void growWithPixels(benchmark::State& state) {
    const auto width = static_cast<int>(state.range(0));
    Path path(subject(0), 21, {width, width * 9 / 16});
    state.SetLabel("5-cell, " + std::to_string(width) + " × " + std::to_string(path.viewport.height));
    for (auto _ : state) path.frame();
    state.counters["size"] = static_cast<double>(path.viewport.width) * path.viewport.height;
}

void everySubject(benchmark::internal::Benchmark* bench) {
    bench->DenseRange(0, std::ssize(kSubjects) - 1)->Unit(benchmark::kMillisecond)->UseRealTime();
}
void everyCount(benchmark::internal::Benchmark* bench) {
    for (const int count : {1, 3, 11, 21, 51, 101, 201}) bench->Arg(count);
    bench->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK(growBuild)->Apply(everySubject);
BENCHMARK(growWithPolytope<&Path::slice>)->Name("growSlice")->Apply(everySubject);
BENCHMARK(growWithPolytope<&Path::frame>)->Name("growFrame")->Apply(everySubject);
BENCHMARK(growWithSlices<&Path::slice>)->Name("growSliceWithSlices")->Apply(everyCount);
BENCHMARK(growWithSlices<&Path::frame>)->Name("growFrameWithSlices")->Apply(everyCount);
BENCHMARK(growWithPixels)
    ->Name("growFrameWithPixels")
    ->Arg(256)
    ->Arg(640)
    ->Arg(1280)
    ->Arg(1920)
    ->Arg(3840)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace oval4d::bench
