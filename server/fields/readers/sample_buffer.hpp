#pragma once
// The memory into which readers of files convert samples.

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "errors/error.hpp"
#include "fields/array/sample_storage.hpp"
#include "fields/readers/field_array.hpp"

namespace oval4d::fields {

/// Memory for samples that a reader converts. The memory is FieldReadOptions::into if that has the right size.
/// Otherwise, it is a new file if FieldReadOptions::newFile is set and there are more samples than
/// FieldReadOptions::maxInMemory. Otherwise, it is a vector.
class SampleBuffer {
  public:
    /// Makes a buffer for `count` samples. Errors: those of FieldReadOptions::newFile.
    static Result<SampleBuffer> allocate(std::size_t count, const FieldReadOptions& options);

    std::span<float> values() { return values_; }
    /// Releases the resident pages of the new file, if the samples are in one.
    void releasePages() const;
    /// Returns the samples, which own their memory unless it is FieldReadOptions::into. After the call, this object
    /// must not be used.
    SampleStorage takeSamples();

  private:
    std::span<float> values_;
    std::vector<float> memory_;
    std::shared_ptr<MappedFile> file_;
};

}  // namespace oval4d::fields
