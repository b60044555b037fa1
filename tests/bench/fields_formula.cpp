// Measures the evaluation of formulas: values and gradients at a million points, and bounds in boxes.

#include <benchmark/benchmark.h>

#include <array>
#include <random>
#include <string>
#include <vector>

#include "fields/formula/formula_function.hpp"
#include "fields/formula/kernels_portable.hpp"

namespace oval4d::bench {
namespace {

struct Subject {
    const char* name;
    const char* text;
};
constexpr Subject kSubjects[] = {
    {"tiger", "(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-0.7)^2 - 0.09"},
    {"torus links", "(x^3-3*x*y^2+z^2-w^2)^2 + (3*x^2*y-y^3+2*z*w)^2 - 0.01"},
    {"gyroid in time", "sin(x)*cos(y)+sin(y)*cos(z)+sin(z)*cos(x)-sin(t)"},
    {"heat kernels", "exp(-((x-1)^2+y^2+z^2)/(4*t))/t^1.5 + exp(-((x+1)^2+y^2+z^2)/(4*t))/t^1.5 - 0.1"},
    {"superquadric", "abs(x)^2.5+abs(y)^2.5+abs(z)^2.5+abs(w)^2.5-1"},
};

/// Random points of [-2, 2]⁴, with memory for the results.
struct Points {
    static constexpr std::size_t kCount = 1 << 20;
    std::array<std::vector<float>, 4> coordinates, gradients;
    std::vector<float> values;

    Points() : values(kCount) {
        std::mt19937 random(1);
        std::uniform_real_distribution<float> coordinate(-2, 2);
        for (auto& axis : coordinates) {
            axis.resize(kCount);
            for (float& value : axis) value = coordinate(random);
        }
        for (auto& axis : gradients) axis.resize(kCount);
    }
    fields::PointBatch batch() const { return {coordinates[0], coordinates[1], coordinates[2], coordinates[3]}; }
};

Points& points() {
    static Points kPoints;
    return kPoints;
}

fields::Formula formula(benchmark::State& state) {
    const Subject& subject = kSubjects[state.range(0)];
    state.SetLabel(subject.name);
    return *fields::parseFormula(subject.text);
}

void countPoints(benchmark::State& state) {
    const double count = static_cast<double>(state.iterations()) * Points::kCount;
    state.counters["per point"] = benchmark::Counter(count, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void evaluateWith(benchmark::State& state, const fields::TapeKernels& kernels) {
    const fields::FormulaFunction function(formula(state), kernels);
    for (auto _ : state) function.evaluate(points().batch(), points().values);
    countPoints(state);
}
void evaluate(benchmark::State& state) { evaluateWith(state, fields::fastestKernels()); }
void evaluatePortably(benchmark::State& state) { evaluateWith(state, fields::portableKernels()); }

void differentiate(benchmark::State& state) {
    const fields::FormulaFunction function(formula(state));
    auto& [x, y, z, w] = points().gradients;
    for (auto _ : state) function.evaluateWithGradient(points().batch(), points().values, {x, y, z, w});
    countPoints(state);
}

void bounds(benchmark::State& state) {
    const fields::FormulaFunction function(formula(state));
    const auto& [x, y, z, w] = points().coordinates;
    std::size_t i = 0;
    for (auto _ : state) {
        const glm::dvec4 corner(x[i], y[i], z[i], w[i]);
        benchmark::DoNotOptimize(function.boundsIn({corner, corner + 0.1}));
        i = (i + 1) % Points::kCount;
    }
}

void parse(benchmark::State& state) {
    const Subject& subject = kSubjects[state.range(0)];
    state.SetLabel(subject.name);
    for (auto _ : state) benchmark::DoNotOptimize(fields::parseFormula(subject.text));
}

constexpr auto kLast = static_cast<std::int64_t>(std::size(kSubjects)) - 1;
BENCHMARK(evaluate)->DenseRange(0, kLast)->Unit(benchmark::kMillisecond);
BENCHMARK(evaluatePortably)->DenseRange(0, kLast)->Unit(benchmark::kMillisecond);
BENCHMARK(differentiate)->DenseRange(0, kLast)->Unit(benchmark::kMillisecond);
BENCHMARK(bounds)->DenseRange(0, kLast);
BENCHMARK(parse)->DenseRange(0, kLast)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace oval4d::bench
