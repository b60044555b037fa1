#pragma once
// Makes levels of a multiscale image, for tests.

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "fields/array_field.hpp"
#include "slicing/object.hpp"

namespace oval4d::net {

/// Returns one of the three levels of an image called "run" from the entry "image" of the data folder. `finer` is
/// MultiscaleImageLevel::finer. The samples are from 0 to 6.
inline slicing::FieldPtr levelOfImage(std::uint32_t level, std::uint32_t finer) {
    fields::FieldArray array;
    array.shape = {2, 2, 2, 2};
    array.box = {glm::dvec4(0), glm::dvec4(7)};
    std::vector<float> values(16);
    values.back() = 6;
    array.samples = fields::SampleStorage(std::move(values));
    array.imageLevel = {level, 3, finer};
    array.isPart = level > 0;
    fields::Field field = *fields::fieldFromArray("run", array);
    field.source =
        std::make_shared<const fields::FieldFileSource>(fields::FieldFileSource{"image", "", "", "", "", "", {}, {}});
    return std::make_shared<const fields::Field>(std::move(field));
}

}  // namespace oval4d::net
