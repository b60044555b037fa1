#include "fields/field.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "fields/array/array_function.hpp"
#include "polytopes/polytope.hpp"

namespace oval4d::fields {

namespace {

/// Builds the box from −half to +half as a polytope. Bit a of a vertex's index is set if its coordinate a is positive.
polytopes::Polytope makeBoxPolytope(const std::string& name, const glm::dvec4& half) {
    std::vector<glm::dvec4> vertices;
    for (unsigned v = 0; v < 16; ++v) {
        glm::dvec4 vertex = half;
        for (unsigned axis = 0; axis < 4; ++axis) {
            if ((v >> axis & 1U) == 0) vertex[static_cast<int>(axis)] *= -1;
        }
        vertices.push_back(vertex);
    }
    geometry::JaggedArray faces, cells;
    std::vector<std::vector<std::uint32_t>> facesOfCell(8);  // cell 2a + s lies at the lower (s = 0) or upper end of
                                                             // axis a
    for (unsigned a = 0; a < 4; ++a) {
        for (unsigned b = a + 1; b < 4; ++b) {
            for (unsigned rest = 0; rest < 16; ++rest) {
                const unsigned u = 1U << a, v = 1U << b;
                if ((rest & (u | v)) != 0) continue;
                const auto face = static_cast<std::uint32_t>(faces.size());
                faces.add(std::vector<std::uint32_t>{rest, rest | u, rest | u | v, rest | v});
                for (unsigned axis = 0; axis < 4; ++axis) {
                    if (axis != a && axis != b) facesOfCell[2 * axis + (rest >> axis & 1U)].push_back(face);
                }
            }
        }
    }
    for (const auto& cell : facesOfCell) cells.add(cell);
    return polytopes::makePolytope(name, std::move(vertices), std::move(faces), std::move(cells));
}

}  // namespace

Field makeField(std::string name, std::shared_ptr<const ScalarFunction> function, const Box& box,
                const glm::dvec4& scale) {
    const glm::dvec4 half = 0.5 * scale * (box.max - box.min);
    for (int axis = 0; axis < 4; ++axis) {
        constexpr double kFarthest = 1e30, kMinSize = 1e-30, kMinRelativeSize = 2e-5;
        const double farthest = std::max(std::abs(box.min[axis]), std::abs(box.max[axis]));
        if (!(farthest <= kFarthest) || !std::isfinite(half[axis]))
            throw std::invalid_argument("the box must lie within \u22121e30 and 1e30");
        if (half[axis] > 0 && (half[axis] < kMinSize || box.max[axis] - box.min[axis] < kMinRelativeSize * farthest)) {
            throw std::invalid_argument(std::string("the box is too small along ") + "xyzw"[axis] +
                                        " for its distance from 0: functions are evaluated with seven digits");
        }
        if (!(half[axis] > 0)) throw std::invalid_argument(std::string("the box has no extent along ") + "xyzw"[axis]);
    }
    Field field;
    field.function = std::move(function);
    field.coloringRange = std::make_shared<const TypicalRangeOnBox>(field.function, box);
    field.box = box;
    field.center = box.center();
    for (int axis = 0; axis < 4; ++axis) field.toFunction[axis][axis] = 1 / scale[axis];
    field.domain = std::make_shared<const polytopes::Polytope>(makeBoxPolytope(name, half));
    static_cast<geometry::ObjectInfo&>(field) = *field.domain;
    field.name = std::move(name);
    field.serial = geometry::nextSerial();
    return field;
}

bool Field::hasLostSamples() const {
    const auto lost = [](const ArrayFunction* each) {
        return each != nullptr && each->storage().file() && each->storage().file()->isLost();
    };
    return lost(array.get()) || (second && lost(second->array.get()));
}

void Field::requireReadable() const {
    if (hasLostSamples()) throw std::runtime_error("the file of the field can no longer be read");
}

void setSecondFunction(Field& field, SecondFunction second) {
    field.second = std::make_shared<const SecondFunction>(std::move(second));
    field.coloringRange = std::make_shared<const TypicalRangeOnBox>(field.second->function, field.box);
}

std::shared_ptr<const Field> changedCopy(std::shared_ptr<const Field> original,
                                         const std::function<void(Field&)>& change) {
    struct CopyAndOriginal {
        Field copy;
        std::shared_ptr<const Field> original;
    };
    auto both = std::make_shared<CopyAndOriginal>(CopyAndOriginal{*original, std::move(original)});
    both->copy.serial = geometry::nextSerial();
    change(both->copy);
    const Field* const copy = &both->copy;
    return {std::move(both), copy};
}

Field transformedTo(const Field& field, const geometry::ReferenceFrame& frame, std::uint64_t serial) {
    Field image = field;
    image.serial = serial;
    image.isTransformed = true;
    image.toFunction = field.toFunction * frame.inverse();
    image.domain = std::make_shared<const polytopes::Polytope>(
        polytopes::transformedTo(*field.domain, frame, geometry::nextSerial()));
    image.circumradius = image.domain->circumradius;
    return image;
}

}  // namespace oval4d::fields
