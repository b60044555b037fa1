#include "fields/value_range.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "fields/formula_field.hpp"

namespace oval4d::fields {
namespace {

ValueRange rangeOf(std::string_view formula, const Box& box = kFormulaBox) {
    return fieldFromFormula("test", formula, box)->coloringRange->typicalRange();
}

TEST(ValueRange, IsExactWhereTheExtremesAreAtTheEndsOrMiddlesOfTheBox) {
    EXPECT_EQ(rangeOf("x"), (ValueRange{-2, 2}));
    EXPECT_EQ(rangeOf("x*y"), (ValueRange{-4, 4}));
    EXPECT_EQ(rangeOf("1 + z", {glm::dvec4(0, 0, 1, 0), glm::dvec4(1, 1, 5, 1)}), (ValueRange{2, 6}));
    EXPECT_EQ(rangeOf("3"), (ValueRange{3, 3}));
}

TEST(ValueRange, LeavesOutPolesAndWhatHasNoValue) {
    const ValueRange pole = rangeOf("1/r");
    EXPECT_LT(pole.greatest, 20);
    EXPECT_NEAR(pole.least, 1 / std::sqrt(12), 1e-3);
    EXPECT_EQ(rangeOf("sqrt(x)").least, 0);
    EXPECT_EQ(rangeOf("sqrt(-1-x^2)"), (ValueRange{0, 1}));
    const float none = std::numeric_limits<float>::quiet_NaN();
    const std::vector<float> values{none, 3, -1, std::numeric_limits<float>::infinity(), 2};
    EXPECT_EQ(fullAndTypicalRange(values).full, (ValueRange{-1, 3}));
}

TEST(ValueRange, IsThatOfTheSecondFunction) {
    const auto field = fieldFromFormula("test", "x^2 + y^2 - a; a=2", kFormulaBox, "a*z");
    ASSERT_TRUE(field);
    EXPECT_EQ(field->coloringRange->typicalRange(), (ValueRange{-4, 4}));
    EXPECT_EQ(field->second->formula, "a*z");
    const auto wrong = fieldFromFormula("test", "x - a; a=2", kFormulaBox, "b*z");
    ASSERT_FALSE(wrong);
    EXPECT_TRUE(wrong.error().message.starts_with("values: 'b*z', position 1: nothing is called 'b'"))
        << wrong.error().message;
}

}  // namespace
}  // namespace oval4d::fields
