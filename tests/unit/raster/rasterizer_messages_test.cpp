// The messages with which the server orders pictures from a rasterizer process.

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <string_view>

#include "raster/rasterizer_messages.hpp"
#include "unit/session/setting_values.hpp"

namespace oval4d::raster {
namespace {

/// Expects that what affects the picture of a state comes as it was.
void expectToCome(const session::State& state) {
    std::string bytes;
    encodeRequest(state, {640, 360}, slicing::Quality::draft, {7, 8}, bytes);
    DrawRequest order;
    decodeRequest(bytes, order);
    EXPECT_EQ(order.source, slicing::infoOf(state.source).serial);
    EXPECT_EQ(order.object, slicing::infoOf(state.object).serial);
    EXPECT_EQ(order.state.referenceFrame, state.referenceFrame);
    EXPECT_EQ(order.state.orientation, state.orientation);
    EXPECT_EQ(order.state.slices, state.slices);
    EXPECT_EQ(order.state.look, state.look);
    EXPECT_EQ(order.viewport, (scene::Viewport{640, 360}));
    EXPECT_EQ(order.quality, slicing::Quality::draft);
    EXPECT_EQ(order.limits.fillSteps, 7U);
    EXPECT_EQ(order.limits.objectBytes, 8U);
}

TEST(RasterizerMessages, OrdersComeAsTheyWere) {
    for (const session::SettingValue& setting : session::settingValues()) {
        SCOPED_TRACE(setting.name);
        expectToCome(sessionWith(setting).current);
    }
}

TEST(RasterizerMessages, BytesCutShortAreRefused) {
    std::string bytes;
    encodeRequest(session::initialState(), {640, 360}, slicing::Quality::full, {}, bytes);
    DrawRequest order;
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_THROW(decodeRequest(std::string_view(bytes).substr(0, size), order), std::runtime_error);
}

}  // namespace
}  // namespace oval4d::raster
