#include "fields/array/brick_bounds.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <new>

#include "fields/array/cell.hpp"

namespace oval4d::fields {

namespace {

constexpr std::size_t kCells = BrickBounds::kCells;
constexpr std::size_t kRun = 64;  // the maximum number of neighboring bricks along x that are read together
constexpr float kInfinityF = std::numeric_limits<float>::infinity();

// Returns the entry of a brick: its minimum (high half) and maximum (low half) in 8 bytes, so that threads can write
// the entry atomically. The lowest bit of the stored maximum is 1 if a sample is missing, else 0. If the maximum has
// another lowest bit, the next greater float with the right bit is stored. A minimum of 0 is stored as −0, so no entry
// is 0: the number 0 stands for an empty slot of the cache.
std::uint64_t packStatistics(const SampleStatistics& brick) {
    const bool missing = brick.missing > 0;
    float max = brick.max;
    if ((std::bit_cast<std::uint32_t>(max) & 1U) != (missing ? 1U : 0U)) max = std::nextafter(max, kInfinityF);
    const float min = brick.min == 0 ? -0.F : brick.min;
    return std::uint64_t{std::bit_cast<std::uint32_t>(min)} << 32U | std::bit_cast<std::uint32_t>(max);
}

void extendByPackedStatistics(ValueBounds& bounds, std::uint64_t entry) {
    const auto maxBits = static_cast<std::uint32_t>(entry);
    bounds.min = std::min(bounds.min, double{std::bit_cast<float>(static_cast<std::uint32_t>(entry >> 32U))});
    bounds.max = std::max(bounds.max, double{std::bit_cast<float>(maxBits)});
    if ((maxBits & 1U) != 0) bounds.hasValueEverywhere = false;
}

void add(SampleStatistics& statistics, const SampleStatistics& other) {
    statistics.min = std::min(statistics.min, other.min);
    statistics.max = std::max(statistics.max, other.max);
    statistics.missing += other.missing;
}

void add(SampleStatistics& statistics, float sample) {
    if (!isFinite(sample)) {
        ++statistics.missing;
        return;
    }
    statistics.min = std::min(statistics.min, sample);
    statistics.max = std::max(statistics.max, sample);
}

const float* sampleRowAt(const SampledLattice& from, const std::array<std::size_t, 4>& at) {
    const auto& axes = from.lattice.axes;
    return from.samples + at[0] + at[1] * axes[1].stride + at[2] * axes[2].stride + at[3] * axes[3].stride;
}

// Divides `range` into rows of samples along x. For each row, calls `visit` with a pointer to the first sample of the
// row and the indices of this sample.
template <typename Visit>
void visitRows(const SampledLattice& from, const SampleIndexRange& range, const Visit& visit) {
    auto at = range.first;
    for (at[3] = range.first[3]; at[3] <= range.last[3]; ++at[3]) {
        for (at[2] = range.first[2]; at[2] <= range.last[2]; ++at[2]) {
            for (at[1] = range.first[1]; at[1] <= range.last[1]; ++at[1]) visit(sampleRowAt(from, at), at);
        }
    }
}

SampleIndexRange sampleRangeOfBrick(const Lattice& lattice, const std::array<std::size_t, 4>& brick) {
    SampleIndexRange range{};
    for (std::size_t i = 0; i < 4; ++i) {
        range.first[i] = brick[i] * kCells;
        range.last[i] = std::min(range.first[i] + kCells, lattice.shape[i] - 1);
    }
    return range;
}

SampleStatistics statisticsOf(const SampledLattice& from, const SampleIndexRange& range) {
    SampleStatistics statistics;
    const std::size_t count = range.last[0] - range.first[0] + 1;
    visitRows(from, range, [&](const float* row, const auto& /*at*/) {
        for (std::size_t i = 0; i < count; ++i) add(statistics, row[i]);
    });
    return statistics;
}

// Writes to `bricks` the statistics of a run: bricks that are neighbors along x, which together have the samples in
// `range`. If a brick has missing samples, reads the brick again, to count these samples and leave them out of the
// bounds.
void computeBrickRunStatistics(const SampledLattice& from, const SampleIndexRange& range,
                               std::span<SampleStatistics> bricks) {
    std::array<float, kRun * kCells + 1> low, high, sum;  // sum: 0, or NaN if a sample of the column is missing
    const std::size_t count = range.last[0] - range.first[0] + 1;
    std::fill_n(low.begin(), count, kInfinityF);
    std::fill_n(high.begin(), count, -kInfinityF);
    std::fill_n(sum.begin(), count, 0.F);
    visitRows(from, range, [&](const float* row, const auto& /*at*/) {
        for (std::size_t i = 0; i < count; ++i) {
            const float sample = row[i];
            low[i] = sample < low[i] ? sample : low[i];
            high[i] = sample > high[i] ? sample : high[i];
            sum[i] += sample - sample;
        }
    });
    for (std::size_t brick = 0; brick < bricks.size(); ++brick) {
        const std::size_t begin = brick * kCells, end = std::min(begin + kCells, count - 1);
        SampleStatistics& statistics = bricks[brick] = {};
        float zero = 0;
        for (std::size_t i = begin; i <= end; ++i) {
            statistics.min = std::min(statistics.min, low[i]);
            statistics.max = std::max(statistics.max, high[i]);
            zero += sum[i];
        }
        if (zero == 0) continue;
        SampleIndexRange one = range;
        one.first[0] = range.first[0] + begin;
        one.last[0] = range.first[0] + end;
        statistics = statisticsOf(from, one);
    }
}

// Returns the number of missing samples of a brick, without samples on faces that the brick shares with an earlier
// brick. So the sum over all bricks counts each sample once.
std::size_t countMissingSamplesOfBrick(const SampledLattice& from, const std::array<std::size_t, 4>& brick) {
    SampleIndexRange range = sampleRangeOfBrick(from.lattice, brick);
    for (std::size_t i = 0; i < 4; ++i) range.first[i] += brick[i] > 0 ? 1 : 0;
    return statisticsOf(from, range).missing;
}

}  // namespace

BrickBounds::BrickBounds(const SampledLattice& from, bool eager) : from_(from), eager_(eager) {
    PyramidLevel bricks;
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t cells = from.lattice.shape[i] - 1;
        bricks.size[i] = std::max<std::size_t>(1, (cells + kCells - 1) / kCells);
    }
    const std::size_t count = bricks.size[0] * bricks.size[1] * bricks.size[2] * bricks.size[3];
    if (eager) {
        bricks.entries = eagerEntries_.emplace_back(count);
        levels_.push_back(bricks);
        computeAllBrickStatistics();
        while (levels_.back().entries.size() > 1) addPyramidLevel();
        return;
    }
    slotCount_ = std::min(std::bit_ceil(count), kMaxLazyBytes / sizeof(CacheSlot));
    // Unlike new, calloc returns memory whose pages are allocated only when they are written.
    slots_.reset(
        static_cast<CacheSlot*>(std::calloc(slotCount_, sizeof(CacheSlot))));  // NOLINT(cppcoreguidelines-no-malloc)
    if (!slots_) throw std::bad_alloc();
    levels_.push_back(bricks);
    estimateStatistics();
}

