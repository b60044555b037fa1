#include "session/picture.hpp"

#include <gtest/gtest.h>

#include "unit/session/setting_values.hpp"

namespace oval4d::session {
namespace {

TEST(Picture, HasWhatOfTheStateAffectsIt) {
    for (const SettingValue& setting : settingValues()) {
        SCOPED_TRACE(setting.name);
        const State state = sessionWith(setting).current;
        const scene::PictureRequest picture = pictureRequestOf(state, {640, 360}, slicing::Quality::draft);
        EXPECT_EQ(picture.source, state.source);
        EXPECT_EQ(picture.referenceFrame, state.referenceFrame);
        EXPECT_EQ(picture.object, state.object);
        EXPECT_EQ(picture.orientation, state.orientation);
        EXPECT_EQ(picture.planes, state.hyperplanes());
        EXPECT_EQ(picture.focus, state.slices.focus);
        EXPECT_EQ(picture.focusPlane().w(0), state.focusW());
        EXPECT_EQ(picture.look, state.look);
        EXPECT_EQ(picture.viewport, (scene::Viewport{640, 360}));
        EXPECT_EQ(picture.quality, slicing::Quality::draft);
    }
}

}  // namespace
}  // namespace oval4d::session
