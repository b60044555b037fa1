// Tests of the fixed colors of pictures: they keep their contrast on every background.

#include "scene/style.hpp"

#include <gtest/gtest.h>

#include "scene/composer.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::scene {
namespace {

TEST(PictureStyle, ContrastsWithEveryBackground) {
    for (const auto& [name, background] : kBackgrounds) {
        SCOPED_TRACE(name);
        const PictureStyle& s = style(background);
        for (const Color text : {s.text, s.focusText, s.axes[0], s.axes[1], s.axes[2], s.axes[3]})
            EXPECT_GE(contrast(text, s.background), 4.5) << std::hex << text;
        for (const Color shape : {s.ball, s.bar, s.highlight})
            EXPECT_GE(contrast(shape, s.background), 3) << std::hex << shape;
        EXPECT_GE(contrast(s.zeroLine, s.background), schemeForBackground(background) == ColorScheme::dark ? 1.5 : 3);
        EXPECT_EQ(s.backgroundOpacity, background == Background::transparent ? 0 : 1);
    }
}

TEST(PictureStyle, WhiteAndTransparentDifferOnlyInTheBackground) {
    const PictureStyle &white = style(Background::white), &none = style(Background::transparent);
    EXPECT_EQ(white.background, 0xffffffU);
    EXPECT_EQ(none.background, white.background);
    EXPECT_EQ(none.text, white.text);
    EXPECT_EQ(none.bar, white.bar);
    EXPECT_EQ(style(Background::automatic).background, style(Background::dark).background);
    EXPECT_EQ(style(Background::light).text, white.text);
}

TEST(ColorScheme, IsThatOfTheViewerIfTheBackgroundIsAutomatic) {
    EXPECT_EQ(schemeForBackground(Background::automatic), ColorScheme::dark);
    EXPECT_EQ(schemeForBackground(Background::automatic, ColorScheme::light), ColorScheme::light);
    EXPECT_EQ(schemeForBackground(Background::dark, ColorScheme::light), ColorScheme::dark);
    for (const Background background : {Background::light, Background::white, Background::transparent})
        EXPECT_EQ(schemeForBackground(background, ColorScheme::dark), ColorScheme::light);
}

// The colors of a scene change with its background, even if the composer is reused.
TEST(Composer, ChangesTheColorsWithTheBackground) {
    Composer composer;
    Scene reused;
    slicing::SliceSet slices;
    const auto object = support::objectOf(support::named("24-cell"));
    slicing::CellComplexSlicer().slice(support::named("24-cell"), {}, {-1, 3, 1}, slices);
    Look look;
    look.highlight = slicing::Element{slicing::ElementKind::cell, 3};
    for (const Background background :
         {Background::dark, Background::white, Background::automatic, Background::light}) {
        look.background = background;
        composer.compose(object, {}, slices, 0, look, {}, reused);
        Scene fresh;
        Composer().compose(object, {}, slices, 0, look, {}, fresh);
        EXPECT_EQ(reused.cellColors, fresh.cellColors);
        EXPECT_EQ(reused.cellColors[3], style(background).highlight);
        EXPECT_EQ(reused.faceOpacity, style(background).faceOpacity);
        EXPECT_EQ(&reused.style(), &style(background));
    }
}

}  // namespace
}  // namespace oval4d::scene
