// Measures fields given by arrays: values and gradients at the points of a rotated slice, bounds, and the reading of
// bricks (blocks of samples).

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <vector>

#include <glm/common.hpp>

#include "fields/array/array_function.hpp"

namespace oval4d::bench {
namespace {

constexpr std::size_t kBlock = 512;  // points in a block of 8 × 8 × 8

// The lattice points of 21 slices, rotated in two planes, in the order of their blocks.
struct SlicePoints {
    std::vector<float> x, y, z, w;

    explicit SlicePoints(int size) {
        const float c = std::cos(0.5F), s = std::sin(0.5F), d = std::cos(0.3F), e = std::sin(0.3F);
        const int blocks = size / 8;
        for (int slice = -10; slice <= 10; ++slice) {
            for (int i = 0; i < size * size * size; ++i) {
                const int block = i / 512, at = i % 512;
                const std::array<int, 3> index{block % blocks * 8 + at % 8, block / blocks % blocks * 8 + at / 8 % 8,
                                               block / blocks / blocks * 8 + at / 64};
                std::array<float, 4> p{0, 0, 0, 0.09F * static_cast<float>(slice)};
                for (std::size_t axis = 0; axis < 3; ++axis)
                    p[axis] = -0.95F + 1.9F * static_cast<float>(index[axis]) / static_cast<float>(size - 1);
                x.push_back(c * p[0] - s * p[3]);
                y.push_back(d * p[1] - e * p[2]);
                z.push_back(e * p[1] + d * p[2]);
                w.push_back(s * p[0] + c * p[3]);
            }
        }
    }
    fields::PointBatch block(std::size_t at) const {
        return {{&x[at], kBlock}, {&y[at], kBlock}, {&z[at], kBlock}, {&w[at], kBlock}};
    }
};

std::vector<float> tiger(std::size_t n) {
    std::vector<float> samples;
    const auto at = [&](std::size_t i) { return -1 + 2 * static_cast<float>(i) / static_cast<float>(n - 1); };
    for (std::size_t l = 0; l < n; ++l)
        for (std::size_t k = 0; k < n; ++k)
            for (std::size_t j = 0; j < n; ++j)
                for (std::size_t i = 0; i < n; ++i)
                    samples.push_back(std::hypot(std::hypot(at(i), at(j)) - 0.6F, std::hypot(at(k), at(l)) - 0.5F));
    return samples;
}

fields::ArrayFunction arrayOf(std::size_t n) { return {{n, n, n, n}, {}, fields::SampleStorage(tiger(n))}; }

void setTimePerPoint(benchmark::State& state, std::size_t points) {
    using benchmark::Counter;
    state.counters["per point"] =
        Counter(static_cast<double>(points), Counter::kIsIterationInvariantRate | Counter::kInvert);
}

void evaluate(benchmark::State& state) {
    const auto array = arrayOf(static_cast<std::size_t>(state.range(0)));
    const SlicePoints points(static_cast<int>(state.range(1)));
    std::array<float, kBlock> values;
    for (auto _ : state) {
        for (std::size_t i = 0; i < points.x.size(); i += kBlock) {
            array.evaluate(points.block(i), values);
            benchmark::DoNotOptimize(values.data());
        }
    }
    setTimePerPoint(state, points.x.size());
}

void evaluateWithGradient(benchmark::State& state) {
    const auto array = arrayOf(static_cast<std::size_t>(state.range(0)));
    const SlicePoints points(static_cast<int>(state.range(1)));
    std::array<float, kBlock> values, x, y, z, w;
    for (auto _ : state) {
        for (std::size_t i = 0; i < points.x.size(); i += kBlock) {
            array.evaluateWithGradient(points.block(i), values, {x, y, z, w});
            benchmark::DoNotOptimize(values.data());
        }
    }
    setTimePerPoint(state, points.x.size());
}

void bounds(benchmark::State& state) {
    const auto array = arrayOf(64);
    const SlicePoints points(64);
    std::vector<fields::Box> boxes;
    for (std::size_t i = 0; i < points.x.size(); i += kBlock) {
        const auto block = points.block(i);
        fields::Box box{glm::dvec4(9), glm::dvec4(-9)};
        for (std::size_t j = 0; j < kBlock; ++j) {
            const glm::dvec4 p(block.x[j], block.y[j], block.z[j], block.w[j]);
            box = {glm::min(box.min, p), glm::max(box.max, p)};
        }
        boxes.push_back(box);
    }
    for (auto _ : state) {
        for (const auto& box : boxes) benchmark::DoNotOptimize(array.boundsIn(box));
    }
    setTimePerPoint(state, boxes.size());
}

void readBricks(benchmark::State& state) {
    const auto n = static_cast<std::size_t>(state.range(0));
    const fields::SampleStorage samples(tiger(n));
    for (auto _ : state) benchmark::DoNotOptimize(fields::ArrayFunction({n, n, n, n}, {}, samples).memoryBytes());
}

void downsample(benchmark::State& state) {
    const auto array = arrayOf(static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(array.downsampled());
}

BENCHMARK(evaluate)->ArgsProduct({{16, 64}, {32, 64}})->ArgNames({"array", "slice"})->Unit(benchmark::kMillisecond);
BENCHMARK(evaluateWithGradient)->ArgsProduct({{64}, {32}})->ArgNames({"array", "slice"})->Unit(benchmark::kMillisecond);
BENCHMARK(bounds)->Unit(benchmark::kMillisecond);
BENCHMARK(readBricks)->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK(downsample)->Arg(64)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace oval4d::bench
