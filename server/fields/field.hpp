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

/// A second function on the box of a field, such as the pressure for a field of vorticity. Its values can color the
/// surfaces of the field.
struct SecondFunction {
    std::shared_ptr<const ScalarFunction> function;
    std::string formula = {};                         ///< the text of the formula; empty if the function is an array
    std::shared_ptr<const ArrayFunction> array = {};  ///< `function` if it is an array; else null
    std::string variable = {};                        ///< the name of the array in its file; empty if it has none
    Quantity quantity = {};                           ///< what the values of the array measure
};

/// The origin of the samples of a field that are too large for memory or a part of an array: a file in the server's
/// data folder, and the options with which this file is read. The members are explained at the members of
/// session::LoadObject with the same names.
struct FileSource {
    std::string dataName, format, axes, variable, secondFormula, secondVariable;
    std::optional<Box> box, region;
};
void visitStoredMembers(serialization::ReadOrWritten<FileSource> auto& source, auto& visit) {
    auto& [dataName, format, axes, variable, secondFormula, secondVariable, box, region] = source;
    visit.member(0, dataName);
    visit.member(1, format);
    visit.member(2, axes);
    visit.member(3, variable);
    visit.member(4, secondFormula);
    visit.member(5, secondVariable);
    visit.member(6, box);
    visit.addedMember(7, region);
}

/// A 4-D scalar field: a function on a box. It is shown as a 4-D object that is centered at the origin: the point p of
/// the object has the function's coordinates center + toFunction · p. Made by makeField() or transformedTo();
/// setSecondFunction() can add a second function. What is stored of a field: see FieldDefinition.
struct Field : geometry::ObjectInfo {
    std::shared_ptr<const ScalarFunction> function;
    Box box;               ///< the domain, in the function's coordinates
    glm::dvec4 center{0};  ///< the center of the box, in the function's coordinates
    glm::dmat4 toFunction{1};
    std::shared_ptr<const polytopes::Polytope> domain;  ///< the box as a polytope, in the object's coordinates; if
                                                        ///< isTransformed, a parallelepiped
    bool isTransformed = false;                  ///< whether transformedTo() made this field, which then shares the
                                                 ///< functions of the original
    double initialLevel = 0;                     ///< the only level that is shown at first
    Inside initialInside = Inside::below;        ///< which side of the levels is inside at first
    std::string formula;                         ///< the text of the formula; empty if there is none
    std::shared_ptr<const ArrayFunction> array;  ///< `function` if it is an array; else null
    AxisUnits units;        ///< of `box` and `center`, if the function is an array (see quantityText())
    Quantity quantity;      ///< what the values measure, if the function is an array (see quantityText())
    bool isPart = false;    ///< whether the file of the array has further samples (see FieldArray)
    ImageLevel imageLevel;  ///< of the array (see FieldArray)
    std::shared_ptr<const SecondFunction> second;  ///< null if there is none
    /// The range, without outliers, of the values of coloringFunction() on the box.
    std::shared_ptr<const TypicalRangeOnBox> coloringRange;
    bool shared = false;                       ///< whether several sessions share this field; the limits on the memory
                                               ///< of sessions then do not count it
    std::shared_ptr<const FileSource> source;  ///< null unless the samples are too large for memory or a part of an
                                               ///< array in the data folder

    /// Returns whether the samples of the field or of its second array are in a mapped file of which a part could not
    /// be read, or which has changed (see MappedFile::isLost()).
    bool isLost() const;
    /// Throws std::runtime_error if isLost(): values that were read may be wrong.
    void requireReadable() const;

    /// Returns the function whose values color the surfaces if the coloring is scene::Coloring::value: the second
    /// function, or the function itself if there is no second one.
    const std::shared_ptr<const ScalarFunction>& coloringFunction() const {
        return second == nullptr ? function : second->function;
    }
};

/// Makes a field from a function and its domain. For each axis, `scale` is the length, in the object, of one unit of
/// the function's coordinate; it must be greater than 0. Throws std::invalid_argument with the reason if the box is not
/// within ±1e30, or if its extent along an axis is 0 or too small for 32-bit floats.
Field makeField(std::string name, std::shared_ptr<const ScalarFunction> function, const Box& box,
                const glm::dvec4& scale = glm::dvec4(1));

/// Sets the second function of the field. Both functions use the same coordinates.
void setSecondFunction(Field& field, SecondFunction second);

/// Returns a copy of a field that `change` has changed, with a serial number of its own. The copy has the same
/// functions. It keeps the original alive, so that the owner of the original can tell from its use count whether the
/// functions are in use.
std::shared_ptr<const Field> changedCopy(std::shared_ptr<const Field> original,
                                         const std::function<void(Field&)>& change);

/// Returns the field as a 4-D object in the frame of reference `frame`, with the serial number `serial`. The result has
/// the same functions on the same box as `field`. The map frame.matrix() is applied to the points of the 4-D object, so
/// `toFunction`, `domain` and `circumradius` change.
Field transformedTo(const Field& field, const geometry::ReferenceFrame& frame, std::uint64_t serial);

}  // namespace oval4d::fields
