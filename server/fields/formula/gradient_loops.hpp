#pragma once
// The loops that compute values and gradients. The loops are templates, for the reasons in the comments of
// value_loops.hpp.

#include <cstddef>

#include "fields/formula/value_loops.hpp"

namespace oval4d::fields {

/// The loops of forward-mode automatic differentiation. A register consists of five arrays: the value, and its
/// derivatives with respect to x, y, z, w. If Instruction::axes says that a derivative is 0 everywhere, its array is
/// not used.
template <typename Math>
class TapeDifferentiator : private TapeEvaluator<Math> {
    using Base = TapeEvaluator<Math>;

  public:
    static constexpr TapeKernels kernels() { return {&Base::evaluate, &differentiate}; }

    static void differentiate(const Instruction* instructions, std::size_t count, const GradientBlock& block) {
        float ones[kGradientBlockPoints];
        for (std::size_t i = 0; i < block.size; ++i) ones[i] = 1;
        for (const Instruction* next = instructions; next != instructions + count; ++next) {
            const float* a = inputRegister(block, next->a);
            const float* b = inputRegister(block, next->b);
            if (next->axes == 0) {
                compute(*next, outputRegister(block, next->result), a, b, block.size);
                continue;
            }
            BlockValuesAndPartials partials;
            computePartials(*next, partials, a, b, block.size);
            for (unsigned axis = 0; axis < 4; ++axis) {
                const bool byA = (next->axesOfA >> axis & 1U) != 0, byB = (next->axesOfB >> axis & 1U) != 0;
                if (!byA && !byB) continue;
                float* out = outputDerivative(block, next->result, axis);
                const float* ofA = inputDerivative(block, ones, next->a, axis);
                const float* ofB = inputDerivative(block, ones, next->b, axis);
                applyChainRule(*next, partials, byA, byB, out, ofA, ofB, block.size);
            }
            map([](float x) { return x; }, outputRegister(block, next->result), partials.value, block.size);
        }
        zeroInvalidGradients(instructions[count - 1], block);
    }

  private:
    using OperandForm = Instruction::OperandForm;
    using Base::choosesFirst;
    using Base::compute;
    using Base::halfIntegerPower;
    using Base::integerPower;
    using Base::map;
    using Base::powerOrAtan2;
    using Base::sign;
    using Base::usesHalfIntegerPower;
    using typename Base::ArrayOperand;
    using typename Base::NumberOperand;

    static float* outputRegister(const GradientBlock& block, unsigned index) {
        return index == Tape::kResult ? block.values
                                      : block.scratch + (index - Tape::kFirstScratch) * 5 * kGradientBlockPoints;
    }
    static const float* inputRegister(const GradientBlock& block, unsigned index) {
        return index < Tape::kResult ? block.coordinates[index] : outputRegister(block, index);
    }
    static float* outputDerivative(const GradientBlock& block, unsigned index, unsigned axis) {
        return index == Tape::kResult ? block.gradients[axis]
                                      : outputRegister(block, index) + (1 + axis) * kGradientBlockPoints;
    }
    // Returns the derivatives of the register `index` along `axis`, which must not be 0 everywhere. For the register of
    // a coordinate, `axis` must be the axis of this coordinate. Its derivative is 1, so the result is then `ones`, an
    // array of ones.
    static const float* inputDerivative(const GradientBlock& block, const float* ones, unsigned index, unsigned axis) {
        return index < Tape::kResult ? ones : outputDerivative(block, index, axis);
    }

    // The values of an operation, and its partial derivatives with respect to its operands.
    struct BlockValuesAndPartials {
        float value[kGradientBlockPoints], byA[kGradientBlockPoints], byB[kGradientBlockPoints];
    };
    struct ValueAndPartials {
        float value, byA, byB;
    };

    // Writes the derivative of the result to `out`, by the chain rule. `ofA` and `ofB` are the derivatives of the
    // operands. `byA` and `byB` say whether these may differ from 0; a derivative that is always 0 is not read. min and
    // max take the derivative of one operand, even if the derivative of the other operand is not finite.
    static void applyChainRule(const Instruction& instruction, const BlockValuesAndPartials& partials, bool byA,
                               bool byB, float* out, const float* ofA, const float* ofB, std::size_t size) {
        const NumberOperand zero{0};
        if (instruction.operation == Operation::min || instruction.operation == Operation::max) {
            const auto choose = [&](auto left, auto right) {
#pragma omp simd
                for (std::size_t i = 0; i < size; ++i) {
                    const float first = left[i], second = right[i];
                    out[i] = partials.byA[i] != 0 ? first : second;
                }
            };
            if (byA && byB) return choose(ArrayOperand{ofA}, ArrayOperand{ofB});
            return byA ? choose(ArrayOperand{ofA}, zero) : choose(zero, ArrayOperand{ofB});
        }
        const auto product = [](float x, float y) { return x * y; };
        if (!byB) return map(product, out, ArrayOperand{partials.byA}, ArrayOperand{ofA}, size);
        if (!byA) return map(product, out, ArrayOperand{partials.byB}, ArrayOperand{ofB}, size);
#pragma omp simd
        for (std::size_t i = 0; i < size; ++i) out[i] = partials.byA[i] * ofA[i] + partials.byB[i] * ofB[i];
    }

