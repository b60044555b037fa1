#include "scene/style.hpp"

#include <glm/geometric.hpp>

namespace oval4d::scene {

namespace {

PictureStyle styleOnDark() {
    return {
        .background = 0x10141c,
        .text = 0x9fabbd,
        .focusText = 0xffffff,
        .ball = 0xf3ede0,
        .bar = 0xb9c4d6,
        .zeroLine = 0x3a4456,
        .backgroundOpacity = 1,
        .axes = {0xff5f5f, 0x5fd37a, 0x5c9dff, 0xffd84d},
        .highlight = 0xff4fb8,
        .faceOpacity = 0.46,
        .light = glm::normalize(glm::dvec3(-0.35, 0.6, 0.72)),
        .ambient = 0.45,
        .diffuse = 0.6,
        .specular = 0.35,
        .shininess = 32,
        .textHeight = 0.0215,
    };
}

PictureStyle styleOnLight(Color background, double opacity) {
    PictureStyle style = styleOnDark();
    style.background = background;
    style.backgroundOpacity = opacity;
    style.text = 0x4a5463;
    style.focusText = 0x10141c;
    style.ball = 0x2b3340;
    style.bar = 0x566173;
    style.zeroLine = 0x7a8596;
    style.axes = {0xc62828, 0x1e7a34, 0x1f5fd0, 0x8a6100};
    style.highlight = 0xc2187f;
    style.faceOpacity = 0.55;  // translucent colors are paler on a light background
    return style;
}

}  // namespace

const PictureStyle& style(Background background) {
    constexpr Color kPaleGround = 0xf4f6f9, kWhite = 0xffffff;
    static const PictureStyle kDark = styleOnDark();
    static const PictureStyle kLight = styleOnLight(kPaleGround, 1), kPaper = styleOnLight(kWhite, 1);
    static const PictureStyle kTransparent = styleOnLight(kWhite, 0);
    switch (background) {
        case Background::light:
            return kLight;
        case Background::white:
            return kPaper;
        case Background::transparent:
            return kTransparent;
        case Background::automatic:
        case Background::dark:
            break;
    }
    return kDark;
}

}  // namespace oval4d::scene
