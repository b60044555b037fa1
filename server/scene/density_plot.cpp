#include "scene/density_plot.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace oval4d::scene {

namespace {

// The number of bins per circumradius.
constexpr int kMaxLevel = static_cast<int>(DensityPlot::kLineWeight) * (DensityPlot::kRows - 1) / 2;
constexpr int kBins = 2 * kMaxLevel + 1;

// If this number is added to a float, the sum is rounded to an integer, because the last bit of the sum stands for 1.
// Halves are rounded to the even integer, so opposite numbers remain opposite.
constexpr float kRounder = 12582912.0F;  // the value is 1.5 · 2²³

std::uint32_t densityBinOf(float level) {
    return std::bit_cast<std::uint32_t>(level + kRounder) - (std::bit_cast<std::uint32_t>(kRounder) - kMaxLevel);
}

}  // namespace

void DensityPlot::compute(std::span<const glm::dvec4> vertices, const glm::dmat4& turn, double circumradius) {
    const glm::dmat4 toBins = turn * (kMaxLevel / circumradius);
    for (std::vector<float>& levels : levels_) levels.resize(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const glm::dvec4 at = toBins * vertices[i];
        for (int k = 0; k < 4; ++k)
            levels_[k][i] = static_cast<float>(std::clamp<double>(at[k], -kMaxLevel, kMaxLevel));
    }
    weights_.assign(static_cast<std::size_t>(kRows) * kColumns, 0);
    for (int column = 0; column < kColumns; ++column) countColumn(column);

    tones_.resize(weights_.size());
    const std::uint32_t most = *std::max_element(weights_.begin(), weights_.end());
    const float unit = most > 0 ? 255.0F / std::sqrt(static_cast<float>(most)) : 0;
    std::transform(weights_.begin(), weights_.end(), tones_.begin(), [unit](std::uint32_t weight) {
        return static_cast<std::uint8_t>(std::lround(unit * std::sqrt(static_cast<float>(weight))));
    });
}

void DensityPlot::countColumn(int column) {
    const int gap = std::min(column / kGap, 2);
    const float t = static_cast<float>(column - gap * kGap) / kGap;
    const float *from = levels_[gap].data(), *to = levels_[gap + 1].data();
    const std::size_t count = levels_[gap].size();

    // Vertices with neighboring indices often fall into the same bin, and two increments of one counter must wait for
    // each other. With several tables, used in turn, the CPU can make the increments at the same time.
    constexpr std::size_t kTables = 4, kBatch = 256;
    std::array<std::array<std::uint32_t, kBins>, kTables> tables{};
    std::array<std::uint32_t, kBatch> bins;
    for (std::size_t begin = 0; begin < count; begin += kBatch) {
        const std::size_t size = std::min(kBatch, count - begin);
        for (std::size_t i = 0; i < size; ++i)
            bins[i] = densityBinOf(from[begin + i] + t * (to[begin + i] - from[begin + i]));
        for (std::size_t i = 0; i < size; ++i) ++tables[i % kTables][bins[i]];
    }

    const auto add = [&](int rowFromBelow, std::uint32_t weight) {
        weights_[index(kRows - 1 - rowFromBelow, column)] += weight;
    };
    for (std::uint32_t bin = 0; bin < kBins; ++bin) {
        std::uint32_t lines = 0;
        for (const auto& table : tables) lines += table[bin];
        if (lines == 0) continue;
        const std::uint32_t above = bin % kLineWeight;
        const int row = static_cast<int>(bin / kLineWeight);
        add(row, lines * (kLineWeight - above));
        if (above > 0) add(row + 1, lines * above);
    }
}

}  // namespace oval4d::scene
