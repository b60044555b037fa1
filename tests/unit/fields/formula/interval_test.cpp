#include "fields/formula/interval.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "fields/formula/kernels_avx2.hpp"
#include "fields/formula/kernels_portable.hpp"
#include "unit/fields/formula/random_formula.hpp"

namespace oval4d::fields {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

ValueBounds boundsOfFormula(const std::string& text, const Box& box) {
    return FormulaFunction(parsed(text)).boundsIn(box);
}
ValueBounds boundsOfFormula(const std::string& text, double min, double max) {
    return boundsOfFormula(text, {{min, min, min, min}, {max, max, max, max}});
}

// Returns the value of a tape at a point, in double precision.
double realValue(const Tape& tape, const glm::dvec4& point) {
    std::vector<double> registers(Tape::kFirstScratch + tape.scratchRegisters);
    for (int axis = 0; axis < 4; ++axis) registers[static_cast<std::size_t>(axis)] = point[axis];
    for (const Instruction& next : tape.instructions) {
        using OperandForm = Instruction::OperandForm;
        double a = registers[next.a], b = registers[next.b];
        if (next.operation == Operation::constant || next.form == OperandForm::number_and_register) a = next.number;
        if (next.form == OperandForm::register_and_number || next.operation == Operation::integer_power)
            b = next.number;
        registers[next.result] = applyOperation(next.operation, a, b);
    }
    return registers[Tape::kResult];
}

void requireSoundBounds(const std::string& text, const Box& box, Random& random) {
    const Formula formula = parsed(text);
    SamplePoints samples;
    for (int i = 0; i < 24; ++i) samples.addRandom(random, box);
    std::vector<const TapeKernels*> all{&portableKernels()};
    if (avx2Kernels() != nullptr) all.push_back(avx2Kernels());
    for (const TapeKernels* kernels : all) {
        const FormulaFunction function(formula, *kernels);
        const ValueBounds bounds = function.boundsIn(box);
        samples.evaluate(function);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const double real = realValue(formula.tape(), samples.point(i));
            for (const double value : {static_cast<double>(samples.values[i]), real}) {
                ASSERT_TRUE(std::isnan(value) ? !bounds.hasValueEverywhere : bounds.min <= value && value <= bounds.max)
                    << text << "\nat " << samples.describe(i) << ": " << value << "\nin [" << bounds.min << ", "
                    << bounds.max << "]" << (bounds.hasValueEverywhere ? " total" : "");
            }
        }
    }
}

TEST(Intervals, ContainAllValuesOfRandomFormulas) {
    Random random(7);
    for (int i = 0; i < 6000; ++i) {
        const std::string text = randomFormula(random, 1 + static_cast<int>(below(random, 5)));
        for (int j = 0; j < 4; ++j) {
            requireSoundBounds(text, randomBox(random), random);
            if (HasFatalFailure()) return;
        }
    }
}

// The bounds contain all values of each operation. Each operation is tested alone, because larger formulas hide errors.
TEST(Intervals, ContainAllValuesOfEachOperation) {
    Random random(8);
    for (const char* text :
         {"-x",           "abs(x)",       "x^2",          "x*x",         "x^3",           "x^4",
          "x^-2",         "x^-3",         "x^63",         "x^64",        "x^65",          "x^100",
          "x^-65",        "sqrt(x)",      "cbrt(x)",      "exp(x)",      "exp(100*x)",    "log(x)",
          "sin(x)",       "cos(x)",       "sin(1000*x)",  "cos(1e8*x)",  "tan(x)",        "tan(100*x)",
          "asin(x)",      "acos(x)",      "atan(x)",      "sinh(x)",     "cosh(x)",       "tanh(x)",
          "step(x)",      "sign(x)",      "floor(x)",     "x+y",         "x-y",           "x*y",
          "x/y",          "min(x,y)",     "max(x,y)",     "x^y",         "x^0.3",         "x^1.5",
          "x^8.5",        "(x*1e-5)^8.5", "x^1.5",        "x^2.5",       "x^8.5",         "(x*1e-5)^8.5",
          "x^-2.5",       "2^x",          "0^x",          "(-2)^x",      "1^x",           "atan2(x,y)",
          "mod(x,y)",     "mod(x,1)",     "mod(x,-0.3)",  "1/x",         "x/3",           "3-x",
          "x*0",          "x*1e300",      "x*1e-300",     "x*1e38",      "x*1e-42",       "(x*1e-42)*y",
          "1/(x*1e-42)",  "(1e30*x)^3",   "1/(1e30*x)^3", "(1e-30*x)^2", "(x*1e-20)^-3",  "exp(-100*x)",
          "x-x",          "log(x)^2",     "sqrt(-x^2)",   "x^(2-1e-12)", "mod(1e10*x,1)", "mod(1e-42*x,1e30)",
          "asin(sin(x))", "1e30*x*1e30*y"}) {
        for (int i = 0; i < 300; ++i) {
            requireSoundBounds(text, randomBox(random, i % 2 == 0 ? 2 : 10), random);
            if (HasFatalFailure()) return;
        }
    }
}

