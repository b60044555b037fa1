// Tests of PDF documents.

#include <string>

#include <gtest/gtest.h>

#include "export/drawing/drawing.hpp"
#include "export/formats/writers.hpp"

namespace {

using namespace oval4d;

std::string documentOf(const exports::DrawnShape& shape) {
    return exports::pdf({"lines", exports::kDrawingWidth, exports::kDrawingWidth, {{"shapes", {shape}}}});
}

std::string lineTo(const glm::dvec2& end) { return documentOf(exports::LineSegment{.from = {0, 0}, .to = end}); }

std::string triangleTo(const glm::dvec2& end) {
    return documentOf(exports::FilledPolygon{{{0, 0}, {0, 100}, end}, 0x123456});
}

std::string bentLineTo(const glm::dvec2& end) {
    return documentOf(exports::Polyline{{{0, 0}, {0, 100}, end}, 1, 0x123456});
}

TEST(Pdf, keepsTheDirectionsOfLinesFarBeyondThePage) {
    // The two ends of lines are far outside the page. libharu alone would write them as the same position.
    EXPECT_NE(lineTo({1e6, 1e6}), lineTo({1e6, 5e5}));
    EXPECT_EQ(lineTo({2e6, 1e6}), lineTo({1e6, 5e5}));
    EXPECT_EQ(lineTo({-2e6, 1e6}), lineTo({-1e6, 5e5}));
    EXPECT_NE(triangleTo({1e6, 1e6}), triangleTo({1e6, 5e5}));
    EXPECT_NE(bentLineTo({1e6, 1e6}), bentLineTo({1e6, 5e5}));
    EXPECT_NE(documentOf(exports::Disk{{1e6, 0}, 1e6 - 100, 0}), documentOf(exports::Disk{{1e6, 0}, 1e6 - 200, 0}));
}

}  // namespace