void BrickBounds::computeAllBrickStatistics() {
    const PyramidLevel& level = levels_.front();
    const BrickIndex& size = level.size;
    std::array<SampleStatistics, kRun> run;
    auto entry = level.entries.begin();
    for (std::size_t row = 0; row < size[1] * size[2] * size[3]; ++row) {
        BrickIndex brick{0, row % size[1], row / size[1] % size[2], row / size[1] / size[2]};
        for (; brick[0] < size[0]; brick[0] += kRun) {
            const std::size_t count = std::min(kRun, size[0] - brick[0]);
            SampleIndexRange range = sampleRangeOfBrick(from_.lattice, brick);
            range.last[0] = std::min(range.first[0] + count * kCells, from_.lattice.shape[0] - 1);
            computeBrickRunStatistics(from_, range, std::span(run).first(count));
            for (std::size_t i = 0; i < count; ++i) {
                *entry++ = packStatistics(run[i]);
                if (run[i].missing > 0)
                    run[i].missing = countMissingSamplesOfBrick(from_, {brick[0] + i, brick[1], brick[2], brick[3]});
                add(statistics_, run[i]);
            }
        }
    }
}

void BrickBounds::estimateStatistics() {
    constexpr std::size_t kRuns = 4096, kSamples = 64;
    // Each run is a sequence of samples that are neighbors in memory. Run i begins at the fraction (i · kGoldenRatio)
    // mod 1 of the array. So the beginnings are spread evenly, but not at equal distances: then all runs might begin at
    // the same phase of a periodic array.
    constexpr double kGoldenRatio = 0.6180339887498949;
    const std::size_t count = sampleCount(from_.lattice.shape), length = std::min(kSamples, count);
    for (std::size_t run = 0; run < kRuns; ++run) {
        const double part = std::fmod(static_cast<double>(run) * kGoldenRatio, 1.);
        const auto begin = static_cast<std::size_t>(part * static_cast<double>(count - length));
        for (std::size_t i = begin; i < begin + length; ++i) add(statistics_, from_.samples[i]);
    }
}

