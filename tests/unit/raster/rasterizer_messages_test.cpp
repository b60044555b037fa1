// The messages with which the server orders pictures from a rasterizer process.

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <string_view>

#include "raster/rasterizer_messages.hpp"

namespace oval4d::raster {
namespace {

TEST(RasterizerMessages, OrdersComeAsTheyWere) {
    session::State state = session::initialState();
    state.orientation = geometry::Rotation(geometry::Turn{geometry::Plane::xw, 0.3, 0.2});
    state.referenceFrame = {2, {0.3, 0, 0}, {0, 0.6, 0}};
    state.object = slicing::imageOf(state.source, state.referenceFrame);
    state.slices = {31, 0.125, -2};
    state.look.view = scene::View::single;
    state.look.background = scene::Background::transparent;
    state.look.orbit = {0.5, 0.25, 2};
    state.look.cellTypes = {{1, 3}, {2}};
    state.look.field = {{0.5, 1}, fields::Inside::above, {{-1, 0.5}, {2, 1, 0xff8000}}};
    std::string bytes;
    encodeRequest(state, {640, 360}, slicing::Quality::draft, {7, 8}, bytes);
    DrawRequest order;
    decodeRequest(bytes, order);
    EXPECT_EQ(order.source, slicing::infoOf(state.source).serial);
    EXPECT_EQ(order.object, slicing::infoOf(state.object).serial);
    EXPECT_NE(order.source, order.object);
    EXPECT_EQ(order.state.referenceFrame, state.referenceFrame);
    EXPECT_EQ(order.state.orientation, state.orientation);
    EXPECT_EQ(order.state.slices, state.slices);
    EXPECT_EQ(order.state.look, state.look);
    EXPECT_EQ(order.viewport, (scene::Viewport{640, 360}));
    EXPECT_EQ(order.quality, slicing::Quality::draft);
    EXPECT_EQ(order.limits.fillSteps, 7U);
    EXPECT_EQ(order.limits.objectBytes, 8U);
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
