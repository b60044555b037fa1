#include "pipeline/cost.hpp"

#include <cmath>
#include <numeric>

namespace oval4d::pipeline {

namespace {

double elements(const slicing::Object& object) {
    const auto counts = slicing::elementCounts(object);
    return static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::size_t{0}));
}

/// Returns the approximate number of elements that a hyperplane cuts, out of n. The elements form a three-dimensional
/// boundary, and the hyperplane cuts it in two dimensions: hence the exponent 2/3.
double met(double n) { return std::pow(n, 2.0 / 3); }

}  // namespace

EstimatedSeconds frameCost(const session::State& state, scene::Viewport viewport) {
    const double n = elements(state.object);
    const double pixels = static_cast<double>(viewport.width) * viewport.height;
    const double bodies = state.slices.count * (2e-5 + 1.2e-6 * met(n));
    const double layers = 1 + 0.4 * std::log2(1 + n / 25);  // the number of faces blended over each other at a pixel
    return EstimatedSeconds(5e-4 + bodies + 6e-9 * pixels * layers);
}

EstimatedSeconds geometryCost(const session::State& state) {
    const double n = elements(state.object);
    return EstimatedSeconds(1e-4 + 1e-7 * n + 1e-7 * state.slices.count * met(n));
}

EstimatedSeconds exportCost(const session::State& state) {
    return EstimatedSeconds(0.02 + 5e-6 * state.slices.count * met(elements(state.object)));
}

}  // namespace oval4d::pipeline
