#pragma once
// Bounds of an array's values in regions. The bounds come from the minimum and maximum of each brick of 4 × 4 × 4 × 4
// cells.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "fields/array/interpolation.hpp"
#include "fields/scalar_function.hpp"

namespace oval4d::fields {

/// The least and the greatest sample, and the number of missing samples (samples that are NaN or infinite).
struct SampleStatistics {
    float min = std::numeric_limits<float>::infinity();  ///< greater than `max` if no sample has a value
    float max = -std::numeric_limits<float>::infinity();
    std::size_t missing = 0;
};

/// A part of a lattice, given by the indices of its first and last samples along x, y, z and w, both inclusive.
struct SampleIndexRange {
    std::array<std::size_t, 4> first, last;
};

/// Bounds of the samples in each brick of 4 × 4 × 4 × 4 cells. Neighboring bricks share the samples on their common
/// face. A query is a call of boundsOf(). Thread-safe.
///
/// - The constructor reads small arrays once, and makes a pyramid of coarser bricks, each of which joins up to 2⁴
///   bricks of the level below. From this pyramid, a query of any size reads at most kMaxEntries entries (an entry is
///   the bounds of one brick).
/// - Large arrays may be in files that are larger than the memory. Each brick of a large array is read when a query
///   first needs it. A cache of at most kMaxLazyBytes keeps the bounds of bricks that were read; new bounds may replace
///   others. A query that needs more than kMaxLazyBricks bricks would have to read a large part of the file. Therefore
///   such a query reads nothing, and its result is unbounded.
class BrickBounds {
  public:
    static constexpr std::size_t kCells = 4;         ///< the number of cells of a brick along each axis
    static constexpr std::size_t kMaxEntries = 256;  ///< the maximum number of entries that a query reads
    static constexpr std::size_t kMaxLazyBricks = 64;
    static constexpr std::size_t kMaxLazyBytes = std::size_t{32} << 20U;

    /// The lattice and the samples must outlive this object. `eager` says whether the constructor reads all samples.
    BrickBounds(const SampledLattice& from, bool eager);
    ~BrickBounds() = default;
    BrickBounds(const BrickBounds&) = delete;
    BrickBounds& operator=(const BrickBounds&) = delete;

    /// Returns bounds of the samples in `range`, which must lie within the lattice. ValueBounds::hasValueEverywhere is
    /// false if one of these samples may be missing.
    ValueBounds boundsOf(const SampleIndexRange& range) const;

    /// Returns the statistics of all samples if the constructor has read them, else of a selection of samples.
    const SampleStatistics& statistics() const { return statistics_; }

    /// Returns the memory used, in bytes. If the constructor has not read the samples, the result includes the maximum
    /// size of the cache.
    std::size_t memoryBytes() const;

  private:
    using BrickIndex = std::array<std::size_t, 4>;  // the indices of a brick in its level, along x, y, z, w

    // A level of the pyramid. `entries` are the packed bounds of the bricks of this level; empty unless eager_.
    struct PyramidLevel {
        BrickIndex size;  // the number of bricks along each axis
        std::span<std::uint64_t> entries;
    };

    void computeAllBrickStatistics();
    /// Sets statistics_ to the statistics of a selection of samples, spread evenly over the array. Used for an array
    /// that is too large to be read in full.
    void estimateStatistics();
    void addPyramidLevel();
    std::uint64_t packedStatisticsAt(const PyramidLevel& level, const BrickIndex& brick) const;

    const SampledLattice from_;
    const bool eager_;
    SampleStatistics statistics_;
    std::vector<std::vector<std::uint64_t>> eagerEntries_;
    // A slot of the cache of bricks that were read. The cache needs no locks, after R. Hyatt and T. Mann, "A lockless
    // transposition table implementation for parallel search". `check` is the brick's index XOR its entry. If two
    // threads have written the two members for different bricks, `check` XOR `entry` is practically never the index of
    // the brick that is looked up. Such a slot counts as empty.
    struct CacheSlot {
        std::uint64_t check, entry;
    };
    struct FreeDeleter {
        void operator()(CacheSlot* slots) const { std::free(slots); }  // NOLINT(cppcoreguidelines-no-malloc): of calloc
    };
    std::unique_ptr<CacheSlot[], FreeDeleter>
        slots_;                         // zero-initialized, because the entry 0 means an empty slot; null if eager
    std::size_t slotCount_ = 0;         // the number of slots: a power of 2
    std::vector<PyramidLevel> levels_;  // the levels from fine to coarse; only the finest level unless eager_
};

}  // namespace oval4d::fields
