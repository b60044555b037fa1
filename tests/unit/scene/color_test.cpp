// Tests of the colors of cells, and of the visibility of elements if cell types are hidden or faded.

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "scene/composer.hpp"
#include "unit/slicing/support.hpp"

namespace {

using namespace oval4d;
using scene::Color;
using scene::Coloring;
using scene::ColorScheme;
using slicing::Visibility;
using support::named;
using support::objectOf;

std::vector<Color> painted(const polytopes::Polytope& polytope, Coloring coloring,
                           ColorScheme scheme = ColorScheme::dark) {
    std::vector<Color> colors;
    scene::CellColorAssigner().updateCellColors(objectOf(polytope), coloring, scheme, {}, colors);
    return colors;
}

int red(Color color) { return static_cast<int>(color >> 16 & 255); }
int blue(Color color) { return static_cast<int>(color & 255); }

TEST(CellColorAssigner, AreDistinctWhereCellsAreFewAndStable) {
    for (const char* name : {"5-cell", "8-cell", "16-cell", "24-cell"}) {
        for (const ColorScheme scheme : {ColorScheme::dark, ColorScheme::light}) {
            const auto colors = painted(named(name), Coloring::cell, scheme);
            EXPECT_EQ(std::set(colors.begin(), colors.end()).size(), named(name).cells.size());
            EXPECT_EQ(colors, painted(named(name), Coloring::cell, scheme));
        }
    }
    EXPECT_EQ(painted(named("600-cell"), Coloring::cell).size(), 600U);
}

TEST(CellColorAssigner, ByCellTypeAreOneForEachType) {
    const auto polytope = support::rectifiedFiveCell();
    const auto colors = painted(polytope, Coloring::cell_type);
    std::set<std::pair<std::uint32_t, Color>> pairs;
    for (std::size_t c = 0; c < colors.size(); ++c) pairs.emplace(polytope.typeOfCell[c], colors[c]);
    ASSERT_EQ(pairs.size(), 2U);
    EXPECT_NE(pairs.begin()->second, pairs.rbegin()->second);
    EXPECT_EQ(scene::cellTypeColor(0, 2), pairs.begin()->second);
    EXPECT_EQ(scene::cellTypeColor(1, 2), pairs.rbegin()->second);
}

TEST(CellColorAssigner, PlainIsOne) {
    const auto colors = painted(named("24-cell"), Coloring::plain);
    EXPECT_EQ(std::set(colors.begin(), colors.end()).size(), 1U);
}

TEST(CellColorAssigner, ByWRunFromBlueToAmberAsThePolytopeIsTurned) {
    const auto& polytope = named("8-cell");  // one cell lies at w = −1, one at w = 1, and six at w = 0
    scene::CellColorAssigner cellColors;
    std::vector<Color> colors;
    for (const double turned : {0.0, std::numbers::pi}) {
        const geometry::Rotation orientation(geometry::RotationAngles{geometry::Plane::xw, turned, {}});
        cellColors.updateCellColors(objectOf(polytope), Coloring::w, ColorScheme::dark, orientation, colors);
        for (std::size_t c = 0; c < colors.size(); ++c) {
            double w = 0;
            for (const auto f : polytope.cells[c]) {
                for (const auto v : polytope.faces[f]) w += orientation(polytope.vertices[v]).w / 24;
            }
            const int warmth = red(colors[c]) - blue(colors[c]);
            if (w > 0.5) {
                EXPECT_GT(warmth, 90);
            } else if (w < -0.5) {
                EXPECT_LT(warmth, -90);
            } else {
                EXPECT_LT(std::abs(warmth), 15);
            }
        }
    }
}

TEST(CellColorAssigner, ByLightDependOnTheNormalAlone) {
    const auto& polytope = named("8-cell");  // the normals of its cells are the eight directions of the axes
    std::vector<glm::dvec4> normals;
    std::vector<double> offsets;
    slicing::findCellHyperplanes(objectOf(polytope), normals, offsets);
    const auto cellToward = [&](const glm::dvec4& direction) {
        const auto product = [&](const glm::dvec4& normal) { return glm::dot(normal, direction); };
        return std::ranges::max_element(normals, {}, product) - normals.begin();
    };
    const auto brightness = [](Color color) { return red(color) + blue(color) + int(color >> 8U & 255U); };
    scene::CellColorAssigner cellColors;
    std::vector<Color> colors;
    cellColors.updateCellColors(objectOf(polytope), Coloring::light, ColorScheme::dark, {}, colors);
    EXPECT_EQ(std::set(colors.begin(), colors.end()).size(), 8U);
    // The light comes from the left, from above, from the front, and from large w.
    std::array<Color, 8> lit{};
    for (int axis = 0; axis < 4; ++axis) {
        glm::dvec4 direction(0);
        direction[axis] = axis == 0 ? -1 : 1;
        const Color toward = colors.at(cellToward(direction)), away = colors.at(cellToward(-direction));
        EXPECT_GT(brightness(toward), brightness(away) + 20) << axis;
        lit.at(axis) = toward;
    }
    // A quarter turn from y to z moves cells to the places of other cells. Each cell must then have the color of the
    // cell whose place it has taken.
    const geometry::Rotation quarter(geometry::RotationAngles{geometry::Plane::yz, std::numbers::pi / 2, {}});
    cellColors.updateCellColors(objectOf(polytope), Coloring::light, ColorScheme::dark, quarter, colors);
    EXPECT_EQ(colors.at(cellToward({0, 1, 0, 0})), lit[2]);
    EXPECT_EQ(colors.at(cellToward({0, 0, 0, 1})), lit[3]);
}

constexpr std::array kPolytopeColorings{Coloring::cell, Coloring::w, Coloring::cell_type, Coloring::plain,
                                        Coloring::light};

TEST(CellColorAssigner, FollowThePolytopeTheColoringAndTheScheme) {
    scene::CellColorAssigner cellColors;
    std::vector<Color> colors;
    for (const char* name : {"16-cell", "5-cell", "16-cell"}) {
        for (const Coloring coloring : kPolytopeColorings) {
            for (const ColorScheme scheme : {ColorScheme::dark, ColorScheme::light}) {
                cellColors.updateCellColors(objectOf(named(name)), coloring, scheme, {}, colors);
                EXPECT_EQ(colors, painted(named(name), coloring, scheme)) << name;
            }
        }
    }
}

constexpr Color kWhite = 0xffffff, kBlack = 0;

TEST(CssColor, HasSixHexadecimalDigits) {
    EXPECT_EQ(scene::cssColor(kBlack), "#000000");
    EXPECT_EQ(scene::cssColor(0x0a1bcf), "#0a1bcf");
}

TEST(Contrast, IsThatOfTheGuidelines) {
    EXPECT_DOUBLE_EQ(scene::contrast(kWhite, kBlack), 21);
    EXPECT_DOUBLE_EQ(scene::contrast(kBlack, kWhite), 21);
    EXPECT_DOUBLE_EQ(scene::contrast(0x123456, 0x123456), 1);
    EXPECT_NEAR(scene::contrast(0x767676, kWhite), 4.54, 0.005);  // the lightest gray of the examples of WCAG
}

TEST(Colors, OfALightGroundHoldOnWhite) {
    std::vector<Color> all{scene::plainColor(ColorScheme::light)};
    for (const char* name : {"5-cell", "24-cell", "600-cell"}) {
        for (const Coloring coloring : kPolytopeColorings)
            std::ranges::copy(painted(named(name), coloring, ColorScheme::light), std::back_inserter(all));
    }
    for (std::size_t i = 0; i < 12; ++i) {
        all.push_back(scene::cellTypeColor(i, 12, ColorScheme::light));
        all.push_back(scene::levelColor(i % 4, 4, ColorScheme::light));
    }
    for (int i = -20; i <= 20; ++i) {
        all.push_back(scene::divergingColor(i / 20.0, ColorScheme::light));
        all.push_back(scene::sequentialColor(i / 20.0, ColorScheme::light));
    }
    for (const Color color : all) EXPECT_GE(scene::contrast(color, kWhite), 3.6) << std::hex << color;
    for (int i = 1; i <= 20; ++i)
        EXPECT_LT(scene::contrast(scene::sequentialColor(i / 20.0, ColorScheme::light), kWhite),
                  scene::contrast(scene::sequentialColor((i - 1) / 20.0, ColorScheme::light), kWhite))
            << "the scale becomes lighter";
}

TEST(VisibilityBySource, FollowsTheLook) {
    const auto polytope = support::rectifiedFiveCell();
    scene::Composer composer;
    scene::Scene s;
    scene::Look look;
    slicing::SliceSet slices;
    const auto compose = [&](const polytopes::Polytope& p) {
        slicing::CellComplexSlicer().slice(p, {}, {-1, 3, 1}, slices);
        composer.compose(objectOf(p), {}, slices, 0, look, {}, s);
    };
    compose(polytope);
    EXPECT_TRUE(s.visibilities.allVisible());
    look.cellTypes = {{1}, {}};
    compose(polytope);
    EXPECT_FALSE(s.visibilities.allVisible());
    look.cellTypes = {{1}, {0}};
    compose(polytope);
    for (std::uint32_t c = 0; c < polytope.cells.size(); ++c)
        EXPECT_EQ(s.visibilities.face(c), polytope.typeOfCell[c] == 1 ? Visibility::hidden : Visibility::faded);
    look.cellTypes = {};
    compose(named("5-cell"));
    EXPECT_TRUE(s.visibilities.allVisible());
    look.cellTypes = {{0}, {}};
    compose(named("5-cell"));
    EXPECT_EQ(s.visibilities.face(4), Visibility::hidden);
}

}  // namespace