// Adds a level to the pyramid. A brick of the new level joins up to 2⁴ bricks of the level below.
void BrickBounds::addPyramidLevel() {
    const PyramidLevel fine = levels_.back();
    PyramidLevel coarse;
    for (std::size_t i = 0; i < 4; ++i) coarse.size[i] = (fine.size[i] + 1) / 2;
    std::vector<ValueBounds> joined(coarse.size[0] * coarse.size[1] * coarse.size[2] * coarse.size[3]);
    auto entry = fine.entries.begin();
    for (std::size_t l = 0; l < fine.size[3]; ++l) {
        for (std::size_t k = 0; k < fine.size[2]; ++k) {
            for (std::size_t j = 0; j < fine.size[1]; ++j) {
                const std::size_t row = ((l / 2 * coarse.size[2] + k / 2) * coarse.size[1] + j / 2) * coarse.size[0];
                for (std::size_t i = 0; i < fine.size[0]; ++i) extendByPackedStatistics(joined[row + i / 2], *entry++);
            }
        }
    }
    coarse.entries = eagerEntries_.emplace_back(joined.size());
    std::transform(joined.begin(), joined.end(), coarse.entries.begin(), [](const ValueBounds& bounds) {
        return packStatistics(
            {static_cast<float>(bounds.min), static_cast<float>(bounds.max), bounds.hasValueEverywhere ? 0U : 1U});
    });
    levels_.push_back(coarse);
}

std::uint64_t BrickBounds::packedStatisticsAt(const PyramidLevel& level, const BrickIndex& brick) const {
    const std::size_t index =
        ((brick[3] * level.size[2] + brick[2]) * level.size[1] + brick[1]) * level.size[0] + brick[0];
    if (eager_) return level.entries[index];
    constexpr std::uint64_t kGoldenRatio = 0x9E3779B97F4A7C15U;  // 2⁶⁴/φ; multiplication by it spreads neighbors over
                                                                 // the slots
    CacheSlot& slot = slots_[(index * kGoldenRatio >> 32U) & (slotCount_ - 1)];
    const std::atomic_ref<std::uint64_t> check(slot.check), entry(slot.entry);
    std::uint64_t known = entry.load(std::memory_order_relaxed);
    if (known != 0 && (check.load(std::memory_order_relaxed) ^ known) == index) return known;
    // Several threads may compute this entry at the same time without a lock, because they store the same entry.
    known = packStatistics(statisticsOf(from_, sampleRangeOfBrick(from_.lattice, brick)));
    entry.store(known, std::memory_order_relaxed);
    check.store(known ^ index, std::memory_order_relaxed);
    return known;
}

ValueBounds BrickBounds::boundsOf(const SampleIndexRange& range) const {
    BrickIndex first{}, last{};
    for (std::size_t i = 0; i < 4; ++i) {
        first[i] = std::min(range.first[i] / kCells, levels_.front().size[i] - 1);
        last[i] = range.last[i] == 0 ? 0 : std::max(first[i], (range.last[i] - 1) / kCells);
    }
    const auto entries = [&] {
        std::size_t product = 1;
        for (std::size_t i = 0; i < 4; ++i) product *= std::min(last[i] - first[i] + 1, kMaxEntries + 1);
        return product;
    };
    auto level = levels_.begin();
    while (entries() > (eager_ ? kMaxEntries : kMaxLazyBricks)) {
        if (++level == levels_.end()) return {-double{kInfinityF}, double{kInfinityF}, false};
        for (std::size_t i = 0; i < 4; ++i) {
            first[i] /= 2;
            last[i] /= 2;
        }
    }
    ValueBounds bounds;
    BrickIndex at{};
    for (at[3] = first[3]; at[3] <= last[3]; ++at[3]) {
        for (at[2] = first[2]; at[2] <= last[2]; ++at[2]) {
            for (at[1] = first[1]; at[1] <= last[1]; ++at[1]) {
                for (at[0] = first[0]; at[0] <= last[0]; ++at[0])
                    extendByPackedStatistics(bounds, packedStatisticsAt(*level, at));
            }
        }
    }
    return bounds;
}

std::size_t BrickBounds::memoryBytes() const {
    std::size_t bytes = 0;
    for (const auto& entries : eagerEntries_) bytes += entries.size() * sizeof(std::uint64_t);
    return bytes + slotCount_ * sizeof(CacheSlot);
}

}  // namespace oval4d::fields
