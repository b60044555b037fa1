#include "render/solids.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <glm/geometric.hpp>

#include "render/colour.hpp"

namespace oval4d::render {

namespace {

// Thinner than this a shape would fall between pixels: it is drawn so wide, and fainter instead.
constexpr float kThinnest = 0.6f;  // radius, in pixels
constexpr float kFaintest = 0.02f;
// Thinner bars than this need no foot.
constexpr float kThinnestFoot = 1.8f;  // radius, in pixels

struct Thickness {
    float scale;  ///< of the radius
    float alpha;
    float half;   ///< half the radius in pixels
    float reach;  ///< the u at which the silhouette has faded to nothing
};

/// `dimensions` is in how many directions the shape is thin: 1 for a bar, 2 for a ball.
Thickness thickness(float pixels, int dimensions) {
    Thickness t{1, 1, 0.5f * pixels, 0};
    if (pixels < kThinnest) {
        const float part = pixels / kThinnest;
        t = {1 / part, dimensions == 2 ? part * part : part, 0.5f * kThinnest, 0};
    }
    t.reach = std::sqrt(1 + 0.5f / t.half);
    return t;
}

}  // namespace

void Solids::begin(const scene::Style& style) {
    light_ = glm::normalize(glm::vec3(style.light));
    half_ = glm::normalize(light_ + glm::vec3(0, 0, 1));
    diffuse_ = static_cast<float>(style.diffuse);
    clear();
}

void Solids::clear() {
    vertices_.clear();
    indices_.clear();
}

void Solids::quad(const std::array<glm::vec3, 4>& corners, float u, float v, SolidVertex vertex) {
    const auto first = static_cast<std::uint32_t>(vertices_.size());
    for (std::uint32_t i = 0; i < 4; ++i) {
        vertex.clip = corners[i];
        vertex.place.x = i & 1 ? u : -u;
        vertex.place.y = i & 2 ? v : -v;
        vertices_.push_back(vertex);
    }
    for (const std::uint32_t i : {0u, 1u, 2u, 2u, 1u, 3u}) indices_.push_back(first + i);
}

void Solids::ball(const glm::vec3& centre, float radius, scene::Colour colour, float opacity) {
    const float distance2 = glm::dot(centre, centre), inside2 = distance2 - radius * radius;
    if (centre.z > -radius || inside2 <= 0) return;  // the eye is in it, or before it
    const Thickness size = thickness(radius * lens_.pixelsPerUnit() / -centre.z, 2);
    if (size.alpha * opacity < kFaintest) return;
    const glm::vec3 z = -centre / std::sqrt(distance2);
    const glm::vec3 x = glm::normalize(glm::vec3(z.z, 0, -z.x));
    const glm::vec3 y = glm::cross(z, x);

    // The cone from the eye that touches the sphere, where it passes through the centre.
    const float silhouette = radius * size.scale * std::sqrt(distance2 / inside2) * size.reach;
    const glm::vec3 c = lens_.clip(centre), dx = lens_.clip(x) * silhouette, dy = lens_.clip(y) * silhouette;
    quad({c - dx - dy, c + dx - dy, c - dx + dy, c + dx + dy}, size.reach, size.reach,
         {{},
          {0, 0, size.half},
          diffuse_ * glm::vec3(glm::dot(x, light_), glm::dot(y, light_), glm::dot(z, light_)),
          {glm::dot(x, half_), glm::dot(y, half_), glm::dot(z, half_)},
          rgba(colour, size.alpha * opacity)});
}

void Solids::bar(const glm::vec3& from, const glm::vec3& to, float radius, scene::Colour colour, float opacity) {
    if (from.z > -radius || to.z > -radius) return;
    // The eye and the bar's axis lie in a plane with normal n. The silhouette runs parallel to the axis.
    const glm::vec3 axis = to - from;
    const glm::vec3 n = glm::cross(from, to);
    const float n2 = glm::dot(n, n), axis2 = glm::dot(axis, axis), inside2 = n2 - radius * radius * axis2;
    if (inside2 <= 0) return;  // seen from the end: the ball there hides it
    const Thickness size = thickness(radius * lens_.pixelsPerUnit() / (-0.5f * (from.z + to.z)), 1);
    if (size.alpha * opacity < kFaintest) return;
    const glm::vec3 x = n / std::sqrt(n2);
    glm::vec3 z = glm::cross(x, axis) / std::sqrt(axis2);
    if (glm::dot(z, from) > 0) z = -z;

    const glm::vec3 dx = lens_.clip(x) * (radius * size.scale * std::sqrt(n2 / inside2) * size.reach);
    const glm::vec3 a = lens_.clip(from), b = lens_.clip(to);
    const SolidVertex vertex{{},
                             {0, 0, size.half},
                             diffuse_ * glm::vec3(glm::dot(x, light_), 0, glm::dot(z, light_)),
                             {glm::dot(x, half_), 0, glm::dot(z, half_)},
                             rgba(colour, size.alpha * opacity)};
    const auto first = static_cast<std::uint32_t>(vertices_.size());
    quad({a - dx, a + dx, b - dx, b + dx}, size.reach, 0, vertex);
    if (2 * size.half < kThinnestFoot) return;
    // The foot: the near half of the circle that the bar's end is, beyond the straight cut.
    const glm::vec3 foot = a + lens_.clip(z) * (radius * size.reach);
    const auto last = static_cast<std::uint32_t>(vertices_.size());
    for (const float side : {-1.0f, 1.0f}) {
        vertices_.push_back(vertex);
        vertices_.back().clip = foot + side * dx;
        vertices_.back().place = {side * size.reach, size.reach, size.half};
    }
    for (const std::uint32_t i : {last, last + 1, first, first, last + 1, first + 1}) indices_.push_back(i);
}

void Solids::face(std::span<const glm::vec3> corners, const glm::vec3& normal, scene::Colour colour, float opacity,
                  bool soft) {
    const auto first = static_cast<std::uint32_t>(vertices_.size());
    const auto count = static_cast<std::uint32_t>(corners.size());
    const float lit = diffuse_ * std::abs(glm::dot(normal, light_));
    const SolidVertex vertex{{}, {0, 0, 0.5f}, {0, 0, lit}, {0, 0, 0}, rgba(colour, opacity)};
    for (const glm::vec3& corner : corners) {
        vertices_.push_back(vertex);
        vertices_.back().clip = lens_.clip(corner);
    }
    if (soft) soften(first, count);
    for (std::uint32_t i = 2; i < count; ++i)
        for (const std::uint32_t k : {0u, i - 1, i}) indices_.push_back(first + k);
}

/// Moves the face's edges half a pixel inward, and adds a rim from there that fades half a pixel outward.
void Solids::soften(std::uint32_t first, std::uint32_t count) {
    const glm::vec2 halfSize{0.5f * lens_.width, 0.5f * lens_.height};
    pixels_.clear();
    float area = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3& c = vertices_[first + i].clip;
        if (c.z <= 0) return;
        pixels_.push_back(glm::vec2(c.x, c.y) / c.z * halfSize);
        if (i > 0) area += pixels_[i - 1].x * pixels_[i].y - pixels_[i - 1].y * pixels_[i].x;
    }
    area += pixels_[count - 1].x * pixels_[0].y - pixels_[count - 1].y * pixels_[0].x;
    const auto inward = [&](const glm::vec2& a, const glm::vec2& b) {
        const glm::vec2 d = b - a;
        const float length = std::max(glm::length(d), 1e-6f) * (area < 0 ? -1.0f : 1.0f);
        return glm::vec2(-d.y, d.x) / length;
    };
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec2 before = inward(pixels_[(i + count - 1) % count], pixels_[i]);
        const glm::vec2 after = inward(pixels_[i], pixels_[(i + 1) % count]);
        // A sharp corner's mitre is cut off at twice the rim's width.
        const glm::vec2 mitre = (before + after) / std::max(1 + glm::dot(before, after), 0.5f);
        SolidVertex outer = vertices_[first + i];
        const glm::vec2 step = 0.5f * mitre / halfSize * outer.clip.z;
        vertices_[first + i].clip += glm::vec3(step, 0);
        outer.clip -= glm::vec3(step, 0);
        outer.place.z = -0.5f;
        vertices_.push_back(outer);
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t next = (i + 1) % count;
        for (const std::uint32_t k : {i, next, count + i, count + i, next, count + next}) indices_.push_back(first + k);
    }
}

