#pragma once
// The storage of the samples of an array.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fields/array/mapped_file.hpp"

namespace oval4d::fields {

/// The samples of an array: 32-bit floats in memory or in a mapped file. The samples do not change. Copies of a
/// SampleStorage share the samples.
class SampleStorage {
  public:
    /// Takes ownership of samples in memory.
    explicit SampleStorage(std::vector<float> values);
    /// Shares samples in memory that `owner` keeps valid.
    SampleStorage(std::shared_ptr<const void> owner, std::span<const float> values);
    /// Uses `count` samples in a mapped file, from the byte `offset` on. Throws std::invalid_argument if some of these
    /// samples are not in the file, or if `offset` is not a multiple of the size of a sample.
    SampleStorage(MappedFilePtr file, std::size_t offset, std::size_t count);

    std::span<const float> values() const { return values_; }
    /// Returns the memory that the samples use, in bytes. Returns 0 if the samples are in a mapped file, whose pages
    /// the system can drop.
    std::size_t memoryBytes() const { return file_ ? 0 : values_.size_bytes(); }
    /// Returns the mapped file that contains the samples; null if the samples are in memory.
    const MappedFilePtr& file() const { return file_; }
    /// Returns the position of the first sample in the file, in bytes. The samples must be in a mapped file.
    std::size_t byteOffsetInFile() const;

    /// Returns these samples, followed by `others`. Normally, copies all samples into new memory, which has room for
    /// 1.5 times as many samples. However, copies only `others` if an earlier call has returned these samples, if
    /// nothing has been appended to them yet, and if their memory has room for `others`. The result then shares this
    /// memory. Thread-safe.
    SampleStorage withAppended(std::span<const float> others) const;

    /// The order in which samples of a mapped file are going to be read. `random` makes the system read only the pages
    /// that are needed; `sequential` makes it read ahead.
    enum class AccessOrder : std::uint8_t { random, sequential };
    /// Advises the system of the order in which the samples are going to be read. Does nothing for samples in memory.
    void adviseAccessOrder(AccessOrder access) const;
    /// Advises the system that `count` samples from the index `first` on are needed soon. Does nothing for samples in
    /// memory.
    void prefetch(std::size_t first, std::size_t count) const;

  private:
    struct SharedGrowthBuffer;
    void adviseKernel(std::size_t first, std::size_t count, int advice) const;

    std::shared_ptr<const void> owner_;
    std::span<const float> values_;
    MappedFilePtr file_;
    std::shared_ptr<SharedGrowthBuffer> growthBuffer_;  // the memory of the samples if withAppended() made this object;
                                                        // else null
};

}  // namespace oval4d::fields
