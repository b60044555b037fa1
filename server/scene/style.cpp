#include "scene/style.hpp"

#include <glm/geometric.hpp>

namespace oval4d::scene {

const Style& style() {
    static const Style kStyle{
        .background = 0x10141c,
        .text = 0x9fabbd,
        .focusText = 0xffffff,
        .ball = 0xf3ede0,
        .bar = 0xb9c4d6,
        .zeroLine = 0x3a4456,
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
    return kStyle;
}

}  // namespace oval4d::scene