namespace {

constexpr std::string_view kVertexSource = R"(
layout(location = 0) in vec3 clip;
layout(location = 1) in vec3 placeIn;
layout(location = 2) in vec3 diffuseIn;
layout(location = 3) in vec3 specularIn;
layout(location = 4) in vec4 colourIn;
uniform vec3 toDepth;
// Not for the perspective: a patch is so slender that it makes no difference, and pixels cost less.
noperspective out vec3 place;
flat out vec3 diffuse, specular;
flat out vec4 colour;
void main() {
    place = placeIn;
    diffuse = diffuseIn;
    specular = specularIn;
    colour = colourIn;
    gl_Position = vec4(clip.xy, toDepth.x * clip.z + toDepth.y, clip.z);
}
)";

/// pow(h, shininess); by squaring where that is exact, since logarithm and exponential cost more than all the rest.
std::string highlight(double shininess) {
    int squarings = 0;
    while (std::exp2(squarings) < shininess) ++squarings;
    if (std::exp2(squarings) != shininess) return "h = pow(h, " + std::to_string(shininess) + ");\n";
    std::string code;
    for (int i = 0; i < squarings; ++i) code += "h *= h;\n";
    return code;
}

// A body rises from its patch toward the eye by its radius, which is 2 place.z pixels, times n.z.
constexpr std::string_view kRoundDepth = R"(
    gl_FragDepth = 0.5 + 0.5 * (toDepth.x + toDepth.y * gl_FragCoord.w / (1.0 - toDepth.z * place.z * n.z));
)";

