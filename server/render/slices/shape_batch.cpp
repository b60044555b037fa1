#include "render/slices/shape_batch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "render/color.hpp"

namespace oval4d::render {

namespace {

// The minimum radius of a shape in pixels. A thinner shape could miss all pixel centers. So it is drawn with this
// radius, but with a lower opacity.
constexpr float kMinRadius = 0.6f;
constexpr float kMinAlpha = 0.02f;  // shapes with a lower opacity are not drawn
// The minimum radius of a bar with a foot, in pixels (see ShapeBatch::addBarFromFarEnd()).
constexpr float kMinFootRadius = 1.8f;

/// How a shape is changed so that its radius is at least kMinRadius pixels.
struct ClampedRadius {
    float scale;          ///< the factor by which the radius is multiplied
    float opacityFactor;  ///< the factor by which the opacity is multiplied
    float halfPixels;     ///< half the increased radius in pixels
    float edgeU;          ///< the coordinate u, greater than 1, at which the coverage becomes 0
};

/// Returns the changes to a shape whose radius is `pixels` pixels, so that it is drawn with a radius of at least
/// kMinRadius. `dimensions` is the number of directions in which the shape is thin: 1 for a bar and 2 for a ball.
ClampedRadius clampedRadius(float pixels, int dimensions) {
    ClampedRadius clamped{1, 1, 0.5f * pixels, 0};
    if (pixels < kMinRadius) {
        const float part = pixels / kMinRadius;
        clamped = {1 / part, dimensions == 2 ? part * part : part, 0.5f * kMinRadius, 0};
    }
    clamped.edgeU = std::sqrt(1 + 0.5f / clamped.halfPixels);
    return clamped;
}

}  // namespace

void ShapeBatch::begin(const scene::PictureStyle& style) {
    light_ = glm::normalize(glm::vec3(style.light));
    halfVector_ = glm::normalize(light_ + glm::vec3(0, 0, 1));
    ambient_ = static_cast<float>(style.ambient);
    diffuse_ = static_cast<float>(style.diffuse);
    clear();
}

void ShapeBatch::clear() {
    vertices_.clear();
    patches_.clear();
}

void ShapeBatch::add(std::initializer_list<ShapeVertex> vertices, Patch::Form form) {
    const auto first = static_cast<std::uint32_t>(vertices_.size());
    vertices_.insert(vertices_.end(), vertices);
    addPatch(first, form);
}

/// Adds the patch (a flat polygon) with the vertices from index `first` to the last vertex in vertices_.
void ShapeBatch::addPatch(std::uint32_t first, Patch::Form form) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const auto vertices = std::span(vertices_).subspan(first);
    Patch patch{first, static_cast<std::uint32_t>(vertices.size()), form, glm::vec2(kInfinity), glm::vec2(-kInfinity)};
    for (const ShapeVertex& vertex : vertices) {
        const glm::vec2 at = glm::vec2(vertex.clip) * (1 / vertex.clip.z);
        if (!(vertex.clip.z >= kNearPlane) || std::isnan(at.x + at.y)) {
            patch.least = glm::vec2(-kInfinity);
            patch.greatest = glm::vec2(kInfinity);
            break;
        }
        patch.least = glm::min(patch.least, at);
        patch.greatest = glm::max(patch.greatest, at);
    }
    patches_.push_back(patch);
}

void ShapeBatch::addBall(const glm::vec3& center, float radius, scene::Color color, float opacity) {
    const float distance2 = glm::dot(center, center), inside2 = distance2 - radius * radius;
    if (center.z > -radius || inside2 <= 0) return;  // the ball contains the eye or is behind it
    const ClampedRadius size = clampedRadius(radius * projection_.focalLengthInPixels() / -center.z, 2);
    if (size.opacityFactor * opacity < kMinAlpha) return;
    const glm::vec3 z = -center / std::sqrt(distance2);
    const glm::vec3 x = glm::normalize(glm::vec3(z.z, 0, -z.x));
    const glm::vec3 y = glm::cross(z, x);

    // The radius of the silhouette: at the center of the ball, the radius of the cone from the eye that is tangent to
    // the ball. The factor size.edgeU adds room for the antialiased edge.
    const float silhouette = radius * size.scale * std::sqrt(distance2 / inside2) * size.edgeU;
    const glm::vec3 c = projection_.clipXyw(center), dx = projection_.clipXyw(x) * silhouette,
                    dy = projection_.clipXyw(y) * silhouette;
    const glm::vec3 diffuse = diffuse_ * glm::vec3(glm::dot(x, light_), glm::dot(y, light_), glm::dot(z, light_));
    const glm::vec3 specular(glm::dot(x, halfVector_), glm::dot(y, halfVector_), glm::dot(z, halfVector_));
    const std::uint32_t tint = rgba(color, size.opacityFactor * opacity);
    const auto corner = [&](float u, float v) {
        return ShapeVertex{
            c + u * dx + v * dy, {u * size.edgeU, v * size.edgeU, size.halfPixels}, diffuse, specular, tint};
    };
    add({corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)}, Patch::Form::disk);
}

