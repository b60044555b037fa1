#pragma once
// The loops that evaluate instructions. The loops are templates, so that each source file that includes this header
// compiles them for its own instruction set. The compiler vectorizes these plain loops. "omp simd" tells the compiler
// that an output is the same array as an input, or does not overlap any input.

#include <cstddef>

#include "fields/formula/kernels.hpp"

namespace oval4d::fields {

/// The loops of all operations. `Math` must have static functions unary(operation, out, a, size) for exp, log, sin …,
/// and powerOrAtan2(operation, out, a, b, size).
///
/// `Math` must be a type that only the including source file has, for example in an anonymous namespace. If several
/// files instantiated the same template, the linker would keep one copy (by the one-definition rule), perhaps one with
/// instructions that this processor lacks. For the same reason, nothing here calls inline functions of other headers.
template <typename Math>
class TapeEvaluator {
  public:
    static void evaluate(const Instruction* instructions, std::size_t count, const PointBlock& block) {
        for (const Instruction* next = instructions; next != instructions + count; ++next)
            compute(*next, outputRegister(block, next->result), inputRegister(block, next->a),
                    inputRegister(block, next->b), block.size);
    }

  protected:
    using OperandForm = Instruction::OperandForm;

    struct ArrayOperand {
        const float* data;
        float operator[](std::size_t i) const { return data[i]; }
    };
    struct NumberOperand {
        float value;
        float operator[](std::size_t) const { return value; }
    };

    static constexpr float kNotANumber = __builtin_nanf("");

    static float* outputRegister(const PointBlock& block, unsigned index) {
        return index == Tape::kResult ? block.values : block.scratch + (index - Tape::kFirstScratch) * kBlockPoints;
    }
    static const float* inputRegister(const PointBlock& block, unsigned index) {
        return index < Tape::kResult ? block.coordinates[index] : outputRegister(block, index);
    }

    template <typename F>
    static void map(F f, float* out, const float* a, std::size_t size) {
#pragma omp simd
        for (std::size_t i = 0; i < size; ++i) out[i] = f(a[i]);
    }
    template <typename F, typename A, typename B>
    static void map(F f, float* out, A a, B b, std::size_t size) {
#pragma omp simd
        for (std::size_t i = 0; i < size; ++i) out[i] = f(a[i], b[i]);
    }
    template <typename F>
    static void map(F f, const Instruction& instruction, float* out, const float* a, const float* b, std::size_t size) {
        const NumberOperand number{static_cast<float>(instruction.number)};
        switch (instruction.form) {
            case OperandForm::two_registers:
                return map(f, out, ArrayOperand{a}, ArrayOperand{b}, size);
            case OperandForm::register_and_number:
                return map(f, out, ArrayOperand{a}, number, size);
            case OperandForm::number_and_register:
                return map(f, out, number, ArrayOperand{b}, size);
        }
    }

    static void compute(const Instruction& instruction, float* out, const float* a, const float* b, std::size_t size) {
        switch (instruction.operation) {
            case Operation::constant:
                return map([value = static_cast<float>(instruction.number)](float) { return value; }, out, a, size);
            case Operation::variable:
            case Operation::copy:
                return map([](float x) { return x; }, out, a, size);
            case Operation::negate:
                return map([](float x) { return -x; }, out, a, size);
            case Operation::abs:
                return map([](float x) { return __builtin_fabsf(x); }, out, a, size);
            case Operation::square:
                return map([](float x) { return x * x; }, out, a, size);
            case Operation::integer_power:
                return integerPower(static_cast<int>(instruction.number), out, a, size);
            case Operation::sqrt:
                return map([](float x) { return __builtin_sqrtf(x); }, out, a, size);
            case Operation::step:
                return map([](float x) { return step(x); }, out, a, size);
            case Operation::sign:
                return map([](float x) { return sign(x); }, out, a, size);
            case Operation::floor:
                return map([](float x) { return __builtin_floorf(x); }, out, a, size);
            case Operation::add:
                return map([](float x, float y) { return x + y; }, instruction, out, a, b, size);
            case Operation::subtract:
                return map([](float x, float y) { return x - y; }, instruction, out, a, b, size);
            case Operation::multiply:
                return map([](float x, float y) { return x * y; }, instruction, out, a, b, size);
            case Operation::divide:
                return map([](float x, float y) { return x / y; }, instruction, out, a, b, size);
            case Operation::min:
                return map([](float x, float y) { return choosesFirst(x < y, x) ? x : y; }, instruction, out, a, b,
                           size);
            case Operation::max:
                return map([](float x, float y) { return choosesFirst(x > y, x) ? x : y; }, instruction, out, a, b,
                           size);
            case Operation::mod:
                return map([](float x, float y) { return x - y * __builtin_floorf(x / y); }, instruction, out, a, b,
                           size);
            case Operation::power:
            case Operation::atan2:
                return powerOrAtan2(instruction, out, a, b, size);
            default:
                return Math::unary(instruction.operation, out, a, size);
        }
    }

