#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "fields/image_level.hpp"
#include "fields/inside.hpp"
#include "fields/quantity.hpp"
#include "fields/scalar_function.hpp"
#include "fields/value_range.hpp"
#include "geometry/object_info.hpp"
#include "geometry/reference_frame.hpp"
#include "serialization/stored_members.hpp"

namespace oval4d::polytopes {
struct Polytope;
}

namespace oval4d::fields {

class ArrayFunction;

/// A second function on the box of a field, whose values can color the surfaces of the field: for example, the pressure
/// in a field of vorticity.
struct SecondFunction {
    std::shared_ptr<const ScalarFunction> function;
    std::string formula = {};                         ///< the text of the formula; empty if the function is an array
    std::shared_ptr<const ArrayFunction> array = {};  ///< the same as `function` if the function is an array; else null
    std::string variable = {};                        ///< the name of the array in its file; empty if it has none
    Quantity quantity = {};                           ///< what the values of the array measure
};

/// A file in the server's data folder, and the options for reading it. A field has a FieldFileSource if its samples are
/// too large for memory or a part of a larger array. session::LoadObject describes the members with the same names.
struct FieldFileSource {
    std::string dataName, format, axes, variable, secondFormula, secondVariable;
    std::optional<Box> box, region;
};
void visitStoredMembers(serialization::ReadOrWritten<FieldFileSource> auto& source, auto& visit) {
    auto& [dataName, format, axes, variable, secondFormula, secondVariable, box, region] = source;
    visit.member(0, dataName);
    visit.member(1, format);
    visit.member(2, axes);
    visit.member(3, variable);
    visit.member(4, secondFormula);
    visit.member(5, secondVariable);
    visit.member(6, box);
    visit.memberAddedLater(7, region);
}

/// A 4-D scalar field: a function on a box. The box is shown as a 4-D object centered at the origin: the point p of the
/// object has the coordinates center + toFunction · p in the function. makeField() and transformedTo() make fields;
/// setSecondFunction() can add a second function. FieldDefinition contains the parts of a field that are stored.
struct Field : geometry::ObjectInfo {
    std::shared_ptr<const ScalarFunction> function;
    Box box;               ///< the domain, in the function's coordinates
    glm::dvec4 center{0};  ///< the center of the box, in the function's coordinates
    glm::dmat4 toFunction{1};
    std::shared_ptr<const polytopes::Polytope> domain;  ///< the box as a polytope, in the object's coordinates; a
                                                        ///< parallelepiped if isTransformed
    bool isTransformed = false;                         ///< whether transformedTo() made this field from another field,
                                                        ///< with the same functions
    double initialLevel = 0;                            ///< the level (value) that is shown at first
    BodySide initialInside = BodySide::below;           ///< which side of the levels is inside the body at first
    std::string formula;                                ///< the text of the formula; empty if there is none
    std::shared_ptr<const ArrayFunction> array;  ///< the same as `function` if the function is an array; else null
    AxisUnits units;                             ///< the units of `box` and `center`; only for arrays (see
                                                 ///< sanitizeQuantityText())
    Quantity quantity;                ///< what the values measure; only for arrays (see sanitizeQuantityText())
    bool isPart = false;              ///< whether the file of the array has more samples (see FieldArray)
    MultiscaleImageLevel imageLevel;  ///< which level of a multiscale image the array is (see FieldArray)
    std::shared_ptr<const SecondFunction> second;  ///< the second function; null if there is none
    /// The range, without outliers, of the values of coloringFunction() on the box.
    std::shared_ptr<const TypicalRangeOnBox> coloringRange;
    bool shared = false;  ///< whether several sessions share this field, so that the limits on the
                          ///< memory of sessions do not count it
    std::shared_ptr<const FieldFileSource> source;  ///< the file in the data folder if the samples are too large for
                                                    ///< memory or a part of a larger array; else null

    /// Returns whether samples are lost: whether the array or the second array is in a mapped file of which a part
    /// could not be read, or which has changed (see MappedFile::isLost()).
    bool hasLostSamples() const;
    /// Throws std::runtime_error if hasLostSamples(), because values that were read may be wrong.
    void requireReadable() const;

    /// Returns the function whose values color the surfaces with scene::Coloring::value. The result is the second
    /// function or, if there is none, the first function.
    const std::shared_ptr<const ScalarFunction>& coloringFunction() const {
        return second == nullptr ? function : second->function;
    }
};

/// Makes a field from a function and its domain. For each axis, one unit of the function's coordinate has the length
/// `scale` in the 4-D object; `scale` must be greater than 0. Throws std::invalid_argument with the reason if the box
/// is not within ±1e30, or if its extent along an axis is 0 or too small for 32-bit floats.
Field makeField(std::string name, std::shared_ptr<const ScalarFunction> function, const Box& box,
                const glm::dvec4& scale = glm::dvec4(1));

/// Sets the second function of the field to `second`, which must use the same coordinates as the first function.
void setSecondFunction(Field& field, SecondFunction second);

/// Returns a copy of a field, with a new serial number, to which `change` has been applied. The copy has the same
/// functions as the original, and keeps the original alive. So an owner of the original sees from its use count whether
/// the functions are in use.
std::shared_ptr<const Field> changedCopy(std::shared_ptr<const Field> original,
                                         const std::function<void(Field&)>& change);

/// Returns the field as a 4-D object in the frame of reference `frame`, with the serial number `serial`. The functions
/// and the box do not change. frame.matrix() maps the points of the 4-D object, so `toFunction`, `domain` and
/// `circumradius` change.
Field transformedTo(const Field& field, const geometry::ReferenceFrame& frame, std::uint64_t serial);

}  // namespace oval4d::fields
