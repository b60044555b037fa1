#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "slicing/visibility.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::slicing {
namespace {

TEST(VisibilityBySource, IsThatOfTheMostVisibleCell) {
    const auto polytope = support::rectifiedFiveCell();
    const Object object = support::objectOf(polytope);
    constexpr auto kHidden = Visibility::hidden, kFaded = Visibility::faded, kFull = Visibility::full;
    using OfType = std::array<Visibility, 2>;
    for (const OfType& ofType :
         {OfType{kHidden, kFull}, {kFull, kHidden}, {kFaded, kFull}, {kFaded, kHidden}, {kHidden, kHidden}}) {
        VisibilityBySource found;
        findVisibilities(object, ofType, found);
        // The expected visibilities come from a search through all cells for each element.
        const auto greatest = [&](auto&& holds) {
            Visibility most = Visibility::hidden;
            for (std::size_t c = 0; c < polytope.cells.size(); ++c) {
                bool in = false;
                for (const auto f : polytope.cells[c]) in = in || holds(f);
                if (in) most = std::max(most, ofType.at(polytope.typeOfCell[c]));
            }
            return most;
        };
        for (std::uint32_t f = 0; f < polytope.faces.size(); ++f) {
            const Visibility expected = greatest([&](std::uint32_t other) { return other == f; });
            EXPECT_EQ(found.edge(f), expected);
            EXPECT_EQ(visibilityOf(object, found, {ElementKind::face, f}), expected);
            EXPECT_EQ(found.face(static_cast<std::uint32_t>(polytope.cells.size()) + f), expected);
            if (expected == Visibility::hidden) continue;
            EXPECT_NE(found.face(coloringCell(object, found, static_cast<std::uint32_t>(polytope.cells.size()) + f)),
                      Visibility::hidden);
        }
        for (std::uint32_t e = 0; e < polytope.edges.size(); ++e) {
            const auto onLoop = [&](std::uint32_t f) {
                const auto edges = polytope.faceEdges[f];
                return std::find(edges.begin(), edges.end(), e) != edges.end();
            };
            EXPECT_EQ(found.vertex(e), greatest(onLoop));
            EXPECT_EQ(visibilityOf(object, found, {ElementKind::edge, e}), greatest(onLoop));
            EXPECT_EQ(found.edge(static_cast<std::uint32_t>(polytope.faces.size()) + e), greatest(onLoop));
        }
        for (std::uint32_t v = 0; v < polytope.vertices.size(); ++v) {
            const auto onLoop = [&](std::uint32_t f) {
                const auto loop = polytope.faces[f];
                return std::find(loop.begin(), loop.end(), v) != loop.end();
            };
            EXPECT_EQ(found.vertex(static_cast<std::uint32_t>(polytope.edges.size()) + v), greatest(onLoop));
            EXPECT_EQ(visibilityOf(object, found, {ElementKind::vertex, v}), greatest(onLoop));
        }
        for (std::uint32_t c = 0; c < polytope.cells.size(); ++c)
            EXPECT_EQ(visibilityOf(object, found, {ElementKind::cell, c}), ofType.at(polytope.typeOfCell[c]));
    }
}

TEST(VisibilityBySource, IsFoundFromTheHiddenAndTheFadedTypes) {
    const auto polytope = support::rectifiedFiveCell();
    const Object object = support::objectOf(polytope);
    const std::vector<std::uint32_t> first{0}, second{1}, beyond{0, 2};
    VisibilityBySource found;
    const auto cellOfType = [&](std::uint32_t type) {
        const auto at = std::ranges::find(polytope.typeOfCell, type);
        return visibilityOf(object, found,
                            {ElementKind::cell, static_cast<std::size_t>(at - polytope.typeOfCell.begin())});
    };
    findVisibilities(object, first, second, found);
    EXPECT_EQ(cellOfType(0), Visibility::hidden);
    EXPECT_EQ(cellOfType(1), Visibility::faded);
    findVisibilities(object, first, beyond, found);
    EXPECT_EQ(cellOfType(0), Visibility::hidden) << "a type in both lists is hidden";
    EXPECT_EQ(cellOfType(1), Visibility::full);
    findVisibilities(object, {}, {}, found);
    EXPECT_TRUE(found.allVisible());
    EXPECT_EQ(cellOfType(0), Visibility::full);
}

TEST(VisibilityBySource, IsEmptyIfEverythingIsFullyVisible) {
    const auto polytope = support::rectifiedFiveCell();
    VisibilityBySource found;
    found.faces.resize(3);
    findVisibilities(support::objectOf(polytope), std::array{Visibility::full, Visibility::full}, found);
    EXPECT_TRUE(found.allVisible());
    EXPECT_EQ(found.vertex(0), Visibility::full);
    EXPECT_EQ(found.edge(1), Visibility::full);
    EXPECT_EQ(found.face(2), Visibility::full);
}

}  // namespace
}  // namespace oval4d::slicing
