// Fuzzes formulas. The first line of the input is the formula; the bytes after it choose a box. A formula is either
// refused with the position of the mistake, or gives a function. The function's values must lie within its bounds, and
// its text must give the same function again.

#include <array>

#include "fields/formula/formula_function.hpp"
#include "fields/formula/kernels_portable.hpp"
#include "support.hpp"

using namespace oval4d;
using fuzz::require;

namespace {

constexpr std::size_t kPoints = 13;  // not a multiple of kLanes
using PointValues = std::array<float, kPoints>;

struct Points {
    std::array<PointValues, 4> coordinates, gradients;
    PointValues values;

    fields::PointBatch batch() const { return {coordinates[0], coordinates[1], coordinates[2], coordinates[3]}; }
};

bool isSame(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// Returns a box, and sets points in it. Among the points are the corners of the box with the least and the greatest
/// coordinates.
fields::Box boxFrom(std::string_view bytes, Points& points) {
    const auto byte = [bytes](std::size_t i) { return i < bytes.size() ? static_cast<signed char>(bytes[i]) : 0; };
    fields::Box box;
    for (int axis = 0; axis < 4; ++axis) {
        const auto start = static_cast<std::size_t>(axis) * 2;
        box.min[axis] = byte(start) / 16.0;
        box.max[axis] = box.min[axis] + (byte(start + 1) + 128) / 128.0;
        for (std::size_t i = 0; i < kPoints; ++i) {
            const double along = static_cast<double>((i * (2 * start + 1)) % kPoints) / (kPoints - 1);
            points.coordinates[static_cast<std::size_t>(axis)][i] =
                static_cast<float>(box.min[axis] + along * (box.max[axis] - box.min[axis]));
        }
    }
    return box;
}

void requireMistake(std::string_view text, const fields::FormulaMistake& mistake, const Error& error) {
    const auto startsCharacter = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
    const auto characters = static_cast<std::size_t>(std::count_if(text.begin(), text.end(), startsCharacter));
    require(mistake.position >= 1 && mistake.position <= characters + 1, "a mistake is in the text:", mistake.what);
    require(error.code == ErrorCode::bad_expression, "a mistake is a bad expression");
    fuzz::requireSentence(error);
}

void requireWithinBounds(const fields::Formula& formula, const fields::TapeKernels& kernels, const fields::Box& box,
                         Points& points) {
    const fields::FormulaFunction function(formula, kernels);
    const fields::ValueBounds bounds = function.boundsIn(box);
    auto& [x, y, z, w] = points.gradients;
    function.evaluateWithGradient(points.batch(), points.values, {x, y, z, w});
    const PointValues values = points.values;
    function.evaluate(points.batch(), points.values);
    for (std::size_t i = 0; i < kPoints; ++i) {
        const float value = points.values[i];
        require(isSame(value, values[i]),
                "a value does not depend on whether the gradient is computed:", formula.text());
        require(std::isnan(value) ? !bounds.hasValueEverywhere : bounds.min <= value && value <= bounds.max,
                "a value is within the bounds:", formula.text());
        for (const PointValues& gradient : points.gradients)
            require(std::isfinite(gradient[i]), "a gradient is finite:", formula.text());
    }
}

}  // namespace

OVAL4D_FUZZER(formula) {
    std::string_view rest = fuzz::textOf(data, size);
    const std::string_view text = fuzz::takeUntil(rest, '\n');
    fields::FormulaMistake mistake;
    const auto formula = fields::parseFormula(text, &mistake);
    if (!formula) {
        requireMistake(text, mistake, formula.error());
        return 0;
    }
    Points points;
    const fields::Box box = boxFrom(rest, points);
    requireWithinBounds(*formula, fields::portableKernels(), box, points);
    requireWithinBounds(*formula, fields::fastestKernels(), box, points);
    const PointValues values = points.values;

    const auto again = fields::parseFormula(formula->text());
    require(static_cast<bool>(again), "a formula's text is a formula:", formula->text());
    require(again->text() == formula->text() && again->constants() == formula->constants(),
            "a formula's text is canonical:", formula->text() + " " + again->text());
    fields::FormulaFunction(*again).evaluate(points.batch(), points.values);
    for (std::size_t i = 0; i < kPoints; ++i)
        require(isSame(points.values[i], values[i]), "a formula's text means the same function:", formula->text());

    if (formula->constants().empty()) return 0;
    const fields::FormulaConstant changed{formula->constants()[0].name, box.min.x};
    const auto other = formula->withConstants(std::span(&changed, 1));
    if (!other) {
        fuzz::requireSentence(other.error());
    } else {
        requireWithinBounds(*other, fields::fastestKernels(), box, points);
    }
    return 0;
}
