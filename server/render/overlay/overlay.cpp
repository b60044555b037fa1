#include "render/overlay/overlay.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <glm/geometric.hpp>

#include "render/color.hpp"

namespace oval4d::render {

namespace {

constexpr std::string_view kVertexSource = R"(
layout(location = 0) in vec2 at;
layout(location = 1) in vec2 fromCenterIn;
layout(location = 2) in vec3 boxIn;
layout(location = 3) in vec2 texelIn;
layout(location = 4) in vec4 colorIn;
out vec2 fromCenter, texel;
flat out vec3 box;
flat out vec4 color;
void main() {
    fromCenter = fromCenterIn;
    box = boxIn;
    texel = texelIn;
    color = colorIn;
    gl_Position = vec4(at, 0.0, 1.0);
}
)";

constexpr std::string_view kFragmentSource = R"(
in vec2 fromCenter, texel;
flat in vec3 box;
flat in vec4 color;
uniform sampler2D glyphs;
out vec4 pixel;
void main() {
    vec2 q = abs(fromCenter) - box.xy + box.z;
    float outside = length(max(q, 0.0)) + min(max(q.x, q.y), 0.0) - box.z;
    float coverage = clamp(0.5 - outside, 0.0, 1.0) * texelFetch(glyphs, ivec2(texel), 0).r;
    pixel = vec4(color.rgb, 1.0) * (color.a * coverage);
}
)";

constexpr VertexAttribute kAttributes[] = {{2, GL_FLOAT, offsetof(OverlayVertex, at)},
                                           {2, GL_FLOAT, offsetof(OverlayVertex, fromCenter)},
                                           {3, GL_FLOAT, offsetof(OverlayVertex, box)},
                                           {2, GL_FLOAT, offsetof(OverlayVertex, texel)},
                                           {4, GL_UNSIGNED_BYTE, offsetof(OverlayVertex, color)}};

// Half the width and half the height of the box of a glyph or polygon, in pixels. The box is larger than the picture,
// so that it cuts off nothing.
constexpr float kWide = 1e5f;

}  // namespace

Overlay::Overlay(const std::string& font)
    : program_(kVertexSource, kFragmentSource, sizeof(OverlayVertex), kAttributes), font_(font) {}

void Overlay::begin(scene::Viewport viewport) {
    font_.clearIfLarge();
    vertices_.clear();
    indices_.clear();
    toClip_ = {2.0f / static_cast<float>(viewport.width), 2.0f / static_cast<float>(viewport.height)};
}

void Overlay::quad(const PixelRect& place, const OverlayVertex& vertex, const PixelRect& fromCenter,
                   const PixelRect& texels) {
    const auto first = static_cast<std::uint32_t>(vertices_.size());
    for (unsigned i = 0; i < 4; ++i) {
        const bool right = (i & 1) != 0, top = (i & 2) != 0;
        const auto corner = [&](const PixelRect& r) {
            return glm::vec2(right ? r.right : r.left, top ? r.top : r.bottom);
        };
        OverlayVertex v = vertex;
        v.at = corner(place) * toClip_ - 1.0f;
        v.fromCenter = corner(fromCenter);
        v.texel = corner(texels);
        vertices_.push_back(v);
    }
    for (const std::uint32_t i : {0u, 1u, 2u, 2u, 1u, 3u}) indices_.push_back(first + i);
}

void Overlay::box(const PixelRect& box, scene::Color color, float opacity, float cornerRadius) {
    const glm::vec2 half{0.5f * (box.right - box.left), 0.5f * (box.top - box.bottom)};
    const float x = half.x + 0.5f, y = half.y + 0.5f;  // including a margin of half a pixel for the antialiased edge
    const OverlayVertex vertex{.box = {half, std::min({cornerRadius, half.x, half.y})}, .color = rgba(color, opacity)};
    quad({box.left - 0.5f, box.bottom - 0.5f, box.right + 0.5f, box.top + 0.5f}, vertex, {-x, -y, x, y},
         {0.5f, 0.5f, 0.5f, 0.5f});
}

void Overlay::line(glm::vec2 from, glm::vec2 to, float width, scene::Color color, float opacity) {
    const float length = glm::distance(from, to);
    const glm::vec2 along = length > 0 ? (to - from) / length : glm::vec2(1, 0), across{-along.y, along.x};
    const glm::vec2 half{0.5F * (length + width), 0.5F * width},
        reach = half + 0.5F;  // including half a pixel for the antialiased edge
    const OverlayVertex vertex{.box = {half, half.y}, .color = rgba(color, opacity)};
    const auto first = static_cast<std::uint32_t>(vertices_.size());
    for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {-1, 1}, {1, 1}}) {
        OverlayVertex v = vertex;
        v.fromCenter = glm::vec2(x, y) * reach;
        v.at = (0.5F * (from + to) + v.fromCenter.x * along + v.fromCenter.y * across) * toClip_ - 1.0F;
        vertices_.push_back(v);
    }
    for (const std::uint32_t i : {0u, 1u, 2u, 2u, 1u, 3u}) indices_.push_back(first + i);
}

void Overlay::polygon(std::span<const glm::vec2> corners, scene::Color color, float opacity) {
    const auto first = static_cast<std::uint32_t>(vertices_.size());
    for (const glm::vec2& corner : corners) {
        vertices_.push_back({.at = corner * toClip_ - 1.0F, .box = {kWide, kWide, 0}, .color = rgba(color, opacity)});
    }
    for (std::uint32_t i = 2; i < corners.size(); ++i)
        for (const std::uint32_t corner : {0u, i - 1, i}) indices_.push_back(first + corner);
}

void Overlay::text(float x, float y, int size, std::string_view text, scene::Color color, float opacity) {
    const float left = std::round(x - 0.5f * static_cast<float>(font_.width(size, text))), baseline = std::round(y);
    const OverlayVertex vertex{.box = {kWide, kWide, 0}, .color = rgba(color, opacity)};
    font_.forEachGlyph(size, text, [&](const Glyph& g, int pen) {
        if (g.width == 0) return;
        const auto width = static_cast<float>(g.width), height = static_cast<float>(g.height);
        const float glyphLeft = left + static_cast<float>(pen + g.left), top = baseline + static_cast<float>(g.top);
        const auto texelX = static_cast<float>(g.x), texelY = static_cast<float>(g.y);
        quad({glyphLeft, top - height, glyphLeft + width, top}, vertex, {0, 0, 0, 0},
             {texelX, texelY + height, texelX + width, texelY});
    });
}

void Overlay::draw() {
    if (indices_.empty()) return;
    font_.bindTexture();
    program_.draw(vertices_.data(), vertices_.size(), indices_);
}

}  // namespace oval4d::render
