#include "export/formats/writers.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <glm/common.hpp>
#include <glm/gtc/type_precision.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vector_relational.hpp>

#include "export/formats/text.hpp"
#include "export/formats/vtk_xml.hpp"
#include "fields/field.hpp"

namespace oval4d::exports {

namespace {

/// A regular lattice in a slice: the points origin + spacing · (i, j, k), with products by axis. Along each axis, the
/// indices run from 0 to `points` − 1.
struct SliceLattice {
    glm::dvec3 origin{0}, spacing{1};
    glm::ivec3 points{1};

    std::size_t size() const { return static_cast<std::size_t>(points.x) * points.y * points.z; }
};

/// Returns a lattice that fills the bounding box of slice 0, which must not be empty. Neighboring points are at most
/// `step` apart along each axis.
SliceLattice latticeOf(const slicing::SliceSet& slices, double step) {
    glm::dvec3 low = slices.vertices.front(), high = low;
    for (const glm::dvec3& vertex : slices.vertices) {
        low = glm::min(low, vertex);
        high = glm::max(high, vertex);
    }
    SliceLattice lattice;
    lattice.origin = low;
    for (int axis = 0; axis < 3; ++axis) {
        const double size = high[axis] - low[axis];
        const int cells = std::max(1, static_cast<int>(std::ceil(size / step - 1e-9)));
        lattice.points[axis] = size > 0 ? cells + 1 : 1;
        lattice.spacing[axis] = size > 0 ? size / cells : step;
    }
    return lattice;
}

/// Returns the values at the lattice points in the hyperplane at `w`, x fastest. Values outside the domain are NaN.
/// `toFunction` maps coordinates of the rotated object to coordinates of the function, measured from Field::center.
std::vector<float> sampleSlice(const fields::Field& field, const SliceLattice& lattice, const glm::dmat4& toFunction,
                               double w, const ExportBudget& budget) {
    std::vector<float> values(lattice.size());
    const auto row = static_cast<std::size_t>(lattice.points.x);
    std::array<std::vector<float>, 4> at;
    for (auto& coordinates : at) coordinates.resize(row);
    const glm::dvec4 tolerance = 1e-9 * (field.box.max - field.box.min);
    std::vector<bool> isOutside(row);
    float* out = values.data();
    for (int k = 0; k < lattice.points.z; ++k) {
        budget.checkTimeAndStop();
        for (int j = 0; j < lattice.points.y; ++j, out += row) {
            for (std::size_t i = 0; i < row; ++i) {
                const glm::dvec3 p = lattice.origin + lattice.spacing * glm::dvec3(static_cast<double>(i), j, k);
                const glm::dvec4 q = field.center + toFunction * glm::dvec4(p, w);
                isOutside[i] = glm::any(glm::lessThan(q, field.box.min - tolerance)) ||
                               glm::any(glm::greaterThan(q, field.box.max + tolerance));
                for (std::size_t axis = 0; axis < 4; ++axis)
                    at[axis][i] = static_cast<float>(q[static_cast<int>(axis)]);
            }
            field.function->evaluate({at[0], at[1], at[2], at[3]}, std::span(out, row));
            for (std::size_t i = 0; i < row; ++i) {
                if (isOutside[i]) out[i] = std::numeric_limits<float>::quiet_NaN();
            }
        }
        field.function->releasePages();
    }
    return values;
}

}  // namespace

std::string vti(const SceneToWrite& source) {
    // The number of lattice cells along the diameter of the circumscribed sphere.
    constexpr int kCells = 128;
    const slicing::SliceSet& slices = *source.scene.slices;
    const auto refuse = [](std::string message) {
        throw ExportRefused{{ExportRefusal::Cause::no_body, std::move(message)}};
    };
    if (slices.vertices.empty()) {
        refuse("the slice at " + labelOfW(slices.planes, 0) + " is empty: move the focus or turn the field");
    }
    const fields::Field& field = *slicing::fieldIn(source.object);
    const SliceLattice lattice = latticeOf(slices, 2 * field.circumradius / kCells);
    source.budget.checkFileSize(3 * sizeof(float) * lattice.size());  // enough for the values and their Base64 text
    const glm::dmat4 toFunction = field.toFunction * source.orientation.inverse().matrix();
    const std::vector<float> values = sampleSlice(field, lattice, toFunction, slices.planes.w(0), source.budget);

    std::string extent;
    for (int axis = 0; axis < 3; ++axis) extent += (axis > 0 ? " 0 " : "0 ") + std::to_string(lattice.points[axis] - 1);
    std::string attributes = " WholeExtent=\"" + extent + "\" Origin=\"";
    appendDecimal(attributes, lattice.origin);
    attributes += "\" Spacing=\"";
    appendDecimal(attributes, lattice.spacing);
    attributes += "\"";
    std::string elements = "<Piece Extent=\"" + extent + "\">\n<PointData Scalars=\"value\">\n";
    appendVtkArray(elements, "value", 1, std::span<const float>(values), field.quantity);
    elements += "</PointData>\n<CellData></CellData>\n</Piece>\n";
    return vtkFile("ImageData", attributes, elements);
}

}  // namespace oval4d::exports