    // Sets to 0 the derivatives of the function that the last instruction has not written. Then sets the gradient at a
    // point to 0 if one of its components, or the value at this point, is not finite.
    static void zeroInvalidGradients(const Instruction& last, const GradientBlock& block) {
        for (unsigned axis = 0; axis < 4; ++axis) {
            if ((last.axes >> axis & 1U) == 0)
                map([](float) { return 0.0F; }, block.gradients[axis], block.gradients[axis], block.size);
        }
        float *x = block.gradients[0], *y = block.gradients[1], *z = block.gradients[2], *w = block.gradients[3];
        const float* values = block.values;
#pragma omp simd
        for (std::size_t i = 0; i < block.size; ++i) {
            // 0 · a is 0 if a is finite, otherwise NaN. So `zero` is 0 only if all five numbers are finite.
            const float zero = (0 * values[i] + 0 * x[i]) + (0 * y[i] + 0 * z[i]) + 0 * w[i];
            const bool isFinite = zero == zero;
            x[i] = isFinite ? x[i] : 0;
            y[i] = isFinite ? y[i] : 0;
            z[i] = isFinite ? z[i] : 0;
            w[i] = isFinite ? w[i] : 0;
        }
    }

    template <typename F, typename A, typename B>
    static void setValuesAndPartials(F f, BlockValuesAndPartials& out, A a, B b, std::size_t size) {
#pragma omp simd
        for (std::size_t i = 0; i < size; ++i) {
            const ValueAndPartials partial = f(a[i], b[i]);
            out.value[i] = partial.value;
            out.byA[i] = partial.byA;
            out.byB[i] = partial.byB;
        }
    }
    template <typename F>
    static void setValuesAndPartials(F f, const Instruction& instruction, BlockValuesAndPartials& out, const float* a,
                                     const float* b, std::size_t size) {
        const NumberOperand number{static_cast<float>(instruction.number)};
        switch (instruction.form) {
            case OperandForm::two_registers:
                return setValuesAndPartials(f, out, ArrayOperand{a}, ArrayOperand{b}, size);
            case OperandForm::register_and_number:
                return setValuesAndPartials(f, out, ArrayOperand{a}, number, size);
            case OperandForm::number_and_register:
                return setValuesAndPartials(f, out, number, ArrayOperand{b}, size);
        }
    }
    // Sets out.byA to f(operand, out.value), the partial derivative of an operation with one operand.
    template <typename F>
    static void setPartialByA(F f, BlockValuesAndPartials& out, const float* a, std::size_t size) {
#pragma omp simd
        for (std::size_t i = 0; i < size; ++i) out.byA[i] = f(a[i], out.value[i]);
    }

    static void computePartials(const Instruction& instruction, BlockValuesAndPartials& out, const float* a,
                                const float* b, std::size_t size) {
        switch (instruction.operation) {
            case Operation::add:
                return setValuesAndPartials([](float x, float y) { return ValueAndPartials{x + y, 1, 1}; }, instruction,
                                            out, a, b, size);
            case Operation::subtract:
                return setValuesAndPartials([](float x, float y) { return ValueAndPartials{x - y, 1, -1}; },
                                            instruction, out, a, b, size);
            case Operation::multiply:
                return setValuesAndPartials([](float x, float y) { return ValueAndPartials{x * y, y, x}; }, instruction,
                                            out, a, b, size);
            case Operation::divide:
                return setValuesAndPartials(
                    [](float x, float y) { return ValueAndPartials{x / y, 1 / y, -(x / y) / y}; }, instruction, out, a,
                    b, size);
            case Operation::mod:
                return setValuesAndPartials(
                    [](float x, float y) {
                        const float whole = __builtin_floorf(x / y);
                        return ValueAndPartials{x - y * whole, 1, -whole};
                    },
                    instruction, out, a, b, size);
            case Operation::min:
                return setValuesAndPartials(
                    [](float x, float y) { return chosenOperand(choosesFirst(x < y, x), x, y); }, instruction, out, a,
                    b, size);
            case Operation::max:
                return setValuesAndPartials(
                    [](float x, float y) { return chosenOperand(choosesFirst(x > y, x), x, y); }, instruction, out, a,
                    b, size);
            case Operation::atan2:
                return arctangent2Partials(instruction, out, a, b, size);
            case Operation::power:
                return powerPartials(instruction, out, a, b, size);
            default:
                compute(instruction, out.value, a, b, size);
                return unaryPartials(instruction, out, a, size);
        }
    }
    static ValueAndPartials chosenOperand(bool choosesFirst, float x, float y) {
        return {choosesFirst ? x : y, choosesFirst ? 1.0F : 0.0F, 0};
    }

