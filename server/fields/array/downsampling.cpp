#include "fields/array/downsampling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "fields/array/cell.hpp"

namespace oval4d::fields {

namespace {

// A contribution to a sample of the downsampled array: the index of this sample along an axis, `coarse`, and the
// weight.
struct CoarseSampleWeight {
    std::uint32_t coarse;
    float weight;
};

// The contributions along one axis. Sample i of the original array contributes to the samples of the downsampled array
// in items[begin[i]] … items[begin[i + 1] − 1].
struct ScatterWeights {
    std::vector<std::uint32_t> begin{0};  // size() + 1 indices into items
    std::vector<CoarseSampleWeight> items;

    // Returns the number of samples of the original array along the axis.
    std::size_t size() const { return begin.size() - 1; }
    std::span<const CoarseSampleWeight> operator[](std::size_t i) const {
        return std::span(items).subspan(begin[i], begin[i + 1] - begin[i]);
    }
};

// Returns the integral of the hat function t ↦ max(0, 1 − |t|) from −∞ to x.
double hatIntegral(double x) {
    if (x <= -1) return 0;
    if (x >= 1) return 1;
    return x < 0 ? 0.5 * (1 + x) * (1 + x) : 1 - 0.5 * (1 - x) * (1 - x);
}

// Returns the weights for an axis that is downsampled from `fine` to `coarse` samples. For each coarse sample, the sum
// of the weights of all fine samples is 1.
ScatterWeights downsamplingWeights(std::size_t fine, std::size_t coarse) {
    ScatterWeights weights;
    const double length =
        coarse == fine ? 1 : static_cast<double>(fine - 1) / static_cast<double>(std::max<std::size_t>(coarse, 2) - 1);
    const auto weight = [&](std::size_t i, std::size_t j) {
        const bool end = j == 0 || j + 1 == coarse;
        if (coarse == fine || end) return i == (j == 0 ? 0 : fine - coarse + j) ? 1. : 0.;
        const double offset = static_cast<double>(j) * length - static_cast<double>(i);
        return (hatIntegral(offset + length / 2) - hatIntegral(offset - length / 2)) / length;
    };
    for (std::size_t i = 0; i < fine; ++i) {
        const auto nearest = static_cast<std::size_t>(std::lround(static_cast<double>(i) / length));
        for (std::size_t j = nearest - std::min<std::size_t>(nearest, 2); j < std::min(coarse, nearest + 3); ++j) {
            const auto each = static_cast<float>(weight(i, j));
            if (each > 0) weights.items.push_back({static_cast<std::uint32_t>(j), each});
        }
        weights.begin.push_back(static_cast<std::uint32_t>(weights.items.size()));
    }
    return weights;
}

// For each sample in a row of the downsampled array, the weighted sum of samples of the original array and the sum of
// the weights.
struct WeightedRowSums {
    std::vector<float> values, weights;

    void setFromRow(const float* row, const ScatterWeights& weightsOfX) {
        std::fill(values.begin(), values.end(), 0.F);
        std::fill(weights.begin(), weights.end(), 0.F);
        for (std::size_t i = 0; i < weightsOfX.size(); ++i) {
            if (!isFinite(row[i])) continue;
            for (const CoarseSampleWeight& each : weightsOfX[i]) {
                values[each.coarse] += row[i] * each.weight;
                weights[each.coarse] += each.weight;
            }
        }
    }
};

void addWeighted(std::span<const float> row, float weight, float* to) {
    for (std::size_t i = 0; i < row.size(); ++i) to[i] += weight * row[i];
}

// Advises the system that the samples first + places[i] are needed soon. `places` must be in ascending order.
void prefetchRow(const SampleStorage& samples, std::size_t first, std::span<const std::size_t> places) {
    if (!samples.file()) return;
    constexpr std::size_t kPage = 4096 / sizeof(float);
    const std::size_t length = places.back() - places.front() + 1;
    if (length <= 2 * kPage * places.size()) return samples.prefetch(first, length);
    for (const std::size_t place : places) samples.prefetch(first + place, 1);
}

}  // namespace

Shape downsampledShape(const Shape& shape) {
    Shape coarse{};
    std::transform(shape.begin(), shape.end(), coarse.begin(), [](std::size_t samples) { return samples / 2 + 1; });
    return coarse;
}

std::vector<float> downsample(const Shape& shape, std::span<const float> samples) {
    const Shape size = downsampledShape(shape);
    std::array<ScatterWeights, 4> weights;
    for (std::size_t i = 0; i < 4; ++i) weights[i] = downsamplingWeights(shape[i], size[i]);
    std::vector<float> sums(sampleCount(size)), weightSums(sums.size());
    WeightedRowSums row{std::vector<float>(size[0]), std::vector<float>(size[0])};
    const float* from = samples.data();
    for (std::size_t l = 0; l < shape[3]; ++l) {
        for (std::size_t k = 0; k < shape[2]; ++k) {
            for (std::size_t j = 0; j < shape[1]; ++j) {
                row.setFromRow(from, weights[0]);
                from += shape[0];
                for (const CoarseSampleWeight& w : weights[3][l]) {
                    for (const CoarseSampleWeight& z : weights[2][k]) {
                        for (const CoarseSampleWeight& y : weights[1][j]) {
                            const float weight = w.weight * z.weight * y.weight;
                            const std::size_t at = ((w.coarse * size[2] + z.coarse) * size[1] + y.coarse) * size[0];
                            addWeighted(row.values, weight, &sums[at]);
                            addWeighted(row.weights, weight, &weightSums[at]);
                        }
                    }
                }
            }
        }
    }
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = weightSums[i] > 0 ? sums[i] / weightSums[i] : kNoValue;
    return sums;
}

Shape selectionShape(Shape shape, std::size_t maxSamples) {
    while (sampleCount(shape) > maxSamples) {
        std::size_t& longest = *std::max_element(shape.begin(), shape.end());
        longest = (longest + 1) / 2;
    }
    return shape;
}

std::vector<float> selectSamples(const Shape& shape, const SampleStorage& samples, const Shape& size) {
    // For each axis, the distances in memory from the first sample of the array to the selected samples, in samples.
    std::array<std::vector<std::size_t>, 4> places;
    std::size_t stride = 1;
    for (std::size_t axis = 0; axis < 4; stride *= shape[axis++]) {
        const std::size_t last = size[axis] - 1;
        for (std::size_t i = 0; i <= last; ++i)
            places[axis].push_back(last == 0 ? 0 : (i * (shape[axis] - 1) + last / 2) / last * stride);
    }
    std::vector<float> selected;
    selected.reserve(sampleCount(size));
    const std::span<const float> from = samples.values();
    for (const std::size_t w : places[3]) {
        for (const std::size_t z : places[2]) {
            // First announce all rows to the system, which then reads them in parallel, in much less time.
            for (const std::size_t y : places[1]) prefetchRow(samples, w + z + y, places[0]);
            for (const std::size_t y : places[1]) {
                for (const std::size_t x : places[0]) selected.push_back(from[w + z + y + x]);
            }
        }
    }
    return selected;
}

}  // namespace oval4d::fields