void ShapeBatch::addBarFromFarEnd(const glm::vec3& from, const glm::vec3& to, float radius, scene::Color color,
                                  float opacity) {
    if (from.z > -radius || to.z > -radius) return;
    // n is the normal of the plane through the eye and the axis of the bar. The silhouette of the bar consists of two
    // lines parallel to the axis.
    const glm::vec3 axis = to - from;
    const glm::vec3 n = glm::cross(from, to);
    const float n2 = glm::dot(n, n), axis2 = glm::dot(axis, axis), inside2 = n2 - radius * radius * axis2;
    if (inside2 <= 0) return;  // the eye looks along the axis of the bar, so the ball at the near end hides the bar
    const ClampedRadius size = clampedRadius(radius * projection_.focalLengthInPixels() / (-0.5f * (from.z + to.z)), 1);
    if (size.opacityFactor * opacity < kMinAlpha) return;
    const glm::vec3 x = n / std::sqrt(n2);
    glm::vec3 z = glm::cross(x, axis) / std::sqrt(axis2);
    if (glm::dot(z, from) > 0) z = -z;

    const glm::vec3 dx = projection_.clipXyw(x) * (radius * size.scale * std::sqrt(n2 / inside2) * size.edgeU);
    const glm::vec3 a = projection_.clipXyw(from), b = projection_.clipXyw(to);
    const glm::vec3 diffuse = diffuse_ * glm::vec3(glm::dot(x, light_), 0, glm::dot(z, light_));
    const glm::vec3 specular(glm::dot(x, halfVector_), 0, glm::dot(z, halfVector_));
    const std::uint32_t tint = rgba(color, size.opacityFactor * opacity);
    const auto corner = [&](const glm::vec3& at, float u, float v) {
        return ShapeVertex{at + u * dx, {u * size.edgeU, v * size.edgeU, size.halfPixels}, diffuse, specular, tint};
    };
    add({corner(a, -1, 0), corner(a, 1, 0), corner(b, 1, 0), corner(b, -1, 0)}, Patch::Form::strip);
    if (2 * size.halfPixels < kMinFootRadius) return;
    // The end of the cylinder is a circle. In the picture, the half of this circle that is turned to the eye extends
    // beyond the flat end. The foot covers this half.
    const glm::vec3 foot = a + projection_.clipXyw(z) * (radius * size.edgeU);
    add({corner(foot, -1, 1), corner(foot, 1, 1), corner(a, 1, 0), corner(a, -1, 0)}, Patch::Form::disk);
}

void ShapeBatch::addFace(std::span<const glm::vec3> corners, const glm::vec3& normal, scene::Color color, float opacity,
                         bool soft) {
    const auto first = static_cast<std::uint32_t>(vertices_.size());
    const auto count = static_cast<std::uint32_t>(corners.size());
    const float lit = diffuse_ * std::abs(glm::dot(normal, light_));
    const ShapeVertex vertex{{}, {0, 0, 0.5f}, {0, 0, lit}, {0, 0, 0}, rgba(color, opacity)};
    for (const glm::vec3& corner : corners) {
        vertices_.push_back(vertex);
        vertices_.back().clip = projection_.clipXyw(corner);
    }
    addPatch(first, Patch::Form::face);
    if (soft) antialiasFace(first, count);
}

void ShapeBatch::addStroke(glm::vec2 from, glm::vec2 to, float width, scene::Color color, float opacity) {
    const float length = glm::distance(from, to);
    if (!(length > 0)) return;
    const float half = 0.5F * width;
    const glm::vec2 along = (to - from) / length, side = glm::vec2(-along.y, along.x) * (half + 0.5F);
    const std::uint32_t tint = rgba(color, opacity);
    const auto corner = [&](const glm::vec2& at, float inside) {
        const glm::vec2 clip = 2.0F * at / glm::vec2(projection_.width, projection_.height) - 1.0F;
        return ShapeVertex{{clip, 1}, {0, 0, inside}, {0, 0, 1 - ambient_}, {0, 0, 0}, tint};
    };
    // On each side of the axis of the stroke, the coverage falls from the axis to half a pixel outside the edge. At the
    // distance d from the axis, the coverage is width/2 − d + ½, clamped to 0 … 1.
    for (const glm::vec2& outward : {-side, side}) {
        add({corner(from, half), corner(to, half), corner(to + outward, -0.5F), corner(from + outward, -0.5F)},
            Patch::Form::rim);
    }
}

/// Antialiases a face: moves its edges half a pixel inward, and adds a rim. The coverage of the rim falls to zero half
/// a pixel outside the original edges.
void ShapeBatch::antialiasFace(std::uint32_t first, std::uint32_t count) {
    const glm::vec2 halfSize{0.5f * projection_.width, 0.5f * projection_.height};
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
    const auto outer = [&](std::uint32_t i) { return first + count + i; };
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec2 before = inward(pixels_[(i + count - 1) % count], pixels_[i]);
        const glm::vec2 after = inward(pixels_[i], pixels_[(i + 1) % count]);
        // The extension of a sharp corner (its miter) is limited to twice the width of the rim.
        const glm::vec2 miter = (before + after) / std::max(1 + glm::dot(before, after), 0.5f);
        ShapeVertex vertex = vertices_[first + i];
        const glm::vec2 step = 0.5f * miter / halfSize * vertex.clip.z;
        vertices_[first + i].clip += glm::vec3(step, 0);
        vertex.clip -= glm::vec3(step, 0);
        vertex.place.z = -0.5f;
        vertices_.push_back(vertex);
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t next = (i + 1) % count;
        const ShapeVertex a = vertices_[first + i], b = vertices_[first + next];
        const ShapeVertex c = vertices_[outer(next)], d = vertices_[outer(i)];
        add({a, b, d}, Patch::Form::rim);
        add({d, b, c}, Patch::Form::rim);
    }
}

