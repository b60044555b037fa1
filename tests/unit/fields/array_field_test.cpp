#include "fields/array_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "fields/array/array_function.hpp"
#include "polytopes/polytope.hpp"
#include "unit/fields/array/random_arrays.hpp"

namespace oval4d::fields::test {
namespace {

FieldArray countingArray(const Shape& shape, const Box& box) {
    FieldArray array;
    array.shape = shape;
    array.box = box;
    std::vector<float> samples(sampleCount(shape));
    std::iota(samples.begin(), samples.end(), 0.F);
    array.samples = SampleStorage(std::move(samples));
    return array;
}

// Returns half of the lengths of the field's domain, in the coordinates of the 4-D object.
glm::dvec4 halfOf(const Field& field) { return field.domain->vertices.back(); }

TEST(ArrayField, AnAxisWithOneSampleIsHalfAsLongAsTheLongest) {
    const auto field = fieldFromArray("run", countingArray({3, 2, 2, 1}, {{0, 0, 0, 7}, {20, 10, 5, 7}}));
    ASSERT_TRUE(field) << field.error().message;
    EXPECT_EQ(field->box, (Box{{0, 0, 0, 2}, {20, 10, 5, 12}}));
    EXPECT_EQ(halfOf(*field), glm::dvec4(10, 5, 2.5, 5));
}

TEST(ArrayField, AnAxisWithOneSampleMayBeFarFromZero) {
    constexpr double kTime = 1.7e9, kLevel = -3e7;  // kTime may be in seconds since 1970
    const auto moment = fieldFromArray("run", countingArray({3, 2, 2, 1}, {{0, 0, 0, kTime}, {20, 10, 5, kTime}}));
    ASSERT_TRUE(moment) << moment.error().message;
    EXPECT_LT(glm::distance(halfOf(*moment), glm::dvec4(10, 5, 2.5, 5)), 1e-9);
    EXPECT_DOUBLE_EQ(moment->center.w, kTime);
    const auto level = fieldFromArray("run", countingArray({3, 2, 1, 2}, {{0, 0, kLevel, 0}, {20, 10, kLevel, 1}}));
    ASSERT_TRUE(level) << level.error().message;
    EXPECT_LT(glm::distance(halfOf(*level), glm::dvec4(10, 5, 5, 10)), 1e-9);
    EXPECT_DOUBLE_EQ(level->center.z, kLevel);
    for (const Field& field : {*moment, *level}) {
        for (const glm::dvec4& vertex : field.domain->vertices) {
            const glm::dvec4 p = field.center + field.toFunction * vertex;
            const double z = field.array->shape()[2] == 2 && vertex.z > 0 ? 6 : 0;
            const double w = field.array->shape()[3] == 2 && vertex.w > 0 ? 6 : 0;
            EXPECT_NEAR(valueAt(*field.function, p), (vertex.x > 0 ? 2 : 0) + (vertex.y > 0 ? 3 : 0) + z + w, 1e-5);
        }
        for (glm::length_t axis = 0; axis < 4; ++axis) {
            const auto least = static_cast<float>(field.box.min[axis]), most = static_cast<float>(field.box.max[axis]);
            EXPECT_GT(most - least, 1000 * (std::nextafter(most, 2 * most) - most));  // 32-bit floats distinguish many
                                                                                      // points of the box
        }
    }
}

TEST(ArrayField, UnitsAreKeptInFramesOfReferenceAndShortened) {
    FieldArray array = countingArray({3, 2, 2, 2}, {glm::dvec4(0), glm::dvec4(1)});
    array.units = {"m", "m", "m", "s"};
    array.quantity = {"temperature", "K"};
    auto field = fieldFromArray("run", array);
    ASSERT_TRUE(field) << field.error().message;
    FieldArray second = array;
    second.quantity = {"pressure", "Pa"};
    ASSERT_FALSE(setSecondArray(*field, second, "p"));
    const Field image = transformedTo(*field, {.pace = 2, .boost = {0.5, 0, 0}}, geometry::nextSerial());
    for (const Field& each : {*field, image}) {
        EXPECT_EQ(each.units, array.units);
        EXPECT_EQ(each.quantity, array.quantity);
        EXPECT_EQ(each.second->quantity, second.quantity);
    }
    array.units[0] = std::string(100'000, 'm');
    array.quantity = {"\xff", std::string(100'000, 'K')};
    const auto hostile = fieldFromArray("run", array);
    ASSERT_TRUE(hostile) << hostile.error().message;
    EXPECT_LE(hostile->units[0].size(), kMaxQuantityText);
    EXPECT_EQ(hostile->quantity.name, "?");
    EXPECT_LE(hostile->quantity.unit.size(), kMaxQuantityText);
}

}  // namespace
}  // namespace oval4d::fields::test
