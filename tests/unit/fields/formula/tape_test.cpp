#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "fields/formula/formula.hpp"

namespace oval4d::fields {
namespace {

Tape tapeOf(const std::string& text) { return parseFormula(text)->tape(); }

std::vector<Operation> operationsOf(const std::string& text) {
    std::vector<Operation> result;
    for (const Instruction& instruction : tapeOf(text).instructions) result.push_back(instruction.operation);
    return result;
}
using Operations = std::vector<Operation>;

TEST(Tape, FoldsConstants) {
    EXPECT_EQ(operationsOf("x*(2+3*sin(pi/4))"), Operations{Operation::multiply});
    EXPECT_EQ(tapeOf("x*(2+3)").instructions[0].number, 5);
    EXPECT_EQ(operationsOf("a*b+c; a=1, b=2, c=3"), Operations{Operation::constant});
    EXPECT_EQ(tapeOf("a*b+c; a=1, b=2, c=3").instructions[0].number, 5);
    EXPECT_EQ(operationsOf("x"), Operations{Operation::copy});
}

TEST(Tape, SharesEqualParts) {
    EXPECT_EQ(operationsOf("sin(x+y)+cos(y+x)").size(), 4U);
    EXPECT_EQ(operationsOf("r*r+hypot(x,y,z)").size(), 8U);
    EXPECT_EQ(operationsOf("(x+1)*(x+1)"), (Operations{Operation::add, Operation::square}));
}

TEST(Tape, PowersAreMultiplications) {
    EXPECT_EQ(operationsOf("x^2"), Operations{Operation::square});
    EXPECT_EQ(operationsOf("x^3"), Operations{Operation::integer_power});
    EXPECT_EQ(operationsOf("x^-7"), Operations{Operation::integer_power});
    EXPECT_EQ(operationsOf("x^0.5"), Operations{Operation::sqrt});
    EXPECT_EQ(operationsOf("x^1.5"), Operations{Operation::power});
    EXPECT_EQ(operationsOf("x^-1"), Operations{Operation::divide});
    EXPECT_EQ(operationsOf("x^1"), Operations{Operation::copy});
    EXPECT_EQ(operationsOf("x^0"), Operations{Operation::constant});
    EXPECT_EQ(operationsOf("x^2.5"), Operations{Operation::power});
    EXPECT_EQ(operationsOf("x^n; n=2"), Operations{Operation::square});
}

TEST(Tape, Simplifies) {
    EXPECT_EQ(operationsOf("x*1+0"), Operations{Operation::copy});
    EXPECT_EQ(operationsOf("y-(-x)"), Operations{Operation::add});
    EXPECT_EQ(operationsOf("(-x)^2"), Operations{Operation::square});
    EXPECT_EQ(operationsOf("x/4"), Operations{Operation::multiply});
    EXPECT_EQ(operationsOf("x*0"), Operations{Operation::multiply}) << "NaN if x is infinite";
    EXPECT_EQ(operationsOf("x-x"), Operations{Operation::subtract});
}

TEST(Tape, ReusesRegisters) {
    std::string sum = "sin(x)", chain = "x";
    for (int i = 1; i < 50; ++i) {
        sum += "+sin(" + std::to_string(i) + "*x)";
        chain += "*y+cos(x)";
    }
    EXPECT_LE(tapeOf(sum).scratchRegisters, 2U);
    EXPECT_LE(tapeOf(chain).scratchRegisters, 3U);
    EXPECT_LE(tapeOf("(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-0.7)^2 - 0.09").scratchRegisters, 3U);
    EXPECT_EQ(tapeOf("x+1").scratchRegisters, 0U);
}

TEST(Tape, KnowsTheAxesOnWhichRegistersDepend) {
    const Tape tape = tapeOf("sin(x*y)+floor(z)*w");
    const auto axes = [&](Operation operation) {
        const auto& all = tape.instructions;
        return std::find_if(all.begin(), all.end(), [&](const auto& i) { return i.operation == operation; })->axes;
    };
    EXPECT_EQ(axes(Operation::sin), 0b0011);
    EXPECT_EQ(axes(Operation::floor), 0);
    EXPECT_EQ(axes(Operation::add), 0b1011);
}

}  // namespace
}  // namespace oval4d::fields
