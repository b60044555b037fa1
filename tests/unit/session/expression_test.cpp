#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "session/expression.hpp"

namespace oval4d::session {
namespace {

using std::numbers::pi;

struct Arithmetic {
    std::string text;
    double value;
};

class Expressions : public testing::TestWithParam<Arithmetic> {};

TEST_P(Expressions, HaveTheirValue) {
    // evaluateAngle() refuses numbers above 2π without a unit, but not in a term with a function.
    const auto result = evaluateAngle("(" + GetParam().text + ")/sqrt(1)");
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_DOUBLE_EQ(*result, GetParam().value);
}

INSTANTIATE_TEST_SUITE_P(
    All, Expressions,
    testing::Values(Arithmetic{"0.5", 0.5}, Arithmetic{".5", 0.5}, Arithmetic{"2e-3", 0.002}, Arithmetic{"1+2*3", 7},
                    Arithmetic{"(1+2)*3", 9}, Arithmetic{"7-2-1", 4}, Arithmetic{"12/3/2", 2}, Arithmetic{"2^3^2", 512},
                    Arithmetic{"-2^2", -4}, Arithmetic{"2^-1", 0.5}, Arithmetic{"--3", 3}, Arithmetic{"+3", 3},
                    Arithmetic{" 1 + 1 ", 2}, Arithmetic{"pi/sqrt(3)-pi/8", pi / std::sqrt(3) - pi / 8},
                    Arithmetic{"π/8", pi / 8}, Arithmetic{"φ", std::numbers::phi}, Arithmetic{"−1", -1},
                    Arithmetic{"3−1", 2}, Arithmetic{"phi^2-phi", 1}, Arithmetic{"deg(180)", pi},
                    Arithmetic{"sin(pi/6)", std::sin(pi / 6)}, Arithmetic{"cos(0)", 1},
                    Arithmetic{"tan(0.5)", std::tan(0.5)}, Arithmetic{"asin(1)", pi / 2}, Arithmetic{"acos(1)", 0},
                    Arithmetic{"atan(1)*4", pi}, Arithmetic{"30°", pi / 6}, Arithmetic{"30 deg", pi / 6},
                    Arithmetic{"30º", pi / 6}, Arithmetic{"30 ˚", pi / 6}, Arithmetic{"-90°/2", -pi / 4},
                    Arithmetic{"(10+20)°", pi / 6}, Arithmetic{"2rad", 2}, Arithmetic{"45deg+pi/4", pi / 2},
                    Arithmetic{"45/2°", pi / 8}, Arithmetic{"45°/2", pi / 8}, Arithmetic{"2*45/3 deg", pi / 6},
                    Arithmetic{"-1/2rad", -0.5}, Arithmetic{"pi/8rad", pi / 8}, Arithmetic{"30\u00a0°", pi / 6},
                    Arithmetic{"30\u202f\u2009deg", pi / 6}, Arithmetic{"3*10^1°", pi / 6},
                    Arithmetic{"sqrt(900)°", pi / 6}));

TEST(Expressions, AskAboutAnglesThatAreProbablyDegrees) {
    for (const char* text : {"30", "-30", " 45.5 ", "6.3", "−30", "9e1", "1E2", "(90)", "+(−(90))", "360/5", "45+45",
                             "2^5", "−90+pi/8", "30+15°", "2*(30)"}) {
        const auto angle = evaluateAngle(text);
        ASSERT_FALSE(angle) << text;
        EXPECT_EQ(angle.error().code, ErrorCode::out_of_range);
        EXPECT_NE(angle.error().message.find("°?"), std::string::npos) << angle.error().message;
    }
    for (const char* text : {" -30 ", "−30", "-(3e1)"}) {
        EXPECT_EQ(evaluateAngle(text).error().message, "−30 radians are more than a full turn; did you mean −30°?");
    }
    EXPECT_EQ(evaluateAngle("360/7").error().message,
              "51.4286 radians are more than a full turn; did you mean 51.4286°?");
    for (const char* text : {"30°", "30deg", "30rad", "6.28", "4*pi", "30*phi", "90-90+1", "sqrt(900)", "0.06e2"})
        EXPECT_TRUE(evaluateAngle(text)) << text;
    EXPECT_DOUBLE_EQ(*evaluateAngle("30rad"), 30);
    EXPECT_EQ(evaluateAngle("x").error().code, ErrorCode::bad_expression);
}

TEST(Expressions, HaveOneUnitInAProduct) {
    const auto says = [](std::string_view text, std::string_view part) {
        const auto value = evaluateAngle(text);
        ASSERT_FALSE(value) << text << " = " << *value;
        EXPECT_EQ(value.error().code, ErrorCode::bad_expression);
        EXPECT_NE(value.error().message.find(part), std::string::npos) << value.error().message;
    };
    for (const char* text : {"pi/8°", "π°", "(pi/8)°", "pi*30°", "deg(30)°", "atan(1)deg", "(1+pi)°"})
        says(text, "in radians already");
    says("pi/8°", "position 5");
    for (const char* text : {"60°/2°", "30°*2rad", "2*(30°)*1°"}) says(text, "one unit");
    for (const char* text : {"(30°)°", "(1rad+2)deg"}) says(text, "has a unit already");
    for (const char* text : {"45/(2°)", "1/(1rad)"}) says(text, "cannot be divided by an angle");
    says("(30°)^2", "power of an angle");
}

TEST(Expressions, HaveUnitsOnlyWhereAnAngleIsExpected) {
    for (const char* text : {"0.1°", "0.1 deg", "2rad", "1+3°", "(1°)*2"}) {
        const auto value = evaluateNumber(text);
        ASSERT_FALSE(value) << text;
        EXPECT_NE(value.error().message.find("a number without a unit is expected"), std::string::npos)
            << value.error().message;
    }
    EXPECT_NE(evaluateNumber("0.1°").error().message.find("position 4"), std::string::npos);
    EXPECT_DOUBLE_EQ(*evaluateNumber("2*sin(30°)"), 1);
    EXPECT_FALSE(evaluateNumber("2*sin(30°)°"));
}

struct Mistake {
    std::string text, says;
};

class Mistakes : public testing::TestWithParam<Mistake> {};

TEST_P(Mistakes, AreExplained) {
    const auto result = evaluateNumber(GetParam().text);
    ASSERT_FALSE(result) << *result;
    EXPECT_EQ(result.error().code, ErrorCode::bad_expression);
    EXPECT_NE(result.error().message.find(GetParam().says), std::string::npos) << result.error().message;
}

INSTANTIATE_TEST_SUITE_P(
    All, Mistakes,
    testing::Values(Mistake{"", "a number is expected"}, Mistake{"  ", "a number is expected"},
                    Mistake{"pi/(8", "position 6: a ')' is missing"},
                    Mistake{"2pi", "position 2: an operator is expected (a product is written 2*pi)"},
                    Mistake{"1+", "position 3: a number, a name or '(' is expected"},
                    Mistake{"1 $ 2", "position 3: an operator is expected"}, Mistake{"sqr(2)", "did you mean 'sqrt'?"},
                    Mistake{"sqrt 2", "'(' is expected after sqrt"}, Mistake{"1/0", "not a finite number"},
                    Mistake{"sqrt(-1)", "not a finite number"}, Mistake{"0/0", "not a finite number"},
                    Mistake{"1e999", "too large"}, Mistake{"nan", "nothing is called 'nan'"},
                    Mistake{"inf", "nothing is called 'inf'"}, Mistake{"10^10^10", "not a finite number"},
                    Mistake{"0x10", "an operator is expected"}));

TEST(Expression, DeepNestingIsRefusedNotFollowed) {
    for (const char c : {'(', '-', '+'}) {
        const auto result = evaluateNumber(std::string(999, c));
        ASSERT_FALSE(result);
        EXPECT_NE(result.error().message.find("nests too deeply"), std::string::npos) << result.error().message;
    }
    EXPECT_FALSE(evaluateNumber(std::string(100'000, '1')));
    std::string powers = "1";
    for (int i = 0; i < 200; ++i) powers += "^1";
    EXPECT_FALSE(evaluateNumber(powers));
}

TEST(RotationAngles, IsReadFromPlanesAndAngles) {
    const auto simple = parseTurn("xw:pi/8");
    ASSERT_TRUE(simple);
    EXPECT_EQ(*simple, (geometry::RotationAngles{geometry::Plane::xw, pi / 8, {}}));
    const auto doubled = parseTurn("xw,yz:pi/8,pi/sqrt(3)-pi/8");
    ASSERT_TRUE(doubled);
    EXPECT_EQ(*doubled, (geometry::RotationAngles{geometry::Plane::xw, pi / 8, pi / std::sqrt(3) - pi / 8}));
    EXPECT_EQ(*parseTurn("xw:180°"), (geometry::RotationAngles{geometry::Plane::xw, pi, {}}));
    EXPECT_EQ(*parseTurn(" xw , yz : pi/8 , 1 "), *parseTurn("xw,yz:pi/8,1"));
}

TEST(RotationAngles, MistakesAreExplained) {
    const auto says = [](std::string_view text, std::string_view part) {
        const auto result = parseTurn(text);
        ASSERT_FALSE(result) << text;
        EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
    };
    says("xw", "not a rotation");
    says("xq:1", "no plane is called 'xq'");
    says("xw,yz,xw:1,2,3", "the plane xw is named twice");
    says("xw:1,2", "one plane needs one angle, not 2; write xw:pi/8 or xw,yz:pi/8,pi/5");
    says("xw,yz:1", "2 planes need 2 angles, not 1");
    says("xw:30", "30 radians are more than a full turn; did you mean 30°?");
    says("xw,yz:1,-400", "did you mean −400°?");
    says("xw:−90", "did you mean −90°?");
    says("xw:pi/", "a number, a name or '(' is expected");
    says(":", "no plane is called ''");
    says("", "not a rotation");
}

}  // namespace
}  // namespace oval4d::session
