// What affects the picture of a session's state comes to the rasterizer process.

#include "pipeline/picture_of_state.hpp"

#include <gtest/gtest.h>

#include <string>

#include "raster/rasterizer_messages.hpp"
#include "unit/session/setting_values.hpp"

namespace oval4d::pipeline {
namespace {

TEST(PictureOfState, HasWhatAffectsThePicture) {
    for (const session::SettingValue& setting : session::settingValues()) {
        SCOPED_TRACE(setting.name);
        const session::State state = sessionWith(setting).current;
        raster::PictureRequest picture;
        writePictureOfState(state, {640, 360}, slicing::Quality::draft, picture);
        EXPECT_EQ(picture.source, state.source);
        EXPECT_EQ(picture.referenceFrame, state.referenceFrame);
        EXPECT_EQ(picture.object, state.object);
        EXPECT_EQ(picture.orientation, state.orientation);
        EXPECT_EQ(picture.planes, state.hyperplanes());
        EXPECT_EQ(picture.focus, state.slices.focus);
        EXPECT_EQ(picture.look, state.look);
        EXPECT_EQ(picture.viewport, (scene::Viewport{640, 360}));
        EXPECT_EQ(picture.quality, slicing::Quality::draft);
    }
}

TEST(PictureOfState, ComesToTheRasterizerAsItWas) {
    for (const session::SettingValue& setting : session::settingValues()) {
        SCOPED_TRACE(setting.name);
        raster::PictureRequest picture;
        writePictureOfState(sessionWith(setting).current, {640, 360}, slicing::Quality::draft, picture);
        std::string bytes;
        encodeRequest(picture, {7, 8}, bytes);
        raster::DrawRequest order;
        decodeRequest(bytes, order);
        EXPECT_EQ(order.source, slicing::infoOf(picture.source).serial);
        EXPECT_EQ(order.object, slicing::infoOf(picture.object).serial);
        order.picture.source = picture.source;
        order.picture.object = picture.object;
        EXPECT_TRUE(order.picture == picture);
        EXPECT_EQ(order.limits.fillSteps, 7U);
        EXPECT_EQ(order.limits.objectBytes, 8U);
    }
}

}  // namespace
}  // namespace oval4d::pipeline
