#include "fields/readers/field_array.hpp"

#include <stdexcept>

namespace oval4d::fields {

Result<std::shared_ptr<const ArrayFunction>> FieldArray::function() const {
    try {
        return std::shared_ptr<const ArrayFunction>(std::make_shared<ArrayFunction>(shape, box, samples));
    } catch (const std::invalid_argument& fault) {
        return Error{ErrorCode::bad_field, fault.what()};
    }
}

}  // namespace oval4d::fields