TEST(Intervals, AreSoundInHugeBoxes) {
    Random random(9);
    const double ends[] = {-kUnbounded, -1e38, -1e10, -1, -1e-40, 0, 1e-40, 1, 1e10, 1e38, kUnbounded};
    for (int i = 0; i < 3000; ++i) {
        const std::string text = randomFormula(random, 3);
        Box box;
        for (int axis = 0; axis < 4; ++axis) {
            const std::size_t a = below(random, std::size(ends)), b = below(random, std::size(ends));
            box.min[axis] = ends[std::min(a, b)];
            box.max[axis] = ends[std::max(a, b)];
        }
        SamplePoints samples;
        for (int j = 0; j < 40; ++j) {
            glm::dvec4 point;
            for (int axis = 0; axis < 4; ++axis) {
                do point[axis] = ends[below(random, std::size(ends))];
                while (point[axis] < box.min[axis] || point[axis] > box.max[axis]);
            }
            samples.add(point);
        }
        const FormulaFunction function(parsed(text));
        const ValueBounds bounds = function.boundsIn(box);
        samples.evaluate(function);
        for (std::size_t j = 0; j < samples.size(); ++j) {
            const double value = samples.values[j];
            ASSERT_TRUE(std::isnan(value) ? !bounds.hasValueEverywhere : bounds.min <= value && value <= bounds.max)
                << text << " at " << samples.describe(j) << ": " << value << " in [" << bounds.min << ", " << bounds.max
                << "]";
        }
    }
}

// The bounds in a part of a box lie within the bounds in the whole box.
TEST(Intervals, ShrinkWithTheBox) {
    Random random(10);
    for (int i = 0; i < 3000; ++i) {
        const std::string text = randomFormula(random, 4);
        const Box box = randomBox(random);
        Box part = box;
        for (int axis = 0; axis < 4; ++axis) {
            const double a = uniform(random, box.min[axis], box.max[axis]),
                         b = uniform(random, box.min[axis], box.max[axis]);
            part.min[axis] = std::min(a, b);
            part.max[axis] = std::max(a, b);
        }
        const ValueBounds whole = boundsOfFormula(text, box), some = boundsOfFormula(text, part);
        if (some.min > some.max) continue;
        const auto isWithin = [](double a, double b) { return a <= b || a - b <= 1e-6 * std::abs(b); };
        EXPECT_TRUE(some.hasValueEverywhere || !whole.hasValueEverywhere) << text;
        EXPECT_TRUE(isWithin(whole.min, some.min) && isWithin(some.max, whole.max))
            << text << " [" << some.min << ", " << some.max << "] in [" << whole.min << ", " << whole.max << "]";
    }
}

TEST(Intervals, BecomeTightInSmallBoxes) {
    for (const char* text : {"(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-0.7)^2 - 0.09", "sin(x)*cos(y)+exp(z)/(1+w^2)",
                             "mod(x,1)+atan2(y,z)+abs(w)^2.5", "x^3*y^-2+cbrt(z)-tanh(w)"}) {
        for (const double size : {1e-2, 1e-4}) {
            const glm::dvec4 point(0.3, 0.4, 0.5, 0.6);
            const ValueBounds bounds = boundsOfFormula(text, {point, point + size});
            EXPECT_TRUE(bounds.hasValueEverywhere) << text;
            EXPECT_LT(bounds.max - bounds.min, 100 * size) << text;
        }
    }
}

struct Tight {
    std::string text;
    double from, to, min, max;
};

class TightIntervals : public testing::TestWithParam<Tight> {};

TEST_P(TightIntervals, AreTheRangeOfTheFunction) {
    const auto& [text, from, to, min, max] = GetParam();
    const ValueBounds bounds = boundsOfFormula(text, from, to);
    const auto isNear = [](double a, double b) {
        return a == b || std::abs(a - b) < 1e-5 * std::max(1.0, std::abs(b));
    };
    EXPECT_TRUE(bounds.hasValueEverywhere) << text;
    EXPECT_TRUE(isNear(bounds.min, min) && isNear(bounds.max, max))
        << text << " [" << bounds.min << ", " << bounds.max << "]";
}