    static void arctangent2Partials(const Instruction& instruction, BlockValuesAndPartials& out, const float* a,
                                    const float* b, std::size_t size) {
        setValuesAndPartials(
            [](float y, float x) {
                const float squares = x * x + y * y;
                return ValueAndPartials{0, x / squares, -y / squares};
            },
            instruction, out, a, b, size);
        powerOrAtan2(instruction, out.value, a, b, size);
    }

    // Sets the partial derivatives of a^b: ∂/∂a = b a^(b − 1), and ∂/∂b = a^b log a, or 0 for a = 0 and b > 0.
    static void powerPartials(const Instruction& instruction, BlockValuesAndPartials& out, const float* a,
                              const float* b, std::size_t size) {
        if (instruction.axesOfB != 0) {
            setValuesAndPartials([](float x, float) { return ValueAndPartials{0, 0, x}; }, instruction, out, a, b,
                                 size);
            Math::unary(Operation::log, out.byB, out.byB, size);
        }
        powerOrAtan2(instruction, out.value, a, b, size);
        if (instruction.axesOfB != 0) {
#pragma omp simd
            for (std::size_t i = 0; i < size; ++i) out.byB[i] = out.value[i] == 0 ? 0 : out.value[i] * out.byB[i];
        }
        if (instruction.axesOfA == 0) return;
        const auto number = static_cast<float>(instruction.number);
        const bool isConstant = instruction.form == OperandForm::register_and_number;
        if (isConstant && usesHalfIntegerPower(number - 1)) {
            halfIntegerPower(number - 1, out.byA, a, size);
            return map([number](float x) { return number * x; }, out.byA, out.byA, size);
        }
        float exponents[kGradientBlockPoints];
        for (std::size_t i = 0; i < size; ++i) exponents[i] = (isConstant ? number : b[i]) - 1;
        Math::powerOrAtan2(Operation::power, out.byA, a, exponents, size);
        for (std::size_t i = 0; i < size; ++i) out.byA[i] *= isConstant ? number : b[i];
    }

    static void unaryPartials(const Instruction& instruction, BlockValuesAndPartials& out, const float* a,
                              std::size_t size) {
        switch (instruction.operation) {
            case Operation::copy:
                return setPartialByA([](float, float) { return 1.0F; }, out, a, size);
            case Operation::negate:
                return setPartialByA([](float, float) { return -1.0F; }, out, a, size);
            case Operation::abs:
                return setPartialByA([](float x, float) { return sign(x); }, out, a, size);
            case Operation::square:
                return setPartialByA([](float x, float) { return 2 * x; }, out, a, size);
            case Operation::integer_power: {
                const int n = static_cast<int>(instruction.number);
                integerPower(n - 1, out.byA, a, size);
                return map([n](float x) { return static_cast<float>(n) * x; }, out.byA, out.byA, size);
            }
            case Operation::sqrt:
                return setPartialByA([](float, float value) { return 0.5F / value; }, out, a, size);
            case Operation::cbrt:
                return setPartialByA([](float, float value) { return 1 / (3 * value * value); }, out, a, size);
            case Operation::exp:
                return setPartialByA([](float, float value) { return value; }, out, a, size);
            case Operation::log:
                return setPartialByA([](float x, float) { return 1 / x; }, out, a, size);
            case Operation::sin:
                return Math::unary(Operation::cos, out.byA, a, size);
            case Operation::cos:
                Math::unary(Operation::sin, out.byA, a, size);
                return map([](float x) { return -x; }, out.byA, out.byA, size);
            case Operation::tan:
                return setPartialByA([](float, float value) { return 1 + value * value; }, out, a, size);
            case Operation::asin:
                return setPartialByA([](float x, float) { return 1 / __builtin_sqrtf(1 - x * x); }, out, a, size);
            case Operation::acos:
                return setPartialByA([](float x, float) { return -1 / __builtin_sqrtf(1 - x * x); }, out, a, size);
            case Operation::atan:
                return setPartialByA([](float x, float) { return 1 / (1 + x * x); }, out, a, size);
            case Operation::sinh:
                return Math::unary(Operation::cosh, out.byA, a, size);
            case Operation::cosh:
                return Math::unary(Operation::sinh, out.byA, a, size);
            case Operation::tanh:
                return setPartialByA([](float, float value) { return 1 - value * value; }, out, a, size);
            default:
                return setPartialByA([](float, float) { return 0.0F; }, out, a, size);
        }
    }
};

}  // namespace oval4d::fields
