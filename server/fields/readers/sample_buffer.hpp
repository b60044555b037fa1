#pragma once
// Where readers put the samples that they convert.

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "errors/error.hpp"
#include "fields/array/sample_storage.hpp"
#include "fields/readers/field_array.hpp"

namespace oval4d::fields {

/// Memory for samples, of the first kind that applies: FieldReadOptions::into, if it has the right size; a new file, if
/// FieldReadOptions::newFile is set and there are more samples than FieldReadOptions::maxInMemory; a vector.
class SampleBuffer {
  public:
    /// Errors: those of FieldReadOptions::newFile.
    static Result<SampleBuffer> of(std::size_t count, const FieldReadOptions& options);

    std::span<float> values() { return values_; }
    /// Releases the resident pages of the file, if there is one.
    void releasePages() const;
    /// Returns the samples, which own their memory unless it is FieldReadOptions::into. This object must not be used
    /// afterward.
    SampleStorage take();

  private:
    std::span<float> values_;
    std::vector<float> memory_;
    std::shared_ptr<MappedFile> file_;
};

}  // namespace oval4d::fields
