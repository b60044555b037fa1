#include "fields/readers/sample_buffer.hpp"

#include <utility>

namespace oval4d::fields {

Result<SampleBuffer> SampleBuffer::allocate(std::size_t count, const FieldReadOptions& options) {
    SampleBuffer buffer;
    if (options.into.size() == count) {
        buffer.values_ = options.into;
    } else if (count <= options.maxInMemory || !options.newFile) {
        buffer.memory_.resize(count);
        buffer.values_ = buffer.memory_;
    } else {
        auto file = options.newFile(count * sizeof(float));
        if (!file) return file.error();
        buffer.file_ = std::move(*file);
        buffer.values_ = {reinterpret_cast<float*>(buffer.file_->writableBytes().data()), count};
    }
    return buffer;
}

void SampleBuffer::releasePages() const {
    if (file_) file_->releasePages();
}

SampleStorage SampleBuffer::takeSamples() {
    if (file_) return {std::move(file_), 0, values_.size()};
    if (!memory_.empty()) return SampleStorage(std::move(memory_));
    return {nullptr, values_};
}

}  // namespace oval4d::fields
