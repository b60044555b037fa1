#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "fields/formula/functions.hpp"
#include "unit/fields/formula/random_formula.hpp"

namespace oval4d::fields {
namespace {

struct Spelling {
    std::string text, canonical;
};

class FormulaTexts : public testing::TestWithParam<Spelling> {};

TEST_P(FormulaTexts, AreCanonical) {
    const Formula formula = parsed(GetParam().text);
    EXPECT_EQ(formula.text(), GetParam().canonical);
    EXPECT_EQ(parsed(formula.text()).text(), formula.text());
}

INSTANTIATE_TEST_SUITE_P(
    All, FormulaTexts,
    testing::Values(Spelling{"(sqrt(x^2+y^2)-1)^2+(sqrt(z^2 + w^2)-0.7)^2-.09",
                             "(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-0.7)^2 - 0.09"},
                    Spelling{"x - (y - z)", "x - (y-z)"}, Spelling{"(x - y) - z", "x - y - z"},
                    Spelling{"x-(y+z)", "x - (y+z)"}, Spelling{"x/(y*z)", "x/(y*z)"}, Spelling{"(x/y)*z", "x/y*z"},
                    Spelling{"(x^y)^z", "(x^y)^z"}, Spelling{"x^(y^z)", "x^y^z"}, Spelling{"(-x)^2", "(-x)^2"},
                    Spelling{"-(x^2)", "-x^2"}, Spelling{"x^(-y)", "x^-y"}, Spelling{"x^(-(y*z))", "x^(-y*z)"},
                    Spelling{"x--y", "x + y"}, Spelling{"x+-y*z", "x - y*z"}, Spelling{"x*-y", "-x*y"},
                    Spelling{"-x*-y", "x*y"}, Spelling{"--x", "x"}, Spelling{"-(-(x))", "x"},
                    Spelling{"x-(-(y))", "x + y"}, Spelling{"-(x+y)*-z", "(x+y)*z"}, Spelling{"+ + x", "x"},
                    Spelling{"π*φ − t", "pi*phi - w"}, Spelling{"30° + deg(x+y)+45 deg", "30° + (x+y)° + 45°"},
                    Spelling{"2 rad*deg(deg(x))^2", "2*(x°)°^2"}, Spelling{"1.50e2*x", "150*x"},
                    Spelling{"1e-7*r", "1e-07*r"}, Spelling{"min(x, y ,z)", "min(x,y,z)"}, Spelling{"x=y", "x = y"},
                    Spelling{"x ≤ 1 ; a=2*pi,b = -1", "x <= 1; a=6.283185307179586, b=-1"},
                    Spelling{"x>=a, a=1", "x >= a; a=1"}, Spelling{"A_1*x>0; A_1=1e-3", "A_1*x > 0; A_1=0.001"},
                    Spelling{"x\n+\ty\r", "x + y"}));

TEST(FormulaText, MeansTheSameFunction) {
    Random random(1);
    for (int i = 0; i < 1000; ++i) {
        std::string text = randomFormula(random, 5);
        if (i % 5 == 0) text += (i % 2 == 0 ? "<" : ">=") + randomFormula(random, 3);
        const auto formula = parseFormula(text);
        if (!formula) continue;
        const Formula again = parsed(formula->text());
        EXPECT_EQ(again.text(), formula->text());
        SamplePoints samples;
        for (int j = 0; j < 20; ++j) samples.addRandom(random, {});
        samples.evaluate(FormulaFunction(*formula));
        const std::vector<float> values = samples.values;
        samples.evaluate(FormulaFunction(again));
        for (std::size_t j = 0; j < values.size(); ++j) {
            EXPECT_TRUE(values[j] == samples.values[j] || (std::isnan(values[j]) && std::isnan(samples.values[j])))
                << text << " " << formula->text() << " " << samples.describe(j);
        }
    }
}

TEST(Formula, ComparisonsAreNegativeWhereInequalitiesHold) {
    const glm::dvec4 point(0.25, 2, 0, 0);
    for (const char* text : {"x = y", "x < y", "x <= y", "x ≤ y"}) EXPECT_EQ(valueAt(text, point), -1.75F) << text;
    for (const char* text : {"x > y", "x >= y", "x ≥ y"}) EXPECT_EQ(valueAt(text, point), 1.75F) << text;
    EXPECT_EQ(valueAt("x > 0", point), -0.25F);
}

TEST(Formula, ListsItsConstants) {
    const Formula formula = parsed("x^2+y^2-a^2; a=0.7, b=2*pi; c_2=-1");
    const std::vector<FormulaConstant> expected{{"a", 0.7}, {"b", 2 * 3.141592653589793}, {"c_2", -1}};
    EXPECT_EQ(formula.constants(), expected);
    EXPECT_TRUE(parsed("x").constants().empty());
}

TEST(Formula, ConstantsChangeWithoutParsing) {
    const Formula formula = parsed("b*x^n - a; a=0.5, n=2, b=1");
    const glm::dvec4 point(3, 0, 0, 0);
    EXPECT_FLOAT_EQ(valueAt(FormulaFunction(formula), point), 8.5F);
    const FormulaConstant changes[] = {{"n", 3}, {"a", -1}};
    const auto changed = formula.withConstants(changes);
    ASSERT_TRUE(changed) << changed.error().message;
    EXPECT_FLOAT_EQ(valueAt(FormulaFunction(*changed), point), 28);
    EXPECT_EQ(changed->text(), "b*x^n - a; a=-1, n=3, b=1");
    EXPECT_EQ(formula.text(), "b*x^n - a; a=0.5, n=2, b=1");
    EXPECT_EQ(parsed(changed->text()).constants(), changed->constants());
    EXPECT_EQ(formula.withConstants({})->text(), formula.text());
}

TEST(Formula, ChangesOfConstantsCanFail) {
    const Formula formula = parsed("x-radius; radius=1");
    const FormulaConstant misspelled[] = {{"radus", 1}};
    const auto unknown = formula.withConstants(misspelled);
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().code, ErrorCode::bad_expression);
    EXPECT_NE(unknown.error().message.find("did you mean 'radius'?"), std::string::npos) << unknown.error().message;
    for (const double value : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        const FormulaConstant infinite[] = {{"radius", value}};
        ASSERT_FALSE(formula.withConstants(infinite));
        EXPECT_EQ(formula.withConstants(infinite).error().code, ErrorCode::out_of_range);
    }
}

TEST(Formula, EveryFunctionIsDescribed) {
    for (const auto& function : builtinFunctions()) {
        EXPECT_EQ(functionNamed(function.name), static_cast<std::size_t>(&function - builtinFunctions().data()));
        EXPECT_FALSE(function.meaning.empty() || function.arguments.empty()) << function.name;
        std::string call = std::string(function.name) + "(x";
        for (std::size_t i = 1; i < function.minArguments; ++i) call += ",y";
        EXPECT_TRUE(parseFormula(call + ")")) << call;
    }
    EXPECT_FALSE(functionNamed("nothing"));
}

}  // namespace
}  // namespace oval4d::fields
