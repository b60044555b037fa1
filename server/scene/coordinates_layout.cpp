#include "scene/coordinates_layout.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "scene/picture_boxes.hpp"
#include "scene/style.hpp"

namespace oval4d::scene {

namespace {

// Returns the width for the parallel coordinates between the margins, in viewport heights: at least half of the
// viewport's width.
double availableCoordinatesWidth(double aspect) { return std::max(aspect - 4 * kMargin, aspect / 2); }

// The maximum of ParallelCoordinatesLayout::lineStep for a density strip or histogram.
constexpr double kMaxAxisStep = 0.42;
constexpr double kPlotAmplitude = 0.056;
constexpr double kStripNameRoom = 1.1;  // the room below the plot for the names of the axes, in heights of text

void layOutDensityStrip(std::size_t vertices, double aspect, ParallelCoordinatesLayout& out) {
    out = {.rows = 1, .perRow = static_cast<int>(vertices), .lineWidth = 0.0022, .amplitude = kPlotAmplitude};
    out.isDensityStrip = true;
    out.lineStep = std::clamp((availableCoordinatesWidth(aspect) - out.lineWidth) / 3, 0.0, kMaxAxisStep);
    out.left = (aspect - 3 * out.lineStep - out.lineWidth) / 2;
    out.zero = kMargin + kStripNameRoom * style().textHeight + kPlotAmplitude;
}

void layOutHistogram(double aspect, ParallelCoordinatesLayout& out) {
    // The gap between two panels of a histogram, as a fraction of ParallelCoordinatesLayout::lineStep.
    constexpr double kGap = 0.08;
    out = {.lineWidth = 0.0022, .amplitude = kPlotAmplitude};
    out.lineStep = std::clamp(availableCoordinatesWidth(aspect) / (4 - kGap), 0.0, kMaxAxisStep);
    out.panel = (1 - kGap) * out.lineStep;
    out.left = (aspect - 3 * out.lineStep - out.panel) / 2;
    out.zero = kMargin + kStripNameRoom * style().textHeight + kPlotAmplitude;
}

}  // namespace

void layOutCoordinates(const LayoutObjectInfo& content, double aspect, ParallelCoordinatesLayout& out) {
    if (content.isField) {
        layOutHistogram(aspect, out);
        return;
    }
    const std::size_t vertices = content.vertices;
    constexpr double kMinColumn = 0.0095;
    constexpr double kMaxColumn = 0.15;
    if (vertices > kMaxVerticesAsLines) {
        layOutDensityStrip(vertices, aspect, out);
        return;
    }
    const double width = availableCoordinatesWidth(aspect);
    out.isDensityStrip = false;
    out.panel = 0;
    const auto count = static_cast<double>(std::max<std::size_t>(vertices, 1));
    out.rows = std::clamp(static_cast<int>(std::ceil(count * kMinColumn / width)), 1, 6);
    out.perRow = static_cast<int>(std::ceil(count / out.rows));
    out.columnStep = std::min(width / out.perRow, kMaxColumn);
    out.lineStep = std::min(out.columnStep * 0.21, 0.013);
    out.lineWidth = std::min(out.lineStep * 0.62, 0.0042);
    out.named = out.rows == 1 && out.columnStep > 2.2 * style().textHeight;
    out.amplitude = out.rows == 1 ? 0.052 : 0.019;
    out.rowStep = 2.25 * out.amplitude;
    out.left = (aspect - (out.columnStep * (out.perRow - 1) + 3 * out.lineStep + out.lineWidth)) / 2;
    out.zero = kMargin + (out.named ? 1.3 * style().textHeight : 0) + out.amplitude + (out.rows - 1) * out.rowStep;
}

}  // namespace oval4d::scene
