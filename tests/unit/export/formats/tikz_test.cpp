// Tests of drawings for LaTeX (TikZ).

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "export/drawing/drawing.hpp"
#include "export/formats/writers.hpp"

namespace {

using namespace oval4d;

std::string tikzOf(const exports::DrawnShape& shape, double size = exports::kDrawingSize) {
    return exports::tikz({"shapes\nof a test", exports::kDrawingWidth, 240, {{"shapes", {shape}}}, size});
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Tikz, WritesShapesWithTheirColorsAndOpacities) {
    const std::string line =
        tikzOf(exports::LineSegment{.from = {1, 2}, .to = {3.5, 4}, .color = 0x12AB34, .opacity = 0.5});
    EXPECT_TRUE(line.starts_with("% shapesof a test\n% A figure of 170 mm by 85 mm"));
    EXPECT_TRUE(has(line, "\\definecolor{oval12AB34}{HTML}{12AB34}"));
    EXPECT_TRUE(has(line, "\\draw[oval12AB34,line width=0.354mm,draw opacity=0.5] (1,2) -- (3.5,4);"));
    EXPECT_TRUE(has(tikzOf(exports::Polyline{{{0, 0}, {1, 0}, {2, 1}}, 1, 0}),
                    "\\draw[oval000000,line width=0.354mm,line cap=round,line join=round] (0,0) -- (1,0) -- (2,1);"));
    EXPECT_TRUE(has(tikzOf(exports::FilledPolygon{{{0, 0}, {1, 0}, {0, 1}}, 0}),
                    "\\fill[oval000000] (0,0) -- (1,0) -- (0,1) -- cycle;"));
    EXPECT_TRUE(has(tikzOf(exports::Disk{{5, 6}, 2, 0}), "\\fill[oval000000] (5,6) circle[radius=0.708mm];"));
}

TEST(Tikz, EscapesTexts) {
    EXPECT_TRUE(has(tikzOf(exports::TextLine{{0, 0}, 7, 0, "w = -0.25, 5-cell"}), "{w = $-$0.25, 5-cell};"));
    EXPECT_TRUE(
        has(tikzOf(exports::TextLine{{0, 0}, 7, 0, "{5/2} 50% #1 a_b $x \\y ~^ <&>"}),
            "{\\{5/2\\} 50\\% \\#1 a\\_b \\$x \\textbackslash{}y \\textasciitilde{}\\textasciicircum{} $<$\\&$>$};"));
}

TEST(Tikz, WritesTheRunsOfEachColumnOfAnImage) {
    const exports::OpacityImage image{{10, 10}, {20, 30}, {255, 0, 255, 51}, 2, {0xFF0000, 0x0000FF}};
    const std::string text = tikzOf(image);
    EXPECT_TRUE(has(text, "\\fill[ovalFF0000] (5,0) rectangle (15,40);"));
    EXPECT_TRUE(has(text, "\\fill[oval0000FF,fill opacity=0.2] (15,20) rectangle (25,40);"));
    EXPECT_FALSE(has(text, "(15,0)"));
}

// Shapes are cut, because TeX stops with an error at lengths of 16,384 points or more.
TEST(Tikz, CutsShapesWhereTexHasNoLengths) {
    for (const double size : {10.0, exports::kDrawingSize, 5000.0}) {
        const double pointsPerUnit = size / exports::kDrawingWidth * 72.27 / 25.4;
        for (const exports::DrawnShape& shape :
             {exports::DrawnShape(exports::LineSegment{.from = {0, 0}, .to = {1e9, 5e8}}),
              exports::DrawnShape(exports::Polyline{{{0, 0}, {1e9, 0}, {0, -1e9}, {5, 5}}, 1, 0}),
              exports::DrawnShape(exports::FilledPolygon{{{0, 0}, {1e9, 0}, {0, -1e9}}, 0}),
              exports::DrawnShape(exports::Disk{{1e6, 0}, 1e6 - 100, 0})}) {
            const std::string text = tikzOf(shape, size);
            double farthest = 0;
            for (std::size_t at = text.find("% shapes\n"); at < text.size(); at = text.find_first_of("(,", at)) {
                farthest = std::max(farthest, std::abs(std::atof(text.c_str() + at + 1)));
                ++at;
            }
            EXPECT_GT(farthest, exports::kDrawingWidth) << "nothing in the drawing is cut";
            EXPECT_LT(farthest, 16'384);
            EXPECT_LT(farthest * pointsPerUnit, 16'384);
        }
    }
}

}  // namespace