std::string fragmentSource(const scene::Style& style, SolidProgram::Depth depth) {
    return R"(
uniform vec3 toDepth;
noperspective in vec3 place;
flat in vec3 diffuse, specular;
flat in vec4 colour;
out vec4 pixel;
void main() {
    float q = 1.0 - dot(place.xy, place.xy);
    vec3 n = vec3(place.xy, sqrt(max(q, 0.0)));
    float h = max(dot(n, specular), 0.0);
    )" + highlight(style.shininess) +
           "vec3 lit = colour.rgb * (" + std::to_string(style.ambient) + " + max(dot(n, diffuse), 0.0)) + " +
           std::to_string(style.specular) + R"( * h;
    float alpha = colour.a * clamp(q * place.z + 0.5, 0.0, 1.0);
    pixel = vec4(min(lit, 1.0) * alpha, alpha);
)" + std::string(depth == SolidProgram::Depth::round ? kRoundDepth : "") +
           "}\n";
}

constexpr Attribute kAttributes[] = {{3, GL_FLOAT, offsetof(SolidVertex, clip)},
                                     {3, GL_FLOAT, offsetof(SolidVertex, place)},
                                     {3, GL_FLOAT, offsetof(SolidVertex, diffuse)},
                                     {3, GL_FLOAT, offsetof(SolidVertex, specular)},
                                     {4, GL_UNSIGNED_BYTE, offsetof(SolidVertex, colour)}};

}  // namespace

SolidProgram::SolidProgram(const scene::Style& style, Depth depth)
    : program_(kVertexSource, fragmentSource(style, depth), sizeof(SolidVertex), kAttributes),
      toDepth_(program_.uniform("toDepth")) {}

void SolidProgram::draw(const Solids& solids) { draw(solids, 0, 0); }

// The depth −1 … 1 is linear in 1 / distance: then it is linear on the picture of a plane.
void SolidProgram::drawWithin(Range range, const Solids& solids) {
    const float offset = 2 / (1 / range.to - 1 / range.from);
    draw(solids, 1 - offset / range.to, offset);
}

void SolidProgram::draw(const Solids& solids, float scale, float offset) {
    program_.use();
    glUniform3f(toDepth_, scale, offset, 2 / solids.lens().pixelsPerUnit());
    program_.draw(solids.vertices().data(), solids.vertices().size(), solids.indices());
}

}  // namespace oval4d::render
