#include "fields/formula/formula_function.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "fields/formula/kernels_avx2.hpp"
#include "fields/formula/kernels_portable.hpp"
#include "unit/fields/formula/random_formula.hpp"

namespace oval4d::fields {
namespace {

using std::numbers::pi;
constexpr float kInfiniteFloat = std::numeric_limits<float>::infinity();

std::vector<TapeKernels> allKernels() {
    std::vector<TapeKernels> kernels{portableKernels()};
    if (avx2Kernels() != nullptr) kernels.push_back(*avx2Kernels());
    return kernels;
}

bool isSame(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

struct ReferenceFunction {
    std::string text;
    std::function<double(double x, double y, double z, double w)> value;
};

const std::vector<ReferenceFunction>& references() {
    static const std::vector<ReferenceFunction> kReferences{
        {"(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-0.7)^2 - 0.09",
         [](double x, double y, double z, double w) {
             return std::pow(std::hypot(x, y) - 1, 2) + std::pow(std::hypot(z, w) - 0.7, 2) - 0.09;
         }},
        {"x+2*y-3*z/(4+w^2)", [](double x, double y, double z, double w) { return x + 2 * y - 3 * z / (4 + w * w); }},
        {"7-x-2", [](double x, double, double, double) { return 5 - x; }},
        {"12/x/2", [](double x, double, double, double) { return 6 / x; }},
        {"-x^2", [](double x, double, double, double) { return -x * x; }},
        {"2^3^2+x", [](double x, double, double, double) { return 512 + x; }},
        {"x^3+y^4+z^5+w^6", [](double x, double y, double z,
                               double w) { return x * x * x + std::pow(y, 4) + std::pow(z, 5) + std::pow(w, 6); }},
        {"x^7-y^9+z^-3+w^-4+x^13",
         [](double x, double y, double z, double w) {
             return std::pow(x, 7) - std::pow(y, 9) + std::pow(z, -3) + std::pow(w, -4) + std::pow(x, 13);
         }},
        {"x^8+y^-1+z^-8",
         [](double x, double y, double z, double) { return std::pow(x, 8) + 1 / y + std::pow(z, -8); }},
        {"r+t", [](double x, double y, double z, double w) { return std::sqrt(x * x + y * y + z * z) + w; }},
        {"abs(x)^2.5+abs(y)^(1/3)",
         [](double x, double y, double, double) { return std::pow(std::abs(x), 2.5) + std::cbrt(std::abs(y)); }},
        {"abs(x)^y", [](double x, double y, double, double) { return std::pow(std::abs(x), y); }},
        {"2^x", [](double x, double, double, double) { return std::exp2(x); }},
        {"sqrt(abs(x))+cbrt(y)",
         [](double x, double y, double, double) { return std::sqrt(std::abs(x)) + std::cbrt(y); }},
        {"abs(x)^0.5-abs(y)^1.5+abs(z)^-0.5",
         [](double x, double y, double z, double) {
             return std::sqrt(std::abs(x)) - std::pow(std::abs(y), 1.5) + 1 / std::sqrt(std::abs(z));
         }},
        {"hypot(x,y)*hypot(x,z,w)",
         [](double x, double y, double z, double w) { return std::hypot(x, y) * std::hypot(std::hypot(x, z), w); }},
        {"exp(x)-log(abs(y))", [](double x, double y, double, double) { return std::exp(x) - std::log(std::abs(y)); }},
        {"sin(x)+2*cos(y)+tan(z/2)",
         [](double x, double y, double z, double) { return std::sin(x) + 2 * std::cos(y) + std::tan(z / 2); }},
        {"asin(x/4)+acos(y/4)*atan(z)",
         [](double x, double y, double z, double) { return std::asin(x / 4) + std::acos(y / 4) * std::atan(z); }},
        {"atan2(x,y)-atan2(z,1)+atan2(2,w)",
         [](double x, double y, double z, double w) { return std::atan2(x, y) - std::atan2(z, 1) + std::atan2(2, w); }},
        {"sinh(x)+cosh(y)+tanh(z)",
         [](double x, double y, double z, double) { return std::sinh(x) + std::cosh(y) + std::tanh(z); }},
        {"step(x)+2*step(-y)+4*sign(z)",
         [](double x, double y, double z, double) { return (x < 0 ? 0 : 1) + (y > 0 ? 0 : 2) + (z < 0 ? -4 : 4); }},
        {"floor(x)+ceil(y)*10+round(z)*100",
         [](double x, double y, double z, double) {
             return std::floor(x) + std::ceil(y) * 10 + std::floor(z + 0.5) * 100;
         }},
        {"mod(x,1.5)+mod(y,-2)",
         [](double x, double y, double, double) { return x - 1.5 * std::floor(x / 1.5) + y + 2 * std::floor(y / -2); }},
        {"min(x,y,z)+max(y,0.5,w)",
         [](double x, double y, double z, double w) { return std::min({x, y, z}) + std::max({y, 0.5, w}); }},
        {"clamp(x,-1,y)+mix(z,w,0.25)",
         [](double x, double y, double z, double w) { return std::min(std::max(x, -1.0), y) + 0.75 * z + 0.25 * w; }},
        {"smin(x,y,0.5)",
         [](double x, double y, double, double) {
             const double h = std::max(1 - std::abs(x - y) / 0.5, 0.0);
             return std::min(x, y) - 0.5 * h * h / 4;
         }},
        {"sin(30°)+cos(deg(x))+45deg*y",
         [](double x, double y, double, double) { return 0.5 + std::cos(x * pi / 180) + pi / 4 * y; }},
        {"x < a*y, a = 3", [](double x, double y, double, double) { return x - 3 * y; }},
        {"1-2*x", [](double x, double, double, double) { return 1 - 2 * x; }},
        {"exp(-((x-1)^2+y^2+z^2)/(4*(t+5)))/(t+5)^1.5-.1",
         [](double x, double y, double z, double w) {
             return std::exp(-((x - 1) * (x - 1) + y * y + z * z) / (4 * (w + 5))) / std::pow(w + 5, 1.5) - 0.1;
         }},
        {"5", [](double, double, double, double) { return 5; }},
        {"w", [](double, double, double, double w) { return w; }},
    };
    return kReferences;
}

TEST(FormulaFunction, HasTheValuesOfTheFormula) {
    Random random(2);
    for (const TapeKernels& kernels : allKernels()) {
        for (const auto& [text, value] : references()) {
            SamplePoints samples;
            for (int i = 0; i < 1000; ++i) samples.addRandom(random, {glm::dvec4(-3), glm::dvec4(3.001)});
            samples.evaluate(FormulaFunction(parsed(text), kernels));
            for (std::size_t i = 0; i < samples.size(); ++i) {
                const glm::dvec4 p = samples.point(i);
                const double expected = value(p.x, p.y, p.z, p.w);
                ASSERT_NEAR(samples.values[i], expected, 1e-4 * std::max(1.0, std::abs(expected)))
                    << text << " at " << samples.describe(i);
            }
        }
    }
}

// Returns whether the function of the formula has neither kinks nor poles.
bool isSmooth(const std::string& text) {
    for (const char* kink : {"abs", "min", "max", "step", "floor", "mod", "clamp", "cbrt", "atan2", "^-", "/x"})
        if (text.find(kink) != std::string::npos) return false;
    return true;
}

// The gradient is that of the formula: it agrees with differences of a reference in double precision. Near kinks and
// poles, such differences are not the derivatives.
TEST(FormulaFunction, HasTheGradientOfTheFormula) {
    Random random(3);
    for (const TapeKernels& kernels : allKernels()) {
        for (const auto& [text, value] : references()) {
            SamplePoints samples;
            const auto coordinate = [&] { return uniform(random, -3, 3); };
            for (int i = 0; i < 333; ++i) samples.add({coordinate(), coordinate(), coordinate(), coordinate()});
            samples.differentiate(FormulaFunction(parsed(text), kernels));
            std::size_t wrong = 0;
            for (std::size_t i = 0; i < samples.size(); ++i) {
                const glm::dvec4 p = samples.point(i);
                const double expected = value(p.x, p.y, p.z, p.w);
                ASSERT_NEAR(samples.values[i], expected, 1e-4 * std::max(1.0, std::abs(expected))) << text;
                bool isRight = true;
                for (int axis = 0; axis < 4; ++axis) {
                    constexpr double kStep = 1e-5;
                    glm::dvec4 before = p, after = p;
                    before[axis] -= kStep;
                    after[axis] += kStep;
                    const double derivative =
                        (value(after.x, after.y, after.z, after.w) - value(before.x, before.y, before.z, before.w)) /
                        (2 * kStep);
                    const double error = std::abs(samples.gradients[axis][i] - derivative);
                    isRight = isRight && error < 1e-3 * std::max(1.0, std::abs(derivative));
                }
                if (!isRight) ++wrong;
            }
            EXPECT_LE(wrong, isSmooth(text) ? 0 : samples.size() / 20) << text;
        }
    }
}

TEST(FormulaFunction, GradientsAreZeroWhereTheyDoNotExist) {
    const auto gradient = [](const std::string& text, const glm::dvec4& point) {
        SamplePoints samples;
        samples.add(point);
        samples.differentiate(FormulaFunction(parsed(text)));
        return glm::vec4(samples.gradients[0][0], samples.gradients[1][0], samples.gradients[2][0],
                         samples.gradients[3][0]);
    };
    const glm::dvec4 origin(0);
    EXPECT_EQ(gradient("r+w", origin), glm::vec4(0));
    EXPECT_EQ(gradient("sqrt(x-1)+y", origin), glm::vec4(0)) << "no value";
    EXPECT_EQ(gradient("log(x)+y", origin), glm::vec4(0)) << "infinite";
    EXPECT_EQ(gradient("abs(x)+y", origin), glm::vec4(0, 1, 0, 0));
    EXPECT_EQ(gradient("x^2.5+y^3.5+z", origin), glm::vec4(0, 0, 1, 0));
    EXPECT_EQ(gradient("x^1.5+z", origin), glm::vec4(0, 0, 1, 0));
    EXPECT_EQ(gradient("x^3+y^-1*z", {0, 1, 0, 0}), glm::vec4(0, 0, 1, 0));
    EXPECT_EQ(gradient("min(r,x-1)", origin), glm::vec4(1, 0, 0, 0)) << "only that of the operand that counts";
    EXPECT_EQ(gradient("abs(x)^y", {2, 3, 0, 0}).x, 12);
    EXPECT_FLOAT_EQ(gradient("abs(x)^y", {2, 3, 0, 0}).y, static_cast<float>(8 * std::log(2)));
    EXPECT_EQ(gradient("3", origin), glm::vec4(0));
    EXPECT_EQ(gradient("z", origin), glm::vec4(0, 0, 1, 0));
}

TEST(FormulaFunction, SmoothMinimumWithoutSmoothingIsTheMinimum) {
    Random random(9);
    const Box box{glm::dvec4(-2), glm::dvec4(2)};
    const FormulaFunction minimum(parsed("min(x,y)"));
    // In these formulas, k is 0 or negative, as a number or as a function of the point, or its square underflows.
    for (const char* text : {"smin(x,y,0)", "smin(x,y,-1)", "smin(x,y,0*z)", "smin(x,y,-abs(z))", "smin(x,y,1e-30)",
                             "smin(x,y,1e-40)", "smin(x,y,-1e-40)"}) {
        for (const TapeKernels& kernels : allKernels()) {
            const FormulaFunction function(parsed(text), kernels);
            SamplePoints samples;
            for (int i = 0; i < 300; ++i) samples.addRandom(random, box);
            samples.add({1, 1, 0, 0});
            SamplePoints expected = samples;
            samples.differentiate(function);
            expected.differentiate(minimum);
            EXPECT_EQ(samples.values, expected.values) << text;
            EXPECT_EQ(samples.gradients, expected.gradients) << text;
            samples.evaluate(function);
            EXPECT_EQ(samples.values, expected.values) << text;
            const ValueBounds bounds = function.boundsIn(box);
            EXPECT_TRUE(bounds.hasValueEverywhere) << text;
            EXPECT_LE(bounds.min, -2) << text;
            EXPECT_GE(bounds.max, 2) << text;
        }
    }
    EXPECT_EQ(valueAt("smin(x,y,z)", {1, 1, 0, 0}), 1);
    EXPECT_EQ(valueAt("smin(x,y,z)", {1, 1, 2, 0}), 0.5F);
    EXPECT_NEAR(FormulaFunction(parsed("smin(x,y,0)")).boundsIn(box).min, -2, 1e-5);
}

TEST(FormulaFunction, ValuesAreTheSameInAnyBatch) {
    Random random(4);
    for (const TapeKernels& kernels : allKernels()) {
        for (int round = 0; round < 60; ++round) {
            const FormulaFunction function(parsed(randomFormula(random, 5)), kernels);
            SamplePoints all;
            for (int i = 0; i < 600; ++i) all.addRandom(random, {glm::dvec4(-2), glm::dvec4(2)});
            all.differentiate(function);
            const std::vector<float> differentiated = all.values;
            const auto gradients = all.gradients;
            all.evaluate(function);
            for (std::size_t i = 0; i < all.size(); ++i)
                ASSERT_TRUE(isSame(all.values[i], differentiated[i])) << function.formula().text();
            for (int part = 0; part < 30; ++part) {
                const std::size_t begin = below(random, all.size()), size = below(random, all.size() - begin) + 1;
                SamplePoints some;
                some.coordinates = all.coordinates;
                for (auto& axis : some.coordinates) axis = {axis.begin() + begin, axis.begin() + begin + size};
                some.evaluate(function);
                for (std::size_t i = 0; i < size; ++i)
                    ASSERT_TRUE(isSame(some.values[i], all.values[begin + i])) << function.formula().text();
                some.differentiate(function);
                for (std::size_t i = 0; i < size; ++i) {
                    for (int axis = 0; axis < 4; ++axis)
                        ASSERT_EQ(some.gradients[axis][i], gradients[axis][begin + i]) << function.formula().text();
                }
            }
        }
    }
}

TEST(FormulaFunction, EmptyBatchesAreAllowed) {
    SamplePoints none;
    none.evaluate(FormulaFunction(parsed("sin(x)+cos(y)")));
    none.differentiate(FormulaFunction(parsed("sin(x)+cos(y)")));
    EXPECT_TRUE(none.values.empty());
}

TEST(FormulaFunction, HasNoValueOutsideOfDomains) {
    for (const char* text :
         {"sqrt(x)",           "log(x)",          "x^0.3",           "x^-0.5",        "x^1.5",
          "asin(x)",           "acos(x)",         "0/(y-1)",         "0*log(x)",      "min(log(x),-5)",
          "max(5,log(x))",     "step(log(x))",    "sign(log(x))",    "1^log(x)",      "log(x)^y",
          "floor(log(x))",     "abs(log(x))",     "atan2(log(x),0)", "mod(log(x),1)", "mod(y,0)",
          "clamp(log(x),0,1)", "hypot(log(x),1)", "sqrt(-1)",        "y*0/0"}) {
        for (const TapeKernels& kernels : allKernels()) {
            const FormulaFunction function(parsed(text), kernels);
            EXPECT_TRUE(std::isnan(valueAt(function, {-1.5, 1, 0, 0}))) << text;
            EXPECT_FALSE(function.boundsIn({{-1.5, 1, 0, 0}, {-1.5, 1, 0, 0}}).hasValueEverywhere) << text;
        }
    }
}

TEST(FormulaFunction, ValuesMayBeInfinite) {
    EXPECT_EQ(valueAt("1/x", {0, 0, 0, 0}), kInfiniteFloat);
    EXPECT_EQ(valueAt("log(x)", {0, 0, 0, 0}), -kInfiniteFloat);
    EXPECT_EQ(valueAt("exp(x)", {1000, 0, 0, 0}), kInfiniteFloat);
    EXPECT_EQ(valueAt("x^3", {-1e20, 0, 0, 0}), -kInfiniteFloat);
    EXPECT_EQ(valueAt("x*1e300", {1, 0, 0, 0}), kInfiniteFloat);
}

// Functions are accurate over the whole range of floats: the error is at most 4 units in the last place of the exact
// result.
TEST(FormulaFunction, FunctionsAreAccurate) {
    struct Accurate {
        std::string text;
        double (*value)(double);
    };
    const Accurate functions[] = {
        {"sin(x)", [](double x) { return std::sin(x); }},
        {"cos(x)", [](double x) { return std::cos(x); }},
        {"tan(x)", [](double x) { return std::tan(x); }},
        {"exp(x)", [](double x) { return std::exp(x); }},
        {"log(x)", [](double x) { return std::log(x); }},
        {"asin(x)", [](double x) { return std::asin(x); }},
        {"acos(x)", [](double x) { return std::acos(x); }},
        {"atan(x)", [](double x) { return std::atan(x); }},
        {"sinh(x)", [](double x) { return std::sinh(x); }},
        {"cosh(x)", [](double x) { return std::cosh(x); }},
        {"tanh(x)", [](double x) { return std::tanh(x); }},
        {"cbrt(x)", [](double x) { return std::cbrt(x); }},
        {"abs(x)^2.5", [](double x) { return std::pow(std::abs(x), 2.5); }},
        {"2^x", [](double x) { return std::exp2(x); }},
        {"atan2(x,2)", [](double x) { return std::atan2(x, 2); }},
    };
    Random random(5);
    for (const TapeKernels& kernels : allKernels()) {
        for (const auto& [text, value] : functions) {
            SamplePoints samples;
            for (int i = 0; i < 200'000; ++i) {
                const double sign = below(random, 2) == 0 ? 1 : -1;
                const double exponent = i % 4 == 0 ? uniform(random, -126, 127) : uniform(random, -12, 7);
                samples.add({sign * std::exp2(exponent), 0, 0, 0});
            }
            for (const double special : {0.0, -0.0, 1.0, -1.0, 1e38, -1e38}) samples.add({special, 0, 0, 0});
            samples.evaluate(FormulaFunction(parsed(text), kernels));
            for (std::size_t i = 0; i < samples.size(); ++i) {
                const double expected = value(samples.coordinates[0][i]);
                const float rounded = static_cast<float>(expected);
                if (std::isnan(expected)) {
                    ASSERT_TRUE(std::isnan(samples.values[i])) << text << " at " << samples.coordinates[0][i];
                } else if (std::isinf(rounded)) {
                    ASSERT_GE(std::abs(samples.values[i]), 3.4e38F) << text << " at " << samples.coordinates[0][i];
                } else {
                    const double unit =
                        std::max(std::abs(std::nextafter(rounded, kInfiniteFloat) - double{rounded}), 0x1p-126);
                    ASSERT_NEAR(samples.values[i], expected, 4 * unit) << text << " at " << samples.coordinates[0][i];
                }
            }
        }
    }
}

TEST(FormulaFunction, FunctionsTakeInfiniteAndMissingValues) {
    struct Special {
        std::string text;
        float at, value;
    };
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    for (const auto& [text, at, value] : {Special{"sin(x)", kInfiniteFloat, kNaN},
                                          {"cos(x)", -kInfiniteFloat, kNaN},
                                          {"tan(x)", kInfiniteFloat, kNaN},
                                          {"exp(x)", kInfiniteFloat, kInfiniteFloat},
                                          {"exp(x)", -kInfiniteFloat, 0},
                                          {"log(x)", kInfiniteFloat, kInfiniteFloat},
                                          {"asin(x)", kInfiniteFloat, kNaN},
                                          {"acos(x)", -kInfiniteFloat, kNaN},
                                          {"atan(x)", kInfiniteFloat, static_cast<float>(pi / 2)},
                                          {"sinh(x)", -kInfiniteFloat, -kInfiniteFloat},
                                          {"cosh(x)", -kInfiniteFloat, kInfiniteFloat},
                                          {"tanh(x)", -kInfiniteFloat, -1},
                                          {"cbrt(x)", -kInfiniteFloat, -kInfiniteFloat},
                                          {"2^x", -kInfiniteFloat, 0},
                                          {"x^2.5", kInfiniteFloat, kInfiniteFloat},
                                          {"atan2(x,1)", kInfiniteFloat, static_cast<float>(pi / 2)},
                                          {"floor(x)", kInfiniteFloat, kInfiniteFloat},
                                          {"sqrt(x)", kInfiniteFloat, kInfiniteFloat}}) {
        for (const TapeKernels& kernels : allKernels()) {
            const FormulaFunction function(parsed(text), kernels);
            const float computed = valueAt(function, {at, 0, 0, 0});
            EXPECT_TRUE(std::isnan(value) ? std::isnan(computed)
                                          : std::abs(computed - value) < 1e-6 || computed == value)
                << text << " at " << at << ": " << computed;
            EXPECT_TRUE(std::isnan(valueAt(function, {kNaN, 0, 0, 0}))) << text;
        }
    }
}

TEST(FormulaFunction, KernelsAgreeWithoutFunctionsOfTheCLibrary) {
    if (avx2Kernels() == nullptr) GTEST_SKIP() << "this processor has no AVX2";
    Random random(6);
    for (const char* text : {"(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-0.7)^2 - 0.09", "x/y+z*w-mod(x,y)+floor(3*z)",
                             "min(x^3,y^-5)+max(z,abs(w))*sign(x)+step(y)"}) {
        SamplePoints samples;
        for (int i = 0; i < 1000; ++i) samples.addRandom(random, {});
        samples.differentiate(FormulaFunction(parsed(text), portableKernels()));
        const SamplePoints expected = samples;
        samples.differentiate(FormulaFunction(parsed(text), *avx2Kernels()));
        for (std::size_t i = 0; i < samples.size(); ++i) {
            ASSERT_TRUE(isSame(samples.values[i], expected.values[i])) << text;
            for (int axis = 0; axis < 4; ++axis)
                ASSERT_EQ(samples.gradients[axis][i], expected.gradients[axis][i]) << text;
        }
    }
}

TEST(FormulaFunction, KnowsItsMemory) {
    EXPECT_GT(FormulaFunction(parsed("sin(x)+cos(y)")).memoryBytes(), FormulaFunction(parsed("x")).memoryBytes());
}

}  // namespace
}  // namespace oval4d::fields
