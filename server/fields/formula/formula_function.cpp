#include "fields/formula/formula_function.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "fields/formula/interval.hpp"

namespace oval4d::fields {

namespace {

static_assert(ScalarFunction::kLanes == kKernelLanes);

// One float for each of kKernelLanes points, which are computed at once. Aligned for an AVX2 register.
struct alignas(32) FloatLanes {
    std::array<float, kKernelLanes> values;
};

// Returns memory for at least `size` floats. May return null if `size` is 0. Each thread has its own memory, which the
// next call on the thread reuses.
float* scratchFloats(std::size_t size) {
    thread_local std::vector<FloatLanes> memory;
    const std::size_t lanes = (size + kKernelLanes - 1) / kKernelLanes;
    if (memory.size() < lanes) memory.resize(lanes);
    return memory.empty() ? nullptr : memory.front().values.data();
}

using PaddedPoints = std::array<FloatLanes, 4>;  // the coordinates x, y, z and w of kKernelLanes points
// Returns kKernelLanes points: the points from the index `begin` to the end of the batch, then copies of the last
// point. The batch must have fewer than kKernelLanes points from `begin` on.
PaddedPoints paddedPoints(const PointBatch& points, std::size_t begin) {
    PaddedPoints result;
    const std::array<std::span<const float>, 4> coordinates{points.x, points.y, points.z, points.w};
    for (std::size_t axis = 0; axis < 4; ++axis) {
        for (std::size_t lane = 0; lane < kKernelLanes; ++lane)
            result[axis].values[lane] = coordinates[axis][std::min(begin + lane, points.size() - 1)];
    }
    return result;
}

}  // namespace

FormulaFunction::FormulaFunction(Formula formula, const TapeKernels& kernels)
    : formula_(std::move(formula)), kernels_(kernels) {}

void FormulaFunction::evaluate(const PointBatch& points, std::span<float> values) const {
    const auto& [instructions, registers] = formula_.tape();
    float* memory = scratchFloats(registers * kBlockPoints);
    const std::size_t whole = points.size() / kKernelLanes * kKernelLanes;
    for (std::size_t i = 0; i < whole; i += kBlockPoints) {
        const PointBlock block{{points.x.data() + i, points.y.data() + i, points.z.data() + i, points.w.data() + i},
                               values.data() + i,
                               memory,
                               std::min(kBlockPoints, whole - i)};
        kernels_.evaluate(instructions.data(), instructions.size(), block);
    }
    if (whole == points.size()) return;
    const auto [x, y, z, w] = paddedPoints(points, whole);
    FloatLanes result;
    const PointBlock block{{x.values.data(), y.values.data(), z.values.data(), w.values.data()},
                           result.values.data(),
                           memory,
                           kKernelLanes};
    kernels_.evaluate(instructions.data(), instructions.size(), block);
    std::copy_n(result.values.begin(), points.size() - whole, values.begin() + static_cast<std::ptrdiff_t>(whole));
}

void FormulaFunction::evaluateWithGradient(const PointBatch& points, std::span<float> values,
                                           const GradientBatch& gradients) const {
    const auto& [instructions, registers] = formula_.tape();
    float* memory = scratchFloats(registers * 5 * kGradientBlockPoints);
    const std::size_t whole = points.size() / kKernelLanes * kKernelLanes;
    for (std::size_t i = 0; i < whole; i += kGradientBlockPoints) {
        const GradientBlock block{
            {points.x.data() + i, points.y.data() + i, points.z.data() + i, points.w.data() + i},
            values.data() + i,
            {gradients.x.data() + i, gradients.y.data() + i, gradients.z.data() + i, gradients.w.data() + i},
            memory,
            std::min(kGradientBlockPoints, whole - i)};
        kernels_.differentiate(instructions.data(), instructions.size(), block);
    }
    if (whole == points.size()) return;
    const auto [x, y, z, w] = paddedPoints(points, whole);
    std::array<FloatLanes, 5> results;  // the value and the gradient
    const GradientBlock block{
        {x.values.data(), y.values.data(), z.values.data(), w.values.data()},
        results[0].values.data(),
        {results[1].values.data(), results[2].values.data(), results[3].values.data(), results[4].values.data()},
        memory,
        kKernelLanes};
    kernels_.differentiate(instructions.data(), instructions.size(), block);
    const std::array<std::span<float>, 5> out{values, gradients.x, gradients.y, gradients.z, gradients.w};
    for (std::size_t i = 0; i < out.size(); ++i) {
        std::copy_n(results[i].values.begin(), points.size() - whole,
                    out[i].begin() + static_cast<std::ptrdiff_t>(whole));
    }
}

namespace {

// Returns the estimated time of an operation at one point, in nanoseconds.
double nanosecondsOf(Operation operation) {
    switch (operation) {
        case Operation::power:
        case Operation::tan:
        case Operation::cbrt:
        case Operation::asin:
        case Operation::acos:
        case Operation::atan2:
        case Operation::sinh:
        case Operation::cosh:
        case Operation::tanh:
        case Operation::mod:
            return 3;
        case Operation::exp:
        case Operation::log:
        case Operation::sin:
        case Operation::cos:
        case Operation::atan:
        case Operation::integer_power:
            return 0.7;
        default:
            return 0.15;
    }
}

}  // namespace

ValueBounds FormulaFunction::boundsIn(const Box& region) const {
    const auto& [instructions, registers] = formula_.tape();
    thread_local std::vector<ValueBounds> intervals;
    if (intervals.size() < Tape::kFirstScratch + registers) intervals.resize(Tape::kFirstScratch + registers);
    for (int axis = 0; axis < 4; ++axis)
        intervals[static_cast<std::size_t>(axis)] = intervalOfCoordinate(region.min[axis], region.max[axis]);
    for (const Instruction& next : instructions) {
        using OperandForm = Instruction::OperandForm;
        const ValueBounds number = next.form != OperandForm::two_registers || next.operation == Operation::constant
                                       ? intervalOf(next.number)
                                       : ValueBounds{};
        const bool isFirst = next.operation == Operation::constant || next.form == OperandForm::number_and_register;
        const ValueBounds& a = isFirst ? number : intervals[next.a];
        const ValueBounds& b = next.form == OperandForm::register_and_number ? number : intervals[next.b];
        const int exponent = next.operation == Operation::integer_power ? static_cast<int>(next.number) : 0;
        const ValueBounds result = intervalOf(next.operation, a, b, exponent);
        // It is faster to copy the members one by one than by a vector instruction: see fields/CMakeLists.txt.
        intervals[next.result].min = result.min;
        intervals[next.result].max = result.max;
        intervals[next.result].hasValueEverywhere = result.hasValueEverywhere;
    }
    return intervals[Tape::kResult];
}

EvaluationCost FormulaFunction::cost() const {
    EvaluationCost cost{0.2, 1, 50};
    for (const Instruction& next : formula_.tape().instructions) {
        cost.value += nanosecondsOf(next.operation);
        cost.bounds += 25;
    }
    cost.gradient += 4 * cost.value;
    return cost;
}

std::size_t FormulaFunction::memoryBytes() const { return sizeof(*this) - sizeof(formula_) + formula_.memoryBytes(); }

}  // namespace oval4d::fields
