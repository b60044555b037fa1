#include <string>

#include <gtest/gtest.h>

#include "fields/formula/formula.hpp"

namespace oval4d::fields {
namespace {

struct FormulaMistakeCase {
    std::string text;
    std::size_t position;
    std::string says;
};

class FormulaMistakes : public testing::TestWithParam<FormulaMistakeCase> {};

TEST_P(FormulaMistakes, AreExplainedWithTheirPosition) {
    const auto& [text, position, says] = GetParam();
    FormulaMistake mistake;
    const auto result = parseFormula(text, &mistake);
    ASSERT_FALSE(result) << result->text();
    EXPECT_EQ(result.error().code, ErrorCode::bad_expression);
    EXPECT_NE(result.error().message.find("position " + std::to_string(position) + ": " + mistake.what),
              std::string::npos)
        << result.error().message;
    EXPECT_EQ(mistake.position, position) << mistake.what;
    EXPECT_NE(mistake.what.find(says), std::string::npos) << mistake.what;
}

INSTANTIATE_TEST_SUITE_P(
    All, FormulaMistakes,
    testing::Values(
        FormulaMistakeCase{"", 1, "a formula is expected"}, FormulaMistakeCase{" \t\n", 1, "a formula is expected"},
        FormulaMistakeCase{"x+", 3, "a number, a name or '(' is expected"},
        FormulaMistakeCase{"x^", 3, "a number, a name or '(' is expected"},
        FormulaMistakeCase{"*x", 1, "a number, a name or '(' is expected"},
        FormulaMistakeCase{"x**2", 3, "a number, a name or '('"},
        FormulaMistakeCase{"x//2", 3, "a number, a name or '('"},
        FormulaMistakeCase{"()", 2, "a number, a name or '('"},
        FormulaMistakeCase{"2x", 2, "an operator is expected (a product is written 2*x)"},
        FormulaMistakeCase{"2(x+1)", 2, "an operator is expected (a product is written 2*x)"},
        FormulaMistakeCase{"x y", 3, "an operator is expected (a product is written 2*x)"},
        FormulaMistakeCase{"x(y)", 2, "an operator is expected (a product"},
        FormulaMistakeCase{"(x)(y)", 4, "an operator is expected (a product"},
        FormulaMistakeCase{"(x 2)", 4, "an operator or ')' is expected (a product is written 2*x)"},
        FormulaMistakeCase{"xy+1", 1, "nothing is called 'xy' (a product is written x*y)"},
        FormulaMistakeCase{"x $ 2", 3, "an operator is expected"},
        FormulaMistakeCase{"x²", 2, "an operator is expected"},
        FormulaMistakeCase{"π*ü", 3, "a number, a name or '(' is expected"},
        FormulaMistakeCase{"x·y", 2, "an operator is expected"}, FormulaMistakeCase{"(x+1", 5, "a ')' is missing"},
        FormulaMistakeCase{"sqrt(x; a=1", 7, "a ')' is missing"},
        FormulaMistakeCase{"x+1)", 4, "a '(' is missing for this ')'"},
        FormulaMistakeCase{"sqr(x)", 1, "did you mean 'sqrt'?"},
        FormulaMistakeCase{"1+coss(x)", 3, "did you mean 'cosh'?"},
        FormulaMistakeCase{"sqrt x", 6, "'(' is expected after sqrt"},
        FormulaMistakeCase{"sin()", 5, "a number, a name or '('"},
        FormulaMistakeCase{"sin(x,y)", 1, "sin needs 1 argument, not 2: sin(a)"},
        FormulaMistakeCase{"1+atan2(x)", 3, "atan2 needs 2 arguments, not 1"},
        FormulaMistakeCase{"min(x)", 1, "min needs at least 2 arguments, not 1: min(a, b, ...)"},
        FormulaMistakeCase{"x<1<2", 4, "only one comparison is allowed"},
        FormulaMistakeCase{"(x<1)*y", 3, "only outside of parentheses"},
        FormulaMistakeCase{"min(x=1,y)", 6, "only outside of parentheses"},
        FormulaMistakeCase{"x==1", 3, "a number, a name or '('"},
        FormulaMistakeCase{"x<", 3, "a number, a name or '('"}, FormulaMistakeCase{"< x", 1, "a number, a name or '('"},
        FormulaMistakeCase{"1e999", 1, "too large or too small"},
        FormulaMistakeCase{"x+1e-999", 3, "too large or too small"},
        FormulaMistakeCase{"0x10", 2, "an operator is expected"}, FormulaMistakeCase{".", 1, "a number is expected"},
        FormulaMistakeCase{"1.2.3", 4, "an operator is expected"},
        FormulaMistakeCase{"nan", 1, "nothing is called 'nan'"},
        FormulaMistakeCase{"x+inf", 3, "nothing is called 'inf'"},
        FormulaMistakeCase{"x-deg", 6, "'(' is expected after deg"},
        FormulaMistakeCase{"x-rad", 3, "'rad' is expected after a number"},
        FormulaMistakeCase{"x^2-a", 5,
                           "nothing is called 'a'; a constant needs a value after the formula, as in ; a=1"},
        FormulaMistakeCase{"radius-r; radus=1", 1, "nothing is called 'radius'"},
        FormulaMistakeCase{"x;", 3, "the name of a constant"},
        FormulaMistakeCase{"x; 1=2", 4, "the name of a constant"},
        FormulaMistakeCase{"x-a; a", 7, "'=' is expected after a"},
        FormulaMistakeCase{"x; a=", 6, "a number, a name or '('"},
        FormulaMistakeCase{"x; sin=1", 4, "'sin' has a meaning already"},
        FormulaMistakeCase{"x; t=1", 4, "'t' has a meaning already"},
        FormulaMistakeCase{"x; pi=3", 4, "'pi' has a meaning already"},
        FormulaMistakeCase{"x; a=1, b=2, a=3", 14, "'a' has a value already"},
        FormulaMistakeCase{"x; a=b, b=1", 6, "nothing before this is called 'b'"},
        FormulaMistakeCase{"x; a=y, a=z", 9, "'a' has a value already"},
        FormulaMistakeCase{"x; a=a+y", 6, "nothing before this is called 'a'"},
        FormulaMistakeCase{"x; a=y*z<1", 9, "may not contain a comparison"},
        FormulaMistakeCase{"x; a=1<2", 7, "may not contain a comparison"},
        FormulaMistakeCase{"x; a=1/0", 6, "the value of a is not a finite"},
        FormulaMistakeCase{"x; a=sqrt(-1)", 6, "the value of a is not a finite"},
        FormulaMistakeCase{"x; a=1 2", 8, "an operator is expected"},
        FormulaMistakeCase{"x, y", 4, "'y' has a meaning already"},
        FormulaMistakeCase{"x; abcdefghijklmnopqrstuvwxyzabcdefghij=1", 4, "a name may have at most 32 characters"},
        FormulaMistakeCase{std::string("x\0y", 3), 2, "an operator is expected"},
        FormulaMistakeCase{"x+\xFF", 3, "a number, a name or '('"}));

TEST(Parser, LimitsTheLengthOfTheText) {
    std::string text = "x";
    while (text.size() < 1999) text += "+x";
    EXPECT_TRUE(parseFormula(text + " "));
    FormulaMistake mistake;
    ASSERT_FALSE(parseFormula(text + "  ", &mistake));
    EXPECT_EQ(mistake.position, 2001U);
    EXPECT_NE(mistake.what.find("at most 2000 bytes"), std::string::npos);
    ASSERT_FALSE(parseFormula(std::string(1'000'000, '('), &mistake));
    EXPECT_EQ(mistake.position, 2001U);
    std::string letters;
    for (int i = 0; i < 1500; ++i) letters += "π";
    ASSERT_FALSE(parseFormula(letters, &mistake));
    EXPECT_EQ(mistake.position, 1001U) << "positions count characters";
}

TEST(Parser, LimitsTheNesting) {
    const auto nested = [](const std::string& open, const std::string& close, int depth) {
        std::string text = "x", end;
        for (int i = 0; i < depth; ++i) {
            text.insert(0, open);
            text += close;
        }
        return text;
    };
    for (const auto& [open, close] : {std::pair{"(", ")"}, {"sin(", ")"}, {"y^", ""}, {"-(1-", ")"}, {"min(1,", ")"}}) {
        const auto deepest = parseFormula(nested(open, close, 64));
        ASSERT_TRUE(deepest) << deepest.error().message;
        EXPECT_TRUE(parseFormula(deepest->text())) << deepest->text();
        FormulaMistake mistake;
        ASSERT_FALSE(parseFormula(nested(open, close, 65), &mistake)) << open;
        EXPECT_EQ(mistake.what, "the formula nests too deeply");
        EXPECT_GT(mistake.position, 64U);
    }
    EXPECT_TRUE(parseFormula(std::string(1000, '-') + "x")) << "signs do not nest";
}

TEST(Parser, LimitsTheInstructionsAfterSimplification) {
    FormulaLimits limits;
    limits.instructions = 3;
    EXPECT_TRUE(parseFormula("x+y+z+w", nullptr, limits));
    EXPECT_TRUE(parseFormula("(x+y)*(x+y)*(2+3^2)", nullptr, limits)) << "equal parts and constants count once";
    FormulaMistake mistake;
    EXPECT_FALSE(parseFormula("x+y+z+w+1", &mistake, limits));
    EXPECT_EQ(mistake.what, "the formula needs 4 instructions; the most allowed are 3");
    EXPECT_EQ(mistake.position, 1U);
}

TEST(Parser, LimitsTheConstants) {
    std::string text = "x; a1=1";
    for (int i = 2; i <= 16; ++i) text += ", a" + std::to_string(i) + "=" + std::to_string(i);
    ASSERT_TRUE(parseFormula(text));
    FormulaMistake mistake;
    EXPECT_FALSE(parseFormula(text + ", b=1", &mistake));
    EXPECT_EQ(mistake.what, "a formula may have at most 16 constants");
    EXPECT_EQ(mistake.position, text.size() + 3);
}

TEST(Parser, ExpressionsHaveNames) {
    const auto text = [](const std::string& formula) { return parseFormula(formula)->text(); };
    EXPECT_FALSE(parseFormula("q^2 < a; p=x+a, a=2, q=p*y")) << "a is defined after its use";
    const std::string named = "q^2 < a; a=2, p=x + a*z, q=p*p - y/p";
    EXPECT_EQ(text(named), "q^2 < a; a=2, p=x+a*z, q=p*p-y/p");
    EXPECT_EQ(text(text(named)), text(named));
    EXPECT_EQ(text("p; a=pi/2, p=2*a"), "p; a=1.5707963267948966, p=2*a") << "a name makes it an expression";
    EXPECT_EQ(parseFormula(named)->constants().size(), 1U);
    EXPECT_EQ(parseFormula(named)->tape().instructions.size(),
              parseFormula("((x+2*z)*(x+2*z) - y/(x+2*z))^2 < 2")->tape().instructions.size())
        << "an expression is evaluated once";
}

// A named expression that is used several times is stored once. Written out, this formula would have 2⁶⁰ operands,
// because each expression uses the previous one twice.
TEST(Parser, ExpressionsAreShared) {
    std::string text = "a60; a0=x";
    for (int i = 1; i <= 60; ++i) {
        const std::string before = "a" + std::to_string(i - 1);
        text += ", a" + std::to_string(i) + "=" + before + "+" + before + "*y";
    }
    const auto formula = parseFormula(text);
    ASSERT_TRUE(formula) << formula.error().message;
    EXPECT_LE(formula->tape().instructions.size(), 120U);
    std::string many = "x; a=y";
    for (int i = 1; i < 100; ++i) many += ",b" + std::to_string(i) + "=y";
    EXPECT_TRUE(parseFormula(many));
    FormulaMistake mistake;
    ASSERT_FALSE(parseFormula(many + ",c=y", &mistake));
    EXPECT_EQ(mistake.what, "a formula may have at most 100 expressions");
}

TEST(Parser, MayShareTheNamesOfAnotherFormula) {
    const auto first = parseFormula("p - b; a=0.5, b=2, p=a*x*x");
    ASSERT_TRUE(first);
    const auto second = parseFormula("c*p + a + q; c=3, q=p*b", nullptr, {}, &*first);
    ASSERT_TRUE(second) << second.error().message;
    EXPECT_EQ(second->text(), "c*p + a + q; c=3, q=p*b");
    EXPECT_EQ(parseFormula(second->text(), nullptr, {}, &*first)->text(), second->text());
    const auto whole = parseFormula("3*p + 0.5 + p*2; p=0.5*x*x");
    EXPECT_EQ(second->tape().instructions.size(), whole->tape().instructions.size());
    FormulaMistake mistake;
    ASSERT_FALSE(parseFormula("x; a=1", &mistake, {}, &*first));
    EXPECT_EQ(mistake.position, 4U);
    ASSERT_FALSE(parseFormula("x; p=1", &mistake, {}, &*first));
    EXPECT_EQ(mistake.what, "'p' has a value already");
    ASSERT_FALSE(parseFormula("d", &mistake, {}, &*first));
    EXPECT_EQ(mistake.position, 1U);
}

// The limit on the length applies to the normalized text, which may be longer than the text that was parsed.
TEST(Parser, LimitsTheLengthOfTheTextThatIsWrittenBack) {
    std::string text = "x";
    for (int i = 0; i < 280; ++i) text += "+1e15*y";
    ASSERT_LE(text.size(), 2000U);
    FormulaMistake mistake;
    ASSERT_FALSE(parseFormula(text, &mistake));
    EXPECT_NE(mistake.what.find("written out"), std::string::npos) << mistake.what;
}

}  // namespace
}  // namespace oval4d::fields