    // Returns whether the result of min or max is its first operand, `first`. `compared` says whether `first` is the
    // smaller operand (for min) or the larger operand (for max). If `first` is NaN, returns true.
    static bool choosesFirst(bool compared, float first) {
        return static_cast<int>(compared) | static_cast<int>(first != first);
    }
    static float step(float x) { return x != x ? x : (x < 0 ? 0.0F : 1.0F); }
    static float sign(float x) { return x != x ? x : (x < 0 ? -1.0F : (x > 0 ? 1.0F : 0.0F)); }

    // Returns whether `exponent` is n + 1/2 with an integer n from 0 to 8. The power is then computed as aⁿ times the
    // square root of the base a.
    static bool usesHalfIntegerPower(float exponent) {
        return exponent >= 0.5F && exponent <= 8.5F && 2 * exponent == __builtin_floorf(2 * exponent) &&
               exponent != __builtin_floorf(exponent);
    }
    static void halfIntegerPower(float exponent, float* out, const float* a, std::size_t size) {
        float power[kBlockPoints];
        integerPower(static_cast<int>(exponent), power, a, size);
        map([](float x, float y) { return x * __builtin_sqrtf(y); }, out, ArrayOperand{power}, ArrayOperand{a}, size);
    }

    // Computes power or atan2. The result is NaN whenever an operand is NaN, unlike the result of C's pow.
    static void powerOrAtan2(const Instruction& instruction, float* out, const float* a, const float* b,
                             std::size_t size) {
        const auto number = static_cast<float>(instruction.number);
        if (instruction.operation == Operation::power && instruction.form == OperandForm::register_and_number &&
            usesHalfIntegerPower(number))
            return halfIntegerPower(number, out, a, size);
        float numbers[kBlockPoints], results[kBlockPoints];
        if (instruction.form != OperandForm::two_registers) {
            for (std::size_t i = 0; i < size; ++i) numbers[i] = number;
            (instruction.form == OperandForm::register_and_number ? b : a) = numbers;
        }
        Math::powerOrAtan2(instruction.operation, results, a, b, size);
#pragma omp simd
        for (std::size_t i = 0; i < size; ++i) out[i] = a[i] != a[i] || b[i] != b[i] ? kNotANumber : results[i];
    }

    // Returns aⁿ, by repeated squaring.
    template <unsigned n>
    static float integerPower(float a) {
        if constexpr (n == 0) {
            return 1;
        } else if constexpr (n == 1) {
            return a;
        } else {
            const float half = integerPower<n / 2>(a);
            return n % 2 == 0 ? half * half : half * half * a;
        }
    }
    static void integerPower(int exponent, float* out, const float* a, std::size_t size) {
        switch (exponent) {
            case 3:
                return map([](float x) { return integerPower<3>(x); }, out, a, size);
            case 4:
                return map([](float x) { return integerPower<4>(x); }, out, a, size);
            case 5:
                return map([](float x) { return integerPower<5>(x); }, out, a, size);
            case 6:
                return map([](float x) { return integerPower<6>(x); }, out, a, size);
            case 8:
                return map([](float x) { return integerPower<8>(x); }, out, a, size);
            default:
                break;
        }
        // Repeated squaring, from the highest bit of n down.
        float power[kBlockPoints];
        const unsigned n = static_cast<unsigned>(exponent < 0 ? -exponent : exponent);
        map([](float x) { return x; }, power, a, size);
        for (unsigned bit = (1U << (31U - static_cast<unsigned>(__builtin_clz(n | 1U)))) >> 1U; bit != 0; bit >>= 1U) {
            map([](float x) { return x * x; }, power, power, size);
            if ((n & bit) != 0)
                map([](float x, float y) { return x * y; }, power, ArrayOperand{power}, ArrayOperand{a}, size);
        }
        if (n == 0) map([](float) { return 1.0F; }, power, power, size);
        if (exponent < 0) {
            map([](float x) { return 1 / x; }, out, power, size);
        } else {
            map([](float x) { return x; }, out, power, size);
        }
    }
};

}  // namespace oval4d::fields