namespace {

constexpr std::string_view kVertexSource = R"(
layout(location = 0) in vec3 clip;
layout(location = 1) in vec3 placeIn;
layout(location = 2) in vec3 diffuseIn;
layout(location = 3) in vec3 specularIn;
layout(location = 4) in vec4 colorIn;
uniform vec3 toDepth;
// `place` is interpolated without a correction for perspective. This is faster, and patches are so narrow that the
// result is almost the same.
noperspective out vec3 place;
flat out vec3 diffuse, specular;
flat out vec4 color;
void main() {
    place = placeIn;
    diffuse = diffuseIn;
    specular = specularIn;
    color = colorIn;
    gl_Position = vec4(clip.xy, toDepth.x * clip.z + toDepth.y, clip.z);
}
)";

/// Returns shader code that replaces h by pow(h, shininess). If the shininess is a power of two, the code squares h
/// repeatedly, because pow would take longer than the rest of the shader.
std::string specularPowerCode(double shininess) {
    int squarings = 0;
    while (std::exp2(squarings) < shininess) ++squarings;
    if (std::exp2(squarings) != shininess) return "h = pow(h, " + std::to_string(shininess) + ");\n";
    std::string code;
    for (int i = 0; i < squarings; ++i) code += "h *= h;\n";
    return code;
}

// A ball or bar is drawn as a flat patch. A point of the ball or bar is closer to the eye than the patch by n.z times
// the radius. In the formula, place.z is half the radius in pixels, and toDepth.z is twice the size of a pixel at the
// distance 1.
constexpr std::string_view kSurfaceDepth = R"(
    gl_FragDepth = 0.5 + 0.5 * (toDepth.x + toDepth.y * gl_FragCoord.w / (1.0 - toDepth.z * place.z * n.z));
)";

std::string fragmentSource(const scene::PictureStyle& style, ShapeProgram::DepthSource depth) {
    return R"(
uniform vec3 toDepth;
noperspective in vec3 place;
flat in vec3 diffuse, specular;
flat in vec4 color;
out vec4 pixel;
void main() {
    float q = 1.0 - dot(place.xy, place.xy);
    vec3 n = vec3(place.xy, sqrt(max(q, 0.0)));
    float h = max(dot(n, specular), 0.0);
    )" + specularPowerCode(style.shininess) +
           "vec3 lit = color.rgb * (" + std::to_string(style.ambient) + " + max(dot(n, diffuse), 0.0)) + " +
           std::to_string(style.specular) + R"( * h;
    float alpha = color.a * clamp(q * place.z + 0.5, 0.0, 1.0);
    pixel = vec4(min(lit, 1.0) * alpha, alpha);
)" + std::string(depth == ShapeProgram::DepthSource::surface ? kSurfaceDepth : "") +
           "}\n";
}

constexpr VertexAttribute kAttributes[] = {{3, GL_FLOAT, offsetof(ShapeVertex, clip)},
                                           {3, GL_FLOAT, offsetof(ShapeVertex, place)},
                                           {3, GL_FLOAT, offsetof(ShapeVertex, diffuse)},
                                           {3, GL_FLOAT, offsetof(ShapeVertex, specular)},
                                           {4, GL_UNSIGNED_BYTE, offsetof(ShapeVertex, color)}};

}  // namespace

ShapeProgram::ShapeProgram(const scene::PictureStyle& style, DepthSource depth)
    : program_(kVertexSource, fragmentSource(style, depth), sizeof(ShapeVertex), kAttributes),
      toDepth_(program_.uniformLocation("toDepth")) {}

void ShapeProgram::draw(const ShapeBatch& shapes) { draw(shapes, 0, 0); }

void ShapeProgram::drawWithDepth(DepthRange range, const ShapeBatch& shapes) {
    const glm::vec2 toDepth = range.toDepth();
    draw(shapes, toDepth.x, toDepth.y);
}

void ShapeProgram::draw(const ShapeBatch& shapes, float scale, float offset) {
    program_.use();
    glUniform3f(toDepth_, scale, offset, 2 / shapes.projection().focalLengthInPixels());
    indices_.clear();
    for (const Patch& patch : shapes.patches()) {
        for (std::uint32_t i = 2; i < patch.count; ++i)
            for (const std::uint32_t k : {0u, i - 1, i}) indices_.push_back(patch.first + k);
    }
    program_.draw(shapes.vertices().data(), shapes.vertices().size(), indices_);
}

}  // namespace oval4d::render
