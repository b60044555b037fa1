#include "fields/array/sample_storage.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <mutex>
#include <stdexcept>
#include <utility>

namespace oval4d::fields {

/// Memory that results of SampleStorage::withAppended() share. Each result begins with the samples of the result that
/// it extends. A result reads only its own samples, so another thread may append samples at the same time.
struct SampleStorage::SharedGrowthBuffer {
    std::mutex mutex;
    std::vector<float> values;  // guarded by mutex; never reallocated, because results refer to it
};

SampleStorage SampleStorage::withAppended(std::span<const float> others) const {
    const std::size_t count = values_.size() + others.size();
    if (growthBuffer_) {
        const std::lock_guard lock(growthBuffer_->mutex);
        std::vector<float>& values = growthBuffer_->values;
        if (values.size() == values_.size() && count <= values.capacity()) {
            values.insert(values.end(), others.begin(), others.end());
            SampleStorage grown(growthBuffer_, {values.data(), count});
            grown.growthBuffer_ = growthBuffer_;
            return grown;
        }
    }
    auto buffer = std::make_shared<SharedGrowthBuffer>();
    buffer->values.reserve(count + count / 2);
    buffer->values.assign(values_.begin(), values_.end());
    buffer->values.insert(buffer->values.end(), others.begin(), others.end());
    SampleStorage grown(buffer, buffer->values);
    grown.growthBuffer_ = std::move(buffer);
    return grown;
}

SampleStorage::SampleStorage(std::vector<float> values) {
    auto owned = std::make_shared<const std::vector<float>>(std::move(values));
    values_ = *owned;
    owner_ = std::move(owned);
}

SampleStorage::SampleStorage(std::shared_ptr<const void> owner, std::span<const float> values)
    : owner_(std::move(owner)), values_(values) {}

SampleStorage::SampleStorage(MappedFilePtr file, std::size_t offset, std::size_t count)
    : owner_(file), file_(std::move(file)) {
    const std::span<const std::byte> bytes = file_->bytes();
    if (offset % sizeof(float) != 0 || offset > bytes.size() || (bytes.size() - offset) / sizeof(float) < count)
        throw std::invalid_argument("the samples are not within the file");
    values_ = {reinterpret_cast<const float*>(bytes.data() + offset), count};
}

std::size_t SampleStorage::byteOffsetInFile() const {
    return static_cast<std::size_t>(reinterpret_cast<const std::byte*>(values_.data()) - file_->bytes().data());
}

void SampleStorage::adviseKernel(std::size_t first, std::size_t count, int advice) const {
    if (!file_ || count == 0) return;
    static const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    const auto begin = reinterpret_cast<std::uintptr_t>(values_.data() + first) / page * page;
    const auto end = reinterpret_cast<std::uintptr_t>(values_.data() + first + count);
    // The result is ignored, because the advice affects only the speed.
    static_cast<void>(madvise(reinterpret_cast<void*>(begin), end - begin, advice));
}

void SampleStorage::adviseAccessOrder(AccessOrder access) const {
    adviseKernel(0, values_.size(), access == AccessOrder::random ? MADV_RANDOM : MADV_SEQUENTIAL);
}

void SampleStorage::prefetch(std::size_t first, std::size_t count) const { adviseKernel(first, count, MADV_WILLNEED); }

}  // namespace oval4d::fields
