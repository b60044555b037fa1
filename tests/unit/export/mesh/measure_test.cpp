#include <algorithm>
#include <array>

#include "export/mesh/measure.hpp"
#include "unit/export/support.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::support;
using namespace oval4d::exports;
using namespace oval4d::geometry;
using namespace oval4d::polytopes;
using namespace oval4d::slicing;

TEST(Measure, cubesOctahedraAndTetrahedra) {
    const Polytope& cube = named("8-cell");
    const SliceMeasurements c = measureSlice(cutAt(cube, {}, 0.4), 0);
    EXPECT_EQ(c.faces, 6U);
    EXPECT_NEAR(c.volume, 8, 1e-12);
    EXPECT_NEAR(c.area, 24, 1e-12);
    EXPECT_NEAR(glm::length(c.centroid), 0, 1e-12);

    // The slice of the 16-cell at w = 0 is an octahedron with edges of length 2.
    const SliceMeasurements o = measureSlice(cutAt(named("16-cell"), {}, 0), 0);
    EXPECT_EQ(o.faces, 8U);
    EXPECT_NEAR(o.volume, std::sqrt(2) / 3 * 8, 1e-12);
    EXPECT_NEAR(o.area, 2 * std::sqrt(3) * 4, 1e-12);

    // A 5-cell is a pyramid over a cell. At the fraction t of the height, the slice is a tetrahedron with edges of
    // length 2 · (1 − t).
    const Polytope& pen = named("5-cell");
    const Rotation up = ontoW(pen.vertices[0]);
    const double top = pen.circumradius;
    const double bottom = -top / 4;
    for (const double t : {0.0, 0.25, 0.7}) {
        const SliceMeasurements m = measureSlice(cutAt(pen, up, bottom + t * (top - bottom)), 0);
        const double edge = 2 * (1 - t);
        EXPECT_NEAR(m.volume, edge * edge * edge / (6 * std::sqrt(2)), 1e-9);
        EXPECT_NEAR(m.area, std::sqrt(3) * edge * edge, 1e-9);
        EXPECT_NEAR(glm::length(m.centroid), 0, 1e-9);
    }
}

TEST(Measure, movesWithTheSlice) {
    const Polytope& p = named("24-cell");
    std::mt19937 random(3);
    const Rotation turned = randomRotation(random);
    SliceSet s = cutAt(p, turned, 0.2);
    const SliceMeasurements here = measureSlice(s, 0);
    const glm::dvec3 by(100, -20, 3);
    for (auto& v : s.vertices) v += by;
    const SliceMeasurements there = measureSlice(s, 0);
    EXPECT_NEAR(there.volume, here.volume, 1e-10);
    EXPECT_NEAR(there.area, here.area, 1e-10);
    EXPECT_NEAR(glm::distance(there.centroid, here.centroid + by), 0, 1e-10);
}

TEST(Measure, theCentersOfSlicesAreThatOfThePolytope) {
    // The integral of the slices' first moments over w is the first moment of the polytope, which is 0. Between the
    // values of w of the vertices, the integrand is a polynomial of degree 4. Boole's rule integrates it exactly.
    std::mt19937 random(4);
    for (const char* name : {"5-cell", "24-cell"}) {
        const Polytope& p = named(name);
        const Rotation turned = randomRotation(random);
        std::vector<double> levels;
        for (const auto& v : p.vertices) levels.push_back(turned(v).w);
        std::ranges::sort(levels);
        glm::dvec3 sum(0);
        double whole = 0;
        for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
            const double step = (levels[i + 1] - levels[i]) / 4;
            constexpr std::array kWeights{7.0, 32.0, 12.0, 32.0, 7.0};
            for (int k = 0; k < 5; ++k) {
                const SliceMeasurements m = measureSlice(cutAt(p, turned, levels[i] + k * step), 0);
                sum += 2 * step / 45 * kWeights[k] * m.volume * m.centroid;
                whole += 2 * step / 45 * kWeights[k] * m.volume;
            }
        }
        EXPECT_NEAR(glm::length(sum), 0, 1e-9);
        EXPECT_GT(whole, 0.1);
    }
}

TEST(Measure, flatOnesAndHoles) {
    const Polytope& p = named("24-cell");
    const auto corner = [&](int i) { return p.vertices[p.faces[0][i]]; };
    const glm::dvec4 middle = (corner(0) + corner(1) + corner(2)) / 3.0;
    const Rotation up = ontoW(middle);
    const SliceMeasurements m = measureSlice(cutAt(p, up, glm::length(middle)), 0);
    EXPECT_EQ(m.volume, 0);
    EXPECT_TRUE(m.hasCentroid);
    const glm::dvec4 at = up(middle);
    EXPECT_NEAR(glm::distance(m.centroid, glm::dvec3(at.x, at.y, at.z)), 0, 1e-9);

    const SliceMeasurements dented = [] {
        const Polytope prism = product(kDented, kSquare);
        return measureSlice(cutAt(prism, {}, 0.5), 0);
    }();
    EXPECT_NEAR(dented.volume, 2 * kDentedArea, 1e-12);
    EXPECT_NEAR(dented.area, 2 * kDentedArea + 2 * (4 + 2 + 1.5 + 1.5 + 1 + 1.5 + 1.5 + 2), 1e-12);
    EXPECT_NEAR(dented.centroid.y, (8 * -1 + 1.5 * 0.75) / kDentedArea, 1e-12);
    EXPECT_FALSE(measureSlice(cutAt(p, {}, 10), 0).hasCentroid);
}

}  // namespace
