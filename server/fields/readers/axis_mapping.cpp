#include "fields/readers/axis_mapping.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>

#include "fields/readers/sample_buffer.hpp"
#include "text/message_text.hpp"

namespace oval4d::fields {

Result<std::vector<std::size_t>> parseAxes(std::string_view axes, std::size_t dimensions) {
    constexpr std::size_t kAxes = 4;
    if (dimensions == 0 || dimensions > kAxes) {
        return Error{ErrorCode::bad_field, "the array has " + std::to_string(dimensions) +
                                               (dimensions == 1 ? " dimension" : " dimensions") +
                                               "; 1 to 4 are allowed"};
    }
    if (axes.empty()) axes = std::string_view("tzyx").substr(kAxes - dimensions);
    if (axes.size() != dimensions) {
        return Error{ErrorCode::out_of_range, "axes is " + text::inQuotes(axes) + ", but the array has " +
                                                  std::to_string(dimensions) + " dimensions"};
    }
    std::vector<std::size_t> found;
    for (const char name : axes) {
        const std::size_t axis = std::string_view("xyzw").find(name == 't' ? 'w' : name);
        if (axis == std::string_view::npos || std::find(found.begin(), found.end(), axis) != found.end()) {
            return Error{ErrorCode::out_of_range, "axes is " + text::inQuotes(axes) +
                                                      "; it must consist of different letters of x, y, z and w (or t)"};
        }
        found.push_back(axis);
    }
    return found;
}

std::vector<std::size_t> squeezedDimensionIndices(std::span<const std::size_t> sizes) {
    std::vector<std::size_t> kept;
    std::size_t surplus = sizes.size() > 4 ? sizes.size() - 4 : 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        if (surplus > 0 && sizes[i] == 1) {
            --surplus;
        } else {
            kept.push_back(i);
        }
    }
    return kept;
}

Result<AxisMapping> AxisMapping::fromDimensions(std::span<const ArrayDimension> dimensions, std::size_t maxSamples) {
    AxisMapping mapping;
    std::size_t count = 1;
    for (const ArrayDimension& each : dimensions) {
        if (each.size == 0) return Error{ErrorCode::bad_field, "the array is empty"};
        if (each.size > kMaxSamplesPerAxis || each.size > std::min(maxSamples, kMaxSamples) / count) {
            return Error{ErrorCode::too_large, "the array has too many samples: at most " + std::to_string(maxSamples) +
                                                   " are allowed, and 2^24 along an axis"};
        }
        count *= each.size;
        mapping.shape_[each.axis] = each.size;
    }
    std::array<std::size_t, 4> stride{1};
    for (std::size_t i = 1; i < 4; ++i) stride[i] = stride[i - 1] * mapping.shape_[i - 1];
    for (std::size_t i = 0; i < dimensions.size(); ++i) {
        const ArrayDimension& each = dimensions[i];
        const std::size_t at = 4 - dimensions.size() + i;
        const auto step = static_cast<std::ptrdiff_t>(stride[each.axis]);
        mapping.layout_.size[at] = each.size;
        mapping.layout_.stride[at] = each.reversed ? -step : step;
        if (each.reversed) mapping.first_ += stride[each.axis] * (each.size - 1);
    }
    return mapping;
}

bool AxisMapping::isInMemoryOrder() const {
    std::ptrdiff_t expected = 1;
    for (std::size_t i = 4; i-- > 0;) {
        if (layout_.size[i] == 1) continue;
        if (layout_.stride[i] != expected) return false;
        expected *= static_cast<std::ptrdiff_t>(layout_.size[i]);
    }
    return true;
}

std::vector<Slab> AxisMapping::slabs(std::size_t maxCount) const {
    // Each slab has one index along each of the first `divided` dimensions, at most `group` indices along the next
    // dimension, and all indices along the remaining dimensions.
    std::size_t divided = 0, inner = count() / layout_.size[0];
    for (; divided < 3 && inner > maxCount; inner /= layout_.size[divided]) ++divided;
    const std::size_t group = std::clamp<std::size_t>(maxCount / inner, 1, layout_.size[divided]);
    std::vector<Slab> slabs;
    Slab slab{{}, layout_, 0};
    for (std::size_t i = 0; i < divided; ++i) slab.layout.size[i] = 1;
    while (true) {
        slab.layout.size[divided] = std::min(group, layout_.size[divided] - slab.start[divided]);
        slab.first = first_;
        for (std::size_t i = 0; i <= divided; ++i) {
            const auto step = static_cast<std::ptrdiff_t>(slab.start[i]) * layout_.stride[i];
            slab.first = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(slab.first) + step);
        }
        slabs.push_back(slab);
        slab.start[divided] += slab.layout.size[divided];
        std::size_t i = divided;
        for (; slab.start[i] == layout_.size[i]; ++slab.start[--i]) {
            slab.start[i] = 0;
            if (i == 0) return slabs;
        }
    }
}

Result<SampleStorage> AxisMapping::samples(const FileContents& file, std::span<const std::byte> bytes,
                                           const StoredNumberFormat& format, const FieldReadOptions& options) const {
    const bool native = format.bigEndian == (std::endian::native == std::endian::big);
    // Floats in memory must be aligned, but numbers in a file need not be.
    const bool aligned = reinterpret_cast<std::uintptr_t>(bytes.data()) % alignof(float) == 0;
    if (format.type == NumberType::f4 && native && aligned && format.needsNoConversion() && isInMemoryOrder()) {
        if (file.file)
            return SampleStorage(file.file, static_cast<std::size_t>(bytes.data() - file.file->bytes().data()),
                                 count());
        return SampleStorage(file.owner, {reinterpret_cast<const float*>(bytes.data()), count()});
    }
    auto buffer = SampleBuffer::allocate(count(), options);
    if (!buffer) return buffer.error();
    const std::byte* from = bytes.data();
    for (const Slab& slab : slabs(kSlabSize)) {
        convertToFloats(format, from, slab.layout, buffer->values().data() + slab.first);
        const auto& size = slab.layout.size;
        from += size[0] * size[1] * size[2] * size[3] * sizeOf(format.type);
        file.releasePages();
        buffer->releasePages();
    }
    return buffer->takeSamples();
}

Box defaultBox(const Shape& shape, bool time) {
    const auto longest = std::max_element(shape.begin(), time ? shape.end() - 1 : shape.end());
    Box box{glm::dvec4(0), glm::dvec4(0)};
    for (std::size_t i = 0; i < 4; ++i) {
        const double cells = static_cast<double>(*longest - 1);
        const bool alone = time && i == 3;
        if (shape[i] > 1) {
            const double half = alone ? 1 : static_cast<double>(shape[i] - 1) / cells;
            box.min[static_cast<glm::length_t>(i)] = -half;
            box.max[static_cast<glm::length_t>(i)] = half;
        }
    }
    return box;
}

}  // namespace oval4d::fields
