#include "render/overlay/annotations.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <string_view>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "render/projection.hpp"
#include "scene/density_strip_lines.hpp"

namespace oval4d::render {

namespace {

// The opacity of the bands behind the parallel coordinates of the highlighted element's vertices.
constexpr float kHighlightOpacity = 0.35F;
constexpr float kLevelOpacity = 0.8F;  // the opacity of the lines of levels in the histogram of a field
// Half the width of the mark of the focus slice (the middle one), as a fraction of the picture's height.
constexpr double kFocusReach = 0.009;

/// Returns `fraction` times the height of the picture, in pixels, rounded to an integer; at least 1.
int wholePixels(double fraction, const scene::Scene& scene) {
    return std::max(1, static_cast<int>(std::lround(fraction * scene.viewport.height)));
}

void addLabel(const scene::SlicePlacement& placement, const glm::dmat4& toView, const ViewProjection& projection,
              const scene::Scene& scene, Overlay& overlay) {
    const scene::PictureStyle& style = scene.style();
    const glm::vec3 at(toView * glm::dvec4(placement.labelAt, 1));
    if (at.z >= 0 || placement.label.empty()) return;
    const glm::vec2 pixel = projection.pixel(at);
    const int size = wholePixels(style.textHeight * placement.labelSize, scene);
    const auto digits = static_cast<float>(overlay.font().digitHeight(size));
    const auto width = static_cast<float>(overlay.font().width(size, placement.label));
    const float x = std::round(pixel.x), baseline = std::round(pixel.y - digits);
    // A plate in the background color keeps the label legible where it lies over other slices.
    const float marginX = std::round((placement.focus ? 0.9f : 0.25f) * digits);
    const float marginY = std::round((placement.focus ? 0.6f : 0.13f) * digits),
                half = std::round(0.5f * width) + marginX;
    const PixelRect plate{x - half, baseline - marginY, x + half, baseline + digits + marginY};
    const float corner = 0.5f * (plate.top - plate.bottom);
    overlay.box(plate, style.background, placement.focus ? 0.8f : 0.6f, corner);
    if (placement.focus) overlay.box(plate, style.focusText, 0.16f, corner);
    overlay.text(x, baseline, size, placement.label, placement.focus ? style.focusText : style.text);
}

/// Adds `quantity`, a text that says what the values of a field measure, in the upper left corner of the histogram. A
/// plate behind the text keeps it legible. Does nothing if the text is wider than the histogram.
void addQuantityText(const std::string& quantity, const PixelRect& histogram, int size,
                     const scene::PictureStyle& style, Overlay& overlay) {
    const auto digits = static_cast<float>(overlay.font().digitHeight(size));
    const auto width = static_cast<float>(overlay.font().width(size, quantity));
    const float margin = std::round(0.5F * digits);
    if (quantity.empty() || width + 2 * margin > histogram.right - histogram.left) return;
    const float baseline = histogram.top - margin - digits;
    overlay.box({histogram.left, baseline - margin, histogram.left + width + 2 * margin, histogram.top},
                style.background, 0.6F);
    overlay.text(histogram.left + margin + width / 2, baseline, size, quantity, style.text);
}

/// Adds to the histogram of a field: the axes with their names, the text that says what the values measure, the lines
/// of the levels, and a mark for the focus slice (the middle one) in the panel of w.
void addHistogramAxes(const scene::Scene& scene, Overlay& overlay) {
    const scene::ParallelCoordinatesLayout& layout = scene.coordinates;
    const scene::PictureStyle& style = scene.style();
    const auto height = static_cast<double>(scene.viewport.height);
    const auto thickness = static_cast<float>(wholePixels(layout.lineWidth, scene));
    const auto bottom = static_cast<float>(std::round((layout.zero - layout.amplitude) * height));
    const auto top = static_cast<float>(std::round((layout.zero + layout.amplitude) * height));
    const auto leftOf = [&](int k) {
        return static_cast<float>(std::round((layout.left + k * layout.lineStep) * height));
    };
    const auto width = static_cast<float>(layout.panel * height);
    const int size = wholePixels(style.textHeight * 0.85, scene);
    const auto digits = static_cast<float>(overlay.font().digitHeight(size));
    for (const scene::SlicePlacement& placement : scene.placements) {
        const double reach = scene.histogram.reach[3];
        if (!placement.focus || std::abs(placement.w) > reach) continue;
        const double along = (placement.w / reach + 1) / 2 * layout.panel;
        const auto left =
            static_cast<float>(std::round((layout.left + 3 * layout.lineStep + along) * height - thickness / 2));
        overlay.box({left, bottom, left + thickness, top}, style.focusText);
    }
    for (int k = 0; k < 4; ++k) {
        const float left = leftOf(k);
        for (const scene::HistogramAxes::LevelLine& line : scene.histogram.levelLines) {
            const float at = std::round(
                bottom + static_cast<float>(scene.histogram.heightOf(line.value)) * (top - bottom) - thickness / 2);
            overlay.box({left, at, left + width, at + thickness}, line.color, kLevelOpacity);
        }
        const scene::Color color = style.axes[static_cast<std::size_t>(k)];
        overlay.box({left, bottom - thickness, left + width, bottom}, color);
        const std::string label = fields::axisLabel(k, scene.axisUnits.at(static_cast<std::size_t>(k)));
        const bool fits = static_cast<float>(overlay.font().width(size, label)) <= width;
        overlay.text(left + width / 2, bottom - 1.4F * digits, size,
                     std::string_view(label).substr(0, fits ? label.size() : 1), color);
    }
    addQuantityText(scene.histogram.quantity, {leftOf(0), bottom, leftOf(3) + width, top}, size, style, overlay);
}

/// Adds what is drawn over the density strip: the axes with their names, the lines of the vertices of the highlighted
/// element, and a mark for the focus slice (the middle one) on the w axis. The lines, and the mark over them, are added
/// to `above` (see StrokeTargets).
void addStripAxesAndLines(const scene::Scene& scene, Overlay& overlay, ShapeBatch* above) {
    const scene::ParallelCoordinatesLayout& layout = scene.coordinates;
    const scene::PictureStyle& style = scene.style();
    const auto height = static_cast<double>(scene.viewport.height);
    const auto& colors = style.axes;
    const float thickness = std::max(1.0F, static_cast<float>(std::round(layout.lineWidth * height)));
    const auto levelOf = [&](double value) {
        return static_cast<float>((layout.zero + value * layout.amplitude) * height);
    };
    const auto middleOf = [&](int k) { return (layout.left + k * layout.lineStep + layout.lineWidth / 2) * height; };
    const int size = wholePixels(style.textHeight * 0.85, scene);
    const auto digits = static_cast<float>(overlay.font().digitHeight(size));
    for (int k = 0; k < 4; ++k) {
        const auto left = static_cast<float>(std::round(middleOf(k) - thickness / 2));
        const scene::Color color = colors[static_cast<std::size_t>(k)];
        overlay.box({left, levelOf(-1), left + thickness, levelOf(1)}, color);
        overlay.text(left + thickness / 2, levelOf(-1) - 1.4F * digits, size, std::string_view("xyzw").substr(k, 1),
                     color);
    }
    if (scene.highlight.empty()) above = nullptr;  // if no lines are drawn, add the mark to the overlay
    const auto lineWidth = static_cast<float>(std::max(1.0, layout.lineWidth * height));
    const auto addLine = [&](const glm::vec2& from, const glm::vec2& to) {
        if (above == nullptr) return overlay.line(from, to, lineWidth, style.highlight);
        // The overlay's lines have round ends. A flat end covers as much as a round end if it extends beyond the end
        // point by this length.
        const float beyond = std::numbers::pi_v<float> / 8 * lineWidth;
        const glm::vec2 more = beyond * glm::normalize(to - from);
        above->addStroke(from - more, to + more, lineWidth, style.highlight);
    };
    scene::forEachLineOverDensityStrip(scene.highlight.ownVertices, [&](std::uint32_t v) {
        const glm::dvec4& vertex = scene.slices->rotatedVertices[v];
        const auto pointOn = [&](int k) {
            return glm::vec2(static_cast<float>(middleOf(k)), levelOf(vertex[k] / scene.circumradius));
        };
        for (int k = 0; k < 3; ++k) addLine(pointOn(k), pointOn(k + 1));
    });
    for (const scene::SlicePlacement& placement : scene.placements) {
        if (!placement.focus || std::abs(placement.w) > scene.circumradius) continue;
        const auto middle = static_cast<float>(middleOf(3)), reach = static_cast<float>(kFocusReach * height);
        const float level = std::round(levelOf(placement.w / scene.circumradius));
        if (above != nullptr) {
            above->addStroke({middle - reach, level}, {middle + reach, level}, thickness, style.focusText);
            continue;
        }
        overlay.box({middle - reach, level - thickness / 2, middle + reach, level + thickness / 2}, style.focusText);
    }
}

}  // namespace

void addAxesSymbol(const scene::Scene& scene, ShapeBatch& shapes, Overlay& overlay) {
    // The symbol of the axes has its own projection. Its view axis meets the origin of the axes. Its eye is so far away
    // that the projection is nearly parallel. The unit of the following lengths is the length of an axis.
    constexpr float kFar = 16, kBar = 0.045f, kBall = 0.10f, kTip = 0.065f, kName = 1.28f;
    const scene::PictureStyle& style = scene.style();
    const auto width = static_cast<float>(scene.viewport.width), height = static_cast<float>(scene.viewport.height);
    const float length = static_cast<float>(scene.axes.length) * height;
    if (length < 1) return;
    const glm::vec2 center{static_cast<float>(scene.axes.x) * height, (1 - static_cast<float>(scene.axes.y)) * height};
    const ViewProjection projection{width,
                                    height,
                                    2 * length * kFar / width,
                                    2 * length * kFar / height,
                                    2 * center.x / width - 1,
                                    2 * center.y / height - 1};
    const glm::vec3 origin{0, 0, -kFar};
    const glm::mat3 turn(glm::dmat3(scene.camera.view()));

    struct TriadAxis {
        glm::vec3 direction;
        scene::Color color;
        char name;
    };
    std::array axes{TriadAxis{turn[0], style.axes[0], 'x'}, TriadAxis{turn[1], style.axes[1], 'y'},
                    TriadAxis{turn[2], style.axes[2], 'z'}};
    // Sorts the axes from far to near. Axes at the same distance are sorted by name: std::stable_sort would keep their
    // order, too, but allocates memory.
    std::sort(axes.begin(), axes.end(), [](const TriadAxis& a, const TriadAxis& b) {
        return a.direction.z != b.direction.z ? a.direction.z < b.direction.z : a.name < b.name;
    });
    shapes.setProjection(projection);
    bool originAdded = false;
    const auto addOrigin = [&] {
        if (!originAdded) shapes.addBall(origin, kBall, style.text);
        originAdded = true;
    };
    const int size = wholePixels(style.textHeight, scene);
    const auto digits = static_cast<float>(overlay.font().digitHeight(size));
    for (const TriadAxis& axis : axes) {
        const bool toward = axis.direction.z > 0;
        if (toward) {
            addOrigin();
            shapes.addBarFromFarEnd(origin + axis.direction * kBall, origin + axis.direction, kBar, axis.color);
            shapes.addBall(origin + axis.direction, kTip, axis.color);
        } else {
            shapes.addBall(origin + axis.direction, kTip, axis.color);
            shapes.addBarFromFarEnd(origin + axis.direction, origin + axis.direction * kBall, kBar, axis.color);
        }
        // If an axis points toward or away from the viewer, its name is drawn beside the axis.
        glm::vec2 name = glm::vec2(axis.direction) * kName;
        if (glm::length(name) < 0.3f) name = {0.3f, -0.3f};
        const glm::vec2 at = center + name * length;
        overlay.text(at.x, at.y - 0.4f * digits, size, {&axis.name, 1}, axis.color);
    }
    addOrigin();
}

void addLabels(const scene::Scene& scene, Overlay& overlay) {
    const glm::dmat4 toView = scene.camera.view();
    const ViewProjection projection = ViewProjection::fromCamera(scene.camera, scene.viewport);
    for (const bool focus : {false, true})
        for (const scene::SlicePlacement& placement : scene.placements)
            if (!placement.label.empty() && placement.drawn && placement.focus == focus)
                addLabel(placement, toView, projection, scene, overlay);
}

void addCoordinatesOverlay(const scene::Scene& scene, Overlay& overlay, const StrokeTargets& strokes) {
    if (!scene.look.parts.coordinates) return;
    if (!scene.coordinates.hasLines()) {
        if (scene.coordinates.isDensityStrip) {
            addStripAxesAndLines(scene, overlay, strokes.above);
        } else {
            addHistogramAxes(scene, overlay);
        }
        return;
    }
    const scene::ParallelCoordinatesLayout& layout = scene.coordinates;
    const scene::PictureStyle& style = scene.style();
    const auto height = static_cast<double>(scene.viewport.height);
    const auto& colors = style.axes;
    const auto count = static_cast<int>(scene.slices->rotatedVertices.size());
    // Lines that are at least one pixel wide are moved to whole pixels, where they are sharpest.
    const double lineWidth = layout.lineWidth * height;
    const auto snap = [&](double x) { return static_cast<float>(lineWidth >= 1 ? std::round(x) : x); };
    const auto lineThickness = snap(lineWidth);
    const auto zeroOf = [&](int row) { return std::round((layout.zero - row * layout.rowStep) * height); };

    // The lines of zero lie behind the bands of highlighted vertices. So if the bands are strokes, the lines of zero
    // must be strokes, too.
    ShapeBatch* const bands = scene.highlight.empty() ? nullptr : strokes.below;
    const auto addBand = [&](float left, float right, float middle, float width, scene::Color color, float opacity) {
        if (bands != nullptr) return bands->addStroke({left, middle}, {right, middle}, width, color, opacity);
        overlay.box({left, middle - width / 2, right, middle + width / 2}, color, opacity);
    };
    for (int row = 0; row * layout.perRow < count; ++row) {
        const int columns = std::min(layout.perRow, count - row * layout.perRow);
        const double left = layout.left * height,
                     right = left + ((columns - 1) * layout.columnStep + 3 * layout.lineStep) * height + lineWidth;
        const auto zero = static_cast<float>(zeroOf(row));
        addBand(snap(left), snap(right), zero, 1, style.zeroLine, 1);
    }
    for (const std::uint32_t i : scene.highlight.ownVertices) {
        const double zero = zeroOf(static_cast<int>(i) / layout.perRow), reach = layout.amplitude * height;
        const double column = (layout.left + (static_cast<int>(i) % layout.perRow) * layout.columnStep) * height;
        const double gap = 0.5 * layout.lineStep * height;
        addBand(snap(column - gap), snap(column + 3 * layout.lineStep * height + lineWidth + gap),
                static_cast<float>(zero), static_cast<float>(2 * reach), style.highlight, kHighlightOpacity);
    }
    for (int i = 0; i < count; ++i) {
        const double zero = zeroOf(i / layout.perRow);
        const double column = (layout.left + (i % layout.perRow) * layout.columnStep) * height;
        for (int k = 0; k < 4; ++k) {
            const float x = snap(column + k * layout.lineStep * height);
            const double value = scene.slices->rotatedVertices[static_cast<std::size_t>(i)][k] / scene.circumradius;
            const auto end = static_cast<float>(zero + value * layout.amplitude * height);
            const auto start = static_cast<float>(zero);
            overlay.box({x, std::min(start, end), x + lineThickness, std::max(start, end)},
                        colors[static_cast<std::size_t>(k)]);
        }
    }
    if (!layout.named) return;
    const int size = wholePixels(style.textHeight * 0.85, scene);
    const auto digits = static_cast<float>(overlay.font().digitHeight(size));
    for (int i = 0; i < count; ++i) {
        char name[16] = {'P'};
        const auto end = std::to_chars(name + 1, name + sizeof name, i).ptr;
        const double middle =
            layout.left + (i % layout.perRow) * layout.columnStep + 0.5 * (3 * layout.lineStep + layout.lineWidth);
        const double below = zeroOf(i / layout.perRow) - layout.amplitude * height;
        overlay.text(static_cast<float>(middle * height), static_cast<float>(below) - 1.4f * digits, size,
                     {name, static_cast<std::size_t>(end - name)}, style.text);
    }
}

}  // namespace oval4d::render