INSTANTIATE_TEST_SUITE_P(
    All, TightIntervals,
    testing::Values(Tight{"x^2", -1, 2, 0, 4}, Tight{"x*x", -1, 2, 0, 4}, Tight{"x^4", -2, 1, 0, 16},
                    Tight{"x^3", -1, 2, -1, 8}, Tight{"x^5", -1, 2, -1, 32}, Tight{"x^-2", 1, 2, 0.25, 1},
                    Tight{"abs(x)", -3, 1, 0, 3}, Tight{"sqrt(x^2+y^2)", -3, 3, 0, 3 * std::sqrt(2)},
                    Tight{"r", 0, 0, 0, 0}, Tight{"sin(x)", 0, 2, 0, 1},
                    Tight{"sin(x)", 1, 1.5, std::sin(1), std::sin(1.5)}, Tight{"sin(x)", 4, 5, -1, std::sin(4)},
                    Tight{"cos(x)", -1, 2, std::cos(2), 1}, Tight{"cos(x)", 3, 4, -1, std::cos(4)},
                    Tight{"cos(x)", 0, 100, -1, 1}, Tight{"tan(x)", -1, 1, std::tan(-1), std::tan(1)},
                    Tight{"min(x,y+1)", 0, 1, 0, 1}, Tight{"max(x,y+1)", 0, 1, 1, 2}, Tight{"x+y", -1, 2, -2, 4},
                    Tight{"x-y", -1, 2, -3, 3}, Tight{"x*y", -1, 2, -2, 4}, Tight{"x/y", 1, 2, 0.5, 2},
                    Tight{"exp(x)", 0, 1, 1, std::exp(1)}, Tight{"cosh(x)", -1, 2, 1, std::cosh(2)},
                    Tight{"acos(x)", -1, 1, 0, 3.14159265}, Tight{"floor(x)", -0.5, 1.5, -1, 1},
                    Tight{"step(x)", -1, 1, 0, 1}, Tight{"step(x)", 0, 1, 1, 1}, Tight{"sign(x)", 0, 1, 0, 1},
                    Tight{"mod(x,1)", 0.25, 0.75, 0.25, 0.75}, Tight{"mod(x,1)", 3.25, 9, 0, 1},
                    Tight{"x^2.5", 0, 4, 0, 32}, Tight{"2^x", -1, 3, 0.5, 8},
                    Tight{"atan2(x,y)", 1, 2, std::atan2(1, 2), std::atan2(2, 1)},
                    Tight{"1/x", -1, 1, -kUnbounded, kUnbounded}, Tight{"tan(x)", 1, 2, -kUnbounded, kUnbounded}));

TEST(Intervals, KnowWhereThereMayBeNoValue) {
    EXPECT_FALSE(boundsOfFormula("sqrt(x)", -1e-3, 1).hasValueEverywhere);
    EXPECT_TRUE(boundsOfFormula("sqrt(x)", 0, 1).hasValueEverywhere);
    EXPECT_FALSE(boundsOfFormula("log(x)", -1, 1).hasValueEverywhere);
    EXPECT_TRUE(boundsOfFormula("log(x)", 0, 1).hasValueEverywhere);
    EXPECT_EQ(boundsOfFormula("log(x)", 0, 1).min, -kUnbounded);
    EXPECT_FALSE(boundsOfFormula("asin(x)", 0, 1.01).hasValueEverywhere);
    EXPECT_TRUE(boundsOfFormula("1/x", -1, 1).hasValueEverywhere) << "1/0 is infinite";
    EXPECT_FALSE(boundsOfFormula("x/y", -1, 1).hasValueEverywhere) << "0/0";
    EXPECT_FALSE(boundsOfFormula("x^0.3", -1, 1).hasValueEverywhere);
    EXPECT_FALSE(boundsOfFormula("mod(1,x)", -1, 1).hasValueEverywhere);
    const ValueBounds none = boundsOfFormula("sqrt(x)+1", -2, -1);
    EXPECT_GT(none.min, none.max);
    EXPECT_FALSE(none.hasValueEverywhere);
    EXPECT_TRUE(none.mayCross(0));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(boundsOfFormula("x", {{nan, 0, 0, 0}, {1, 1, 1, 1}}).hasValueEverywhere);
}

// The bounds also contain the value at the float nearest to a point of the box, which may lie outside of the box.
TEST(Intervals, ContainPointsThatAreRoundedToFloats) {
    const double third = 1.0 / 3;
    const ValueBounds bounds = boundsOfFormula("x", third, third);
    EXPECT_LE(bounds.min, third);
    EXPECT_GE(bounds.max, static_cast<float>(third));
}

}  // namespace
}  // namespace oval4d::fields
