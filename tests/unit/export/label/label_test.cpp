#include "export/label/label.hpp"
#include "export/mesh/solid.hpp"
#include "export/mesh/tessellate.hpp"
#include "unit/export/support.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::support;
using namespace oval4d::exports;
using oval4d::polytopes::Polytope;

double areaOf(const std::vector<Contour>& contours) {
    double twice = 0;
    for (const Contour& contour : contours) {
        for (std::size_t i = 0; i < contour.size(); ++i) {
            const glm::dvec2 a = contour[i];
            const glm::dvec2 b = contour[(i + 1) % contour.size()];
            twice += a.x * b.y - a.y * b.x;
        }
    }
    return twice / 2;
}

TEST(Tessellate, trianglesCoverTheRegionWithItsOwnCorners) {
    const std::vector<Contour> framed{{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{1, 1}, {1, 3}, {3, 3}, {3, 1}}};
    const auto triangles = triangulate(framed);
    // A region with holes needs this number of triangles: corners + 2 · holes − 2.
    EXPECT_EQ(triangles.size(), 8U);
    std::vector<glm::dvec2> corners;
    for (const Contour& contour : framed) corners.insert(corners.end(), contour.begin(), contour.end());
    double area = 0;
    for (const auto& [a, b, c] : triangles) {
        const double own = areaOf({{corners[a], corners[b], corners[c]}});
        EXPECT_GT(own, 0);
        area += own;
    }
    EXPECT_NEAR(area, 12, 1e-12);
    EXPECT_TRUE(triangulate({{{0, 0}, {2, 2}, {2, 0}, {0, 2}}}).empty());  // a contour that intersects itself
}

TEST(Tessellate, anOutlineIsAllThatIsWoundAround) {
    EXPECT_NEAR(areaOf(outlineOf({pentagram()})), kPentagramArea, 1e-6);  // GLU computes with 32-bit floats
    const Contour square{{0, 0}, {2, 0}, {2, 2}, {0, 2}};
    const Contour beside{{1, 1}, {1, 3}, {3, 3}, {3, 1}};  // has the opposite orientation
    EXPECT_NEAR(areaOf(outlineOf({square, Contour(beside.rbegin(), beside.rend())})), 7, 1e-9);
    EXPECT_NEAR(areaOf(outlineOf({square, beside})), 6, 1e-9);
}

TEST(Letters, areCenteredAndOneHigh) {
    const TextOutlines text = textOutlinesOf({"HIH"});
    EXPECT_NEAR(text.size.y, 1, 1e-9);
    glm::dvec2 least(1e300);
    for (const Contour& contour : text.contours) {
        for (const auto& p : contour) least = glm::min(least, p);
    }
    EXPECT_NEAR(least.x, -text.size.x / 2, 1e-9);
    EXPECT_EQ(text.contours.size(), 3U);
    EXPECT_EQ(textOutlinesOf({"8"}).contours.size(), 3U);       // the outline and two holes
    EXPECT_EQ(textOutlinesOf({"\u2212"}).contours.size(), 1U);  // the minus sign
    EXPECT_GT(textOutlinesOf({"A", "A"}).size.y, 2);
}

TEST(Label, isCutIntoAFaceAndTheBodyStaysClosed) {
    std::mt19937 random(12);
    int cut = 0;
    for (const char* name : {"5-cell", "8-cell", "16-cell", "24-cell"}) {
        const Polytope& p = named(name);
        const RoundingGrid grid(80, 80);
        const LabelText label(name, "w = \u22120.25");
        for (int trial = 0; trial < 12; ++trial) {
            Mesh mesh =
                solidOf(cutAt(p, randomRotation(random), 0.1 * trial), 0, 40 / p.circumradius, grid, unhurried());
            if (mesh.triangles.empty()) continue;
            const Mesh plain = mesh;
            if (!label.engrave(mesh, 80, grid, unhurried())) {
                EXPECT_EQ(mesh.triangles, plain.triangles);
                continue;
            }
            ++cut;
            expectPrintable(mesh);
            // The letters lie inside the body, so the bounding box stays the same, and the volume decreases.
            EXPECT_EQ(boundingBoxOf(mesh).size(), boundingBoxOf(plain).size());
            EXPECT_LT(volumeOf(mesh), volumeOf(plain));
            double ink = 0;
            for (std::size_t t = 0; t < mesh.triangles.size(); ++t) ink += mesh.cells[t] == kNoCell ? 1 : 0;
            EXPECT_GT(ink, 100);
        }
    }
    EXPECT_GT(cut, 20);
}

TEST(Label, isRefusedWhereThereIsNoRoom) {
    const Polytope& p = named("600-cell");
    const RoundingGrid grid(20, 20);
    Mesh mesh = solidOf(cutAt(p, {}, 0.1), 0, 10 / p.circumradius, grid, unhurried());
    EXPECT_FALSE(LabelText("600-cell", "w = 0.1").engrave(mesh, 20, grid, unhurried()));
}

TEST(Label, engravingObeysTheTimeLimit) {
    const Polytope& p = named("8-cell");
    const RoundingGrid grid(80, 80);
    Mesh mesh = solidOf(cutAt(p, {}, 0.1), 0, 40 / p.circumradius, grid, unhurried());
    const std::size_t triangles = mesh.triangles.size();
    std::chrono::steady_clock::time_point now;
    const ExportBudget budget({.time = std::chrono::seconds(20), .now = [&] { return now; }}, {});
    now += std::chrono::seconds(21);
    EXPECT_THROW(LabelText("8-cell", "w = 0.1").engrave(mesh, 80, grid, budget), ExportRefused);
    EXPECT_EQ(mesh.triangles.size(), triangles);
}

TEST(Label, aPlateIsABodyOfItsOwn) {
    for (const double size : {10.0, 60.0, 500.0}) {
        const RoundingGrid grid(size, size);
        const Mesh plate = LabelText("omnitruncated 120-cell", "w = 1.25").makeLabelPlate(size, grid);
        expectPrintable(plate);
        const glm::dvec3 extent = boundingBoxOf(plate).size();
        EXPECT_NEAR(extent.z, 2, 0.01);
        EXPECT_LE(boundingBoxOf(plate).max.y, 0);
        EXPECT_LT(volumeOf(plate), extent.x * extent.y * extent.z);
        EXPECT_GT(volumeOf(plate), 0.85 * extent.x * extent.y * extent.z);
    }
}

}  // namespace
