#include "fields/axis_units.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "fields/array_field.hpp"
#include "fields/formula_field.hpp"

namespace oval4d::fields::test {
namespace {

using geometry::Plane;
using geometry::Rotation;
using geometry::RotationAngles;

Field fieldWith(const AxisUnits& units) {
    FieldArray array;
    array.shape = {2, 2, 2, 2};
    array.box = {glm::dvec4(0), glm::dvec4(1, 1, 1, 5)};  // the 4-D object of the field is as long along w as along x
    array.samples = SampleStorage(std::vector<float>(16, 1));
    array.units = units;
    return *fieldFromArray("run", array);
}

const PictureAxisUnit kMeters{"m", true}, kSeconds{"s", false}, kUnknown{};

TEST(AxisUnits, AreThoseOfTheBoxWithoutARotation) {
    EXPECT_EQ(pictureUnits(fieldWith({"m", "km", "", "s"}), {}),
              (PictureUnits{kMeters, PictureAxisUnit{"km", true}, kUnknown, kSeconds}));
    EXPECT_EQ(pictureUnits(fieldWith({}), {}), PictureUnits());
}

TEST(AxisUnits, AreUnknownWhereAxesWithDifferentUnitsAreMixed) {
    const Field field = fieldWith({"m", "m", "m", "s"});
    EXPECT_EQ(pictureUnits(field, Rotation(RotationAngles{Plane::xy, 0.3})),
              (PictureUnits{kMeters, kMeters, kMeters, kSeconds}));
    EXPECT_EQ(pictureUnits(field, Rotation(RotationAngles{Plane::xw, 0.3})),
              (PictureUnits{kUnknown, kMeters, kMeters, kUnknown}));
    const PictureUnits quarter = pictureUnits(field, Rotation(RotationAngles{Plane::xw, std::numbers::pi / 2}));
    EXPECT_EQ(quarter, (PictureUnits{kSeconds, kMeters, kMeters, kMeters})) << "the axes change places";
    const PictureUnits oneUnknown =
        pictureUnits(fieldWith({"m", "", "m", "s"}), Rotation(RotationAngles{Plane::xy, 0.3}));
    EXPECT_EQ(oneUnknown, (PictureUnits{kUnknown, kUnknown, kMeters, kSeconds}));
}

TEST(AxisUnits, FollowTheFrameOfReference) {
    const auto seen = [](const geometry::ReferenceFrame& frame) {
        return pictureUnits(transformedTo(fieldWith({"m", "m", "m", "s"}), frame, geometry::nextSerial()), {});
    };
    const auto fast = seen({.pace = 2});
    EXPECT_EQ(fast, (PictureUnits{kMeters, kMeters, kMeters, kSeconds}));
    EXPECT_EQ(seen({.pace = 5})[3], (PictureAxisUnit{"s", true})) << "the time takes 5 s, and the object is 1 long";
    EXPECT_EQ(seen({.boost = {0.5, 0, 0}}), (PictureUnits{kUnknown, kMeters, kMeters, kUnknown}));
}

TEST(ConstantSliceCoordinate, IsTheMomentUntilTimeIsMixedWithSpace) {
    const Field field = fieldWith({});
    for (const Rotation& turned : {Rotation(), Rotation(RotationAngles{Plane::xy, 0.3})}) {
        const auto moment = constantSliceCoordinate(field, turned);
        ASSERT_TRUE(moment);
        EXPECT_EQ(moment->axis, 3);
        EXPECT_NEAR(moment->coordinateAt(-0.5), 0, 1e-12);
        EXPECT_NEAR(moment->coordinateAt(0.5), 5, 1e-12) << "as an object, the field is 1 long along w";
        EXPECT_FALSE(moment->isW());
    }
    EXPECT_FALSE(constantSliceCoordinate(field, Rotation(RotationAngles{Plane::xw, 0.3})));
    const auto place = constantSliceCoordinate(field, Rotation(RotationAngles{Plane::xw, std::numbers::pi / 2}));
    ASSERT_TRUE(place);
    EXPECT_EQ(place->axis, 0);
    EXPECT_NEAR(place->center, 0.5, 1e-12);
    EXPECT_NEAR(std::abs(place->scale), 1, 1e-12);
    const auto seen = [&](const geometry::ReferenceFrame& frame) {
        return constantSliceCoordinate(transformedTo(field, frame, geometry::nextSerial()), {});
    };
    ASSERT_TRUE(seen({.pace = 2}));
    EXPECT_NEAR(seen({.pace = 2})->coordinateAt(1), 5, 1e-12);
    ASSERT_TRUE(seen({.follow = {0.5, 0, 0}}));
    EXPECT_NEAR(seen({.follow = {0.5, 0, 0}})->coordinateAt(0.5), 5, 1e-12);
    EXPECT_FALSE(seen({.boost = {0.5, 0, 0}}));
    const Field formula = *fieldFromFormula("f", "x", {glm::dvec4(-1), glm::dvec4(1)});
    EXPECT_TRUE(constantSliceCoordinate(formula, {})->isW());
}

TEST(PlaceInBox, IsTheMomentOrThePlaceOfASlice) {
    const Rotation quarter(RotationAngles{Plane::xw, std::numbers::pi / 2}), oblique(RotationAngles{Plane::xw, 0.3});
    const Field known = fieldWith({"m", "m", "m", "s"}), unknown = fieldWith({});
    EXPECT_EQ(constantSliceCoordinateText(known, {}, 0.25, 0.1), "3.75 s")
        << "w goes from −0.5 to 0.5 while the time goes from 0 to 5 s";
    EXPECT_EQ(constantSliceCoordinateText(known, {}, 0.2512345, 0.1), "3.76 s");
    EXPECT_EQ(constantSliceCoordinateText(unknown, {}, 0.25, 0.1), "box w = 3.75");
    EXPECT_EQ(constantSliceCoordinateText(known, quarter, 0, 0.1), "box x = 0.5 m");
    EXPECT_EQ(constantSliceCoordinateText(unknown, quarter, 0, 0.1), "box x = 0.5");
    EXPECT_EQ(constantSliceCoordinateText(known, oblique, 0, 0.1), "");
    const Field formula = *fieldFromFormula("f", "x", {glm::dvec4(-1), glm::dvec4(1)});
    EXPECT_EQ(constantSliceCoordinateText(formula, {}, 0.25, 0.1), "");
    EXPECT_EQ(constantSliceCoordinateText(formula, quarter, 0, 0.1), "box x = 0");
}

TEST(AxisUnits, FollowTheNames) {
    EXPECT_EQ(axisLabel(0, kMeters), "x, m");
    EXPECT_EQ(axisLabel(3, kUnknown), "w");
}

}  // namespace
}  // namespace oval4d::fields::test
