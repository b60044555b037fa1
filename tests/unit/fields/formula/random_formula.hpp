#pragma once
// Helpers for tests: random formulas and points, and the evaluation of formulas at points.

#include <array>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fields/formula/formula_function.hpp"
#include "fields/formula/functions.hpp"

namespace oval4d::fields {

using Random = std::mt19937;

inline double uniform(Random& random, double min, double max) {
    return std::uniform_real_distribution<double>(min, max)(random);
}
inline std::size_t below(Random& random, std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

/// Returns a random formula of all operators and functions, nested to at most `depth` levels. Each operator with its
/// operands is in parentheses.
inline std::string randomFormula(Random& random, int depth) {
    static constexpr auto kLeaves = std::to_array<const char*>(
        {"x", "y", "z", "w", "t", "r", "x", "y", "z", "w", "0", "1", "2", "0.5", "3.7", "pi", "1e-3", "(-1)", "12"});
    static constexpr auto kExponents = std::to_array<const char*>(
        {"2", "3", "4", "5", "-1", "-2", "7", "0.5", "1.5", "(1/3)", "-0.5", "0", "65", "2.5"});
    if (depth == 0) return kLeaves[below(random, kLeaves.size())];
    const auto operand = [&] {
        return randomFormula(random, depth - 1 - static_cast<int>(below(random, 2)) * (depth > 1));
    };
    switch (below(random, 8)) {
        case 0:
            return "(" + operand() + "+" + operand() + ")";
        case 1:
            return "(" + operand() + "-" + operand() + ")";
        case 2:
            return "(" + operand() + "*" + operand() + ")";
        case 3:
            return "(" + operand() + "/" + operand() + ")";
        case 4:
            return "(" + operand() + "^" +
                   (below(random, 4) == 0 ? operand() : kExponents[below(random, kExponents.size())]) + ")";
        case 5:
            return "(-" + operand() + ")";
        default:
            break;
    }
    const BuiltinFunction& function = builtinFunctions()[below(random, builtinFunctions().size())];
    std::string text = std::string(function.name) + "(" + operand();
    const std::size_t count = std::min(function.maxArguments, function.minArguments + below(random, 2));
    for (std::size_t i = 1; i < count; ++i) text += "," + operand();
    return text + ")";
}

/// Points, and the values and gradients of a function at these points.
struct SamplePoints {
    std::array<std::vector<float>, 4> coordinates, gradients;
    std::vector<float> values;

    std::size_t size() const { return coordinates[0].size(); }
    void add(const glm::dvec4& point) {
        for (int axis = 0; axis < 4; ++axis) coordinates[axis].push_back(static_cast<float>(point[axis]));
    }
    void addRandom(Random& random, const Box& box) {
        glm::dvec4 point;
        for (int axis = 0; axis < 4; ++axis) {
            // Often choose the boundary of the box, where faults are most likely.
            const std::size_t choice = below(random, 6);
            const double min = box.min[axis], max = box.max[axis];
            point[axis] = choice == 0 ? min : (choice == 1 ? max : uniform(random, min, max));
        }
        add(point);
    }
    PointBatch batch(std::size_t begin, std::size_t count) const {
        const auto part = [&](const std::vector<float>& axis) { return std::span(axis).subspan(begin, count); };
        return {part(coordinates[0]), part(coordinates[1]), part(coordinates[2]), part(coordinates[3])};
    }
    void evaluate(const ScalarFunction& function) {
        values.assign(size(), -1234);
        function.evaluate(batch(0, size()), values);
    }
    void differentiate(const ScalarFunction& function) {
        values.assign(size(), -1234);
        for (auto& axis : gradients) axis.assign(size(), -1234);
        function.evaluateWithGradient(batch(0, size()), values,
                                      {gradients[0], gradients[1], gradients[2], gradients[3]});
    }
    glm::dvec4 point(std::size_t i) const {
        return {coordinates[0][i], coordinates[1][i], coordinates[2][i], coordinates[3][i]};
    }
    std::string describe(std::size_t i) const {
        std::string text;
        for (const auto& axis : coordinates) text += std::to_string(axis[i]) + " ";
        return text;
    }
};

inline Formula parsed(const std::string& text) {
    auto formula = parseFormula(text);
    if (!formula) throw std::runtime_error(formula.error().message);
    return *formula;
}

inline float valueAt(const ScalarFunction& function, const glm::dvec4& point) {
    SamplePoints samples;
    samples.add(point);
    samples.evaluate(function);
    return samples.values[0];
}

inline float valueAt(const std::string& text, const glm::dvec4& point) {
    return valueAt(FormulaFunction(parsed(text)), point);
}

inline Box randomBox(Random& random, double largest = 4) {
    Box box;
    const double size = std::pow(10, uniform(random, -3, 0.5));
    for (int axis = 0; axis < 4; ++axis) {
        box.min[axis] = uniform(random, -largest, largest);
        if (below(random, 4) == 0) box.min[axis] = std::round(box.min[axis]);
        box.max[axis] = box.min[axis] + (below(random, 6) == 0 ? 0 : uniform(random, 0, size));
    }
    return box;
}

}  // namespace oval4d::fields
