// Tests of requests for pictures: all data that affect the picture of a session's state arrive in the rasterizer
// process (which draws the picture).

#include <gtest/gtest.h>

#include <string>

#include "raster/rasterizer_messages.hpp"
#include "session/picture.hpp"
#include "unit/session/setting_values.hpp"

namespace oval4d::pipeline {
namespace {

TEST(PictureRequest, ComesToTheRasterizerAsItWas) {
    for (const session::SettingValue& setting : session::settingValues()) {
        SCOPED_TRACE(setting.name);
        const scene::PictureRequest picture =
            session::pictureRequestOf(sessionWith(setting).current, {640, 360}, slicing::Quality::draft);
        std::string bytes;
        raster::encodeDrawRequest(picture, {7, 8, 9}, bytes);
        raster::DrawRequest order;
        raster::decodeDrawRequest(bytes, order);
        EXPECT_EQ(order.source, slicing::infoOf(picture.source).serial);
        EXPECT_EQ(order.object, slicing::infoOf(picture.object).serial);
        order.picture.source = picture.source;
        order.picture.object = picture.object;
        EXPECT_TRUE(order.picture == picture);
        EXPECT_EQ(order.limits.fillSteps, 7U);
        EXPECT_EQ(order.limits.objectBytes, 8U);
        EXPECT_EQ(order.limits.occlusionSteps, 9U);
    }
}

}  // namespace
}  // namespace oval4d::pipeline
