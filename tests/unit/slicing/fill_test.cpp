// Tests of filling faces by the nonzero winding rule, and of the convexity test.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "polytopes/catalogue/catalogue.hpp"
#include "polytopes/construction/coxeter.hpp"
#include "polytopes/convexity.hpp"
#include "slicing/fill.hpp"
#include "unit/slicing/support.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::support;
using namespace oval4d::slicing;

constexpr polytopes::DiagramBranch k3{3, 1}, k4{4, 1}, k5{5, 1}, kStar{5, 2};

polytopes::Polytope regular(polytopes::DiagramBranch p, polytopes::DiagramBranch q, polytopes::DiagramBranch r) {
    const polytopes::CoxeterDiagram diagram = polytopes::CoxeterDiagram::linear(p, q, r, {true, false, false, false});
    return wythoffConstruction("regular", diagram, mirrorsOf(diagram));
}

std::vector<polytopes::Polytope> starPolychora() {
    std::vector<polytopes::Polytope> all;
    for (const auto& [p, q, r] : {std::array{kStar, k5, k3},
                                  {k3, k5, kStar},
                                  {k5, kStar, k5},
                                  {k5, k3, kStar},
                                  {kStar, k3, k5},
                                  {kStar, k5, kStar},
                                  {k5, kStar, k3},
                                  {k3, kStar, k5},
                                  {k3, k3, kStar},
                                  {kStar, k3, k3}}) {
        all.push_back(regular(p, q, r));
    }
    return all;
}

/// Returns a slice with one face of one cell. The face consists of `loops` in the plane spanned by u and v.
SliceSet flat(const std::vector<std::vector<glm::dvec2>>& loops, const glm::dvec3& u, const glm::dvec3& v) {
    SliceSet s;
    s.planes = {0, 1, 1};
    s.vertexBegin = s.edgeBegin = {0, 0};
    s.faceBegin = {0, static_cast<std::uint32_t>(loops.size())};
    s.cornerBegin = {0};
    for (const auto& loop : loops) {
        for (const glm::dvec2& p : loop) {
            s.corners.push_back(static_cast<std::uint32_t>(s.vertices.size()));
            s.vertices.push_back(p.x * u + p.y * v + glm::dvec3(0.3, -0.2, 0.1));
        }
        s.cornerBegin.push_back(static_cast<std::uint32_t>(s.corners.size()));
        s.faceSource.push_back(0);
    }
    s.vertexBegin[1] = static_cast<std::uint32_t>(s.vertices.size());
    return s;
}

FilledFaces filled(const SliceSet& slices, double circumradius) {
    FilledFaces fill;
    FaceFiller().fill(slices, circumradius, fill);
    return fill;
}

double areaOf(const FilledFaces& fill, std::size_t piece) {
    glm::dvec3 sum(0);
    const auto begin = fill.cornerBegin[piece];
    for (auto i = begin + 2; i < fill.cornerBegin[piece + 1]; ++i)
        sum += glm::cross(fill.corners[i - 1] - fill.corners[begin], fill.corners[i] - fill.corners[begin]);
    return glm::length(sum) / 2;
}

double areaOf(const FilledFaces& fill) {
    double sum = 0;
    for (std::size_t k = 0; k + 1 < fill.cornerBegin.size(); ++k) sum += areaOf(fill, k);
    return sum;
}

int windingNumber(const std::vector<std::vector<glm::dvec2>>& loops, const glm::dvec2& p) {
    double turn = 0;
    for (const auto& loop : loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const glm::dvec2 a = loop[i] - p;
            const glm::dvec2 b = loop[(i + 1) % loop.size()] - p;
            turn += std::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b));
        }
    }
    return static_cast<int>(std::lround(turn / (2 * std::numbers::pi)));
}

std::vector<glm::dvec2> starPolygon(int points, int step) {
    std::vector<glm::dvec2> loop;
    for (int i = 0; i < points; ++i) {
        const double angle = 2 * std::numbers::pi * i * step / points;
        loop.emplace_back(std::cos(angle), std::sin(angle));
    }
    return loop;
}

TEST(FaceFiller, IncludesTheCoreOfAPentagram) {
    const FilledFaces fill = filled(flat({starPolygon(5, 2)}, {1, 0, 0}, {0, 0.6, 0.8}), 1);
    // The outline of the pentagram has ten corners, alternately at the radii 1 and 1 / φ². They divide the pentagram
    // into ten triangles with an angle of π / 5 at the center.
    const double inner = 1 / (std::numbers::phi * std::numbers::phi);
    EXPECT_NEAR(areaOf(fill), 5 * inner * std::sin(std::numbers::pi / 5), 1e-9);
    ASSERT_EQ(fill.faces.size(), 1U);
    EXPECT_EQ(fill.faces[0].winding, 2);
}

TEST(FaceFiller, IsRoughIfThereAreTooFewSteps) {
    const SliceSet slices = flat({starPolygon(7, 3)}, {1, 0, 0}, {0, 1, 0});
    for (const std::size_t steps : {0, 48, 49, 100}) {
        FilledFaces fill;
        FaceFiller().fill(slices, 1, fill, steps);
        ASSERT_EQ(fill.faces.size(), 1U);
        EXPECT_EQ(fill.faces[0].winding, 0);
        EXPECT_EQ(fill.cornerBegin.size() - 1, 7U);
        // A star polygon is star-shaped about its center. So the triangles overlap only in the core of the star.
        EXPECT_NEAR(areaOf(fill), 3.5 * std::sin(6 * std::numbers::pi / 7), 1e-9);
    }
    FilledFaces fill;
    FaceFiller().fill(slices, 1, fill, 10'000);
    EXPECT_EQ(fill.faces[0].winding, 3);
    EXPECT_LT(areaOf(fill), 3.5 * std::sin(6 * std::numbers::pi / 7));
}

TEST(FaceFiller, FillsTheFirstSlicesAndReturnsTheStepsThatAreLeft) {
    SliceSet slices = flat({starPolygon(5, 2)}, {1, 0, 0}, {0, 1, 0});
    slices.appendSlices(flat({starPolygon(7, 3)}, {1, 0, 0}, {0, 1, 0}));
    FilledFaces one, both;
    const std::size_t steps = 10'000;
    const std::size_t afterOne = FaceFiller().fill(slices, 1, one, steps, 1);
    const std::size_t afterBoth = FaceFiller().fill(slices, 1, both, steps, 2);
    EXPECT_EQ(one.faceBegin, (std::vector<std::uint32_t>{0, 1, 1}));
    EXPECT_EQ(both.faceBegin, (std::vector<std::uint32_t>{0, 1, 2}));
    ASSERT_EQ(one.faces.size(), 1U);
    EXPECT_EQ(one.faces[0].winding, 2);
    EXPECT_LT(afterOne, steps);
    EXPECT_LT(afterBoth, afterOne);
    FilledFaces rough;
    EXPECT_EQ(FaceFiller().fill(slices, 1, rough, 9), 9U) << "a face that is filled roughly takes no steps";
}

TEST(FaceFiller, FillsALoopThatIsNotFlatUpToItsSides) {
    const std::vector<glm::dvec2> square{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    SliceSet saddle = flat({square}, {1, 0, 0}, {0, 1, 0});
    for (std::size_t i = 0; i < 4; ++i) saddle.vertices[i].z += i % 2 == 0 ? 0.5 : -0.5;
    const std::size_t steps = 1000;
    FilledFaces fill;
    EXPECT_EQ(FaceFiller().fill(saddle, 2, fill, steps), steps) << "it takes no steps";
    ASSERT_EQ(fill.faces.size(), 1U);
    EXPECT_EQ(fill.faces[0].winding, 0);
    ASSERT_EQ(fill.cornerBegin.size() - 1, 4U);
    const glm::dvec3 middle = fill.corners[0];
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(fill.corners[3 * i], middle);
        EXPECT_EQ(fill.corners[3 * i + 1], saddle.vertices[i]);
        EXPECT_EQ(fill.corners[3 * i + 2], saddle.vertices[(i + 1) % 4]);
    }
    EXPECT_LT(glm::distance(middle, glm::dvec3(0.3, -0.2, 0.1)), 1e-12);
    // A loop that is flat except for rounding is filled by a single piece.
    for (std::size_t i = 0; i < 4; ++i) saddle.vertices[i].z *= 1e-12;
    EXPECT_LT(FaceFiller().fill(saddle, 2, fill, steps), steps);
    EXPECT_EQ(fill.cornerBegin.size() - 1, 1U);
}

TEST(FaceFiller, LeavesAHoleBetweenOppositeLoops) {
    std::vector<glm::dvec2> inner{{-1, -1}, {-1, 1}, {1, 1}, {1, -1}};
    const std::vector<glm::dvec2> outer{{-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
    EXPECT_NEAR(areaOf(filled(flat({outer, inner}, {1, 0, 0}, {0, 1, 0}), 3)), 12, 1e-8);
    std::reverse(inner.begin(), inner.end());
    EXPECT_NEAR(areaOf(filled(flat({outer, inner}, {1, 0, 0}, {0, 1, 0}), 3)), 16, 1e-8);
}

// A comb is divided into few pieces: pieces continue from strip to strip. The teeth of the comb all have different
// lengths. So most strips contain many pieces, and all of these except one continue into the next strip.
TEST(FaceFiller, ContinuesThePiecesOfACombInEachStrip) {
    constexpr int kTeeth = 60;
    std::vector<glm::dvec2> comb{{2.0 * kTeeth - 1, 0.0}};
    double area = 2 * kTeeth - 1;
    for (int tooth = kTeeth; tooth-- > 0;) {
        const double length = 1 + 7 * tooth % kTeeth;
        const double left = 2 * tooth;
        comb.emplace_back(left + 1, 1);
        comb.emplace_back(left + 1, 1 + length);
        comb.emplace_back(left, 1 + length);
        if (tooth > 0) comb.emplace_back(left, 1);
        area += length;
    }
    comb.emplace_back(0, 0);
    const FilledFaces fill = filled(flat({comb}, {1, 0, 0}, {0, 0.6, 0.8}), kTeeth);
    EXPECT_NEAR(areaOf(fill), area, 1e-6);
    ASSERT_EQ(fill.faces.size(), 1U);
    EXPECT_EQ(fill.faces[0].winding, 1);
    // A polygon that does not cross itself is divided into at most as many trapezoids as it has sides.
    EXPECT_LE(fill.cornerBegin.size() - 1, comb.size());
}

TEST(FaceFiller, CoversExactlyThePointsWithNonzeroWindingNumber) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-1, 1);
    for (int trial = 0; trial < 60; ++trial) {
        // Random loops. In every other trial, their corners lie on a coarse grid, so that sides overlap and corners lie
        // on sides.
        std::vector<std::vector<glm::dvec2>> loops(1 + random() % 3);
        for (auto& loop : loops) {
            for (std::size_t n = 3 + random() % 9; n-- > 0;) {
                glm::dvec2 p(place(random), place(random));
                if (trial % 2 == 0) p = glm::round(p * 3.0) / 3.0;
                loop.push_back(p);
            }
        }
        const glm::dvec3 u = glm::normalize(glm::dvec3(place(random), place(random), 1));
        const glm::dvec3 v = glm::normalize(glm::cross(u, glm::dvec3(0.3, 1, place(random))));
        const SliceSet slices = flat(loops, u, v);
        const FilledFaces fill = filled(slices, 1.5);
        const auto onPlane = [&](const glm::dvec3& x) {
            const glm::dvec3 from = x - glm::dvec3(0.3, -0.2, 0.1);
            return glm::dvec2(glm::dot(from, u), glm::dot(from, v));
        };
        int inside = 0;
        for (int i = 0; i < 2000; ++i) {
            const glm::dvec2 p(place(random), place(random));
            int holders = 0;
            bool near = false;  // near an edge, the point may count as inside or outside
            for (std::size_t k = 0; k + 1 < fill.cornerBegin.size(); ++k) {
                // Signed distances of the point from the sides; a piece may have either orientation.
                double least = 1, most = -1;
                for (auto c = fill.cornerBegin[k]; c < fill.cornerBegin[k + 1]; ++c) {
                    const auto next = c + 1 < fill.cornerBegin[k + 1] ? c + 1 : fill.cornerBegin[k];
                    const glm::dvec2 a = onPlane(fill.corners[c]), b = onPlane(fill.corners[next]) - a;
                    const double distance = (b.x * (p.y - a.y) - b.y * (p.x - a.x)) / glm::length(b);
                    least = std::min(least, distance);
                    most = std::max(most, distance);
                }
                near = near || std::abs(least) < 1e-6 || std::abs(most) < 1e-6;
                holders += least > 0 || most < 0 ? 1 : 0;
            }
            if (near) continue;
            ASSERT_LE(holders, 1) << "pieces do not overlap; trial " << trial;
            ASSERT_EQ(holders, windingNumber(loops, p) != 0 ? 1 : 0) << "trial " << trial;
            inside += holders;
        }
        const double share = inside / 2000.0 * 4;
        EXPECT_NEAR(areaOf(fill), share, 0.3) << "trial " << trial;
    }
}

TEST(FaceFiller, PiecesLieInTheirPlaneAndFaceOutward) {
    std::mt19937 random(7);
    for (const polytopes::Polytope& polytope : starPolychora()) {
        SliceSet slices;
        CellComplexSlicer().slice(polytope, randomRotation(random), {-4, 9, polytope.circumradius / 5}, slices);
        const FilledFaces fill = filled(slices, polytope.circumradius);
        for (std::size_t p = 0; p < fill.faces.size(); ++p) {
            const FilledFaces::FilledFace& face = fill.faces[p];
            for (auto k = fill.pieceBegin[p]; k < fill.pieceBegin[p + 1]; ++k) {
                const auto begin = fill.cornerBegin[k], end = fill.cornerBegin[k + 1];
                glm::dvec3 area(0);
                for (auto c = begin; c < end; ++c) {
                    ASSERT_NEAR(glm::dot(face.normal, fill.corners[c]), face.offset, 1e-9 * polytope.circumradius);
                    area += glm::cross(fill.corners[c] - fill.corners[begin],
                                       fill.corners[c + 1 < end ? c + 1 : begin] - fill.corners[begin]);
                }
                ASSERT_GT(glm::dot(area, face.normal), 0) << "winding numbers of star polychora have one sign";
            }
        }
    }
}

// The winding numbers along a ray from the center of a star polychoron add up to its density. The ray passes through
// faces, and their winding numbers are added (Coxeter, Regular Polytopes, table I (iii)).
TEST(FaceFiller, WindingNumbersAlongARayAddUpToTheDensity) {
    const std::array densities{4, 4, 6, 20, 20, 66, 76, 76, 191, 191};
    std::mt19937 random(9);
    std::normal_distribution<double> normal;
    std::size_t number = 0;
    for (const polytopes::Polytope& polytope : starPolychora()) {
        const SliceSet slices = cutAt(polytope, randomRotation(random), 0);
        const FilledFaces fill = filled(slices, polytope.circumradius);
        for (int trial = 0; trial < 5; ++trial) {
            const auto ray = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
            int winding = 0;
            for (const FilledFaces::FilledFace& face : fill.faces) {
                const double along = glm::dot(face.normal, ray);
                if (face.offset / along < 0) continue;
                const glm::dvec3 hit = ray * (face.offset / along);
                const glm::dvec3 u = glm::normalize(glm::cross(face.normal, glm::dvec3(0.1, 0.7, -0.3)));
                const glm::dvec3 v = glm::cross(face.normal, u);
                std::vector<std::vector<glm::dvec2>> loops;
                for (auto f = face.firstLoop; f < face.endLoop; ++f) {
                    loops.emplace_back();
                    for (auto i = slices.cornerBegin[f]; i < slices.cornerBegin[f + 1]; ++i) {
                        const glm::dvec3 x = corner(slices, 0, i);
                        loops.back().emplace_back(glm::dot(x, u), glm::dot(x, v));
                    }
                }
                const int around = windingNumber(loops, {glm::dot(hit, u), glm::dot(hit, v)});
                EXPECT_LE(std::abs(around), face.winding);
                winding += along > 0 ? around : -around;
            }
            EXPECT_EQ(winding, densities.at(number)) << "number " << number;
        }
        ++number;
    }
}

TEST(FaceFiller, MakesOnePiecePerFaceOfConvexSlices) {
    std::mt19937 random(8);
    for (const polytopes::Polytope& polytope : {regular(k5, k3, k3), regular(k3, k4, k3)}) {
        SliceSet slices;
        CellComplexSlicer().slice(polytope, randomRotation(random), {-10, 21, polytope.circumradius / 10}, slices);
        const FilledFaces fill = filled(slices, polytope.circumradius);
        EXPECT_EQ(fill.faces.size(), slices.faceSource.size());
        EXPECT_EQ(fill.cornerBegin.size(), slices.faceSource.size() + 1) << "one piece each";
    }
}

TEST(Convexity, HoldsForConvexUniformPolychoraAndNoStar) {
    const std::array<bool, 4> all{true, true, true, true};
    for (const auto& [p, q, r] : {std::array{k3, k3, k3}, {k4, k3, k3}, {k3, k4, k3}, {k5, k3, k3}}) {
        for (const std::array<bool, 4>& ringed : {std::array<bool, 4>{true, false, false, false},
                                                  {false, false, false, true},
                                                  {false, true, false, false},
                                                  {true, false, true, false},
                                                  all}) {
            const polytopes::CoxeterDiagram diagram = polytopes::CoxeterDiagram::linear(p, q, r, ringed);
            EXPECT_TRUE(polytopes::wythoffConstruction("convex", diagram, polytopes::mirrorsOf(diagram)).convex);
        }
    }
    for (const polytopes::Polytope& star : starPolychora()) EXPECT_FALSE(star.convex);
}

TEST(Convexity, DoesNotHoldForACompound) {
    const polytopes::Polytope one = regular(k4, k3, k3);
    std::vector<glm::dvec4> vertices = one.vertices;
    geometry::JaggedArray faces = one.faces, cells = one.cells;
    const auto shift = static_cast<std::uint32_t>(one.vertices.size());
    const geometry::Rotation turn(geometry::RotationAngles{geometry::Plane::xy, 0.4, {}});
    for (const glm::dvec4& v : one.vertices) vertices.push_back(turn(v));
    for (std::size_t f = 0; f < one.faces.size(); ++f) {
        std::vector<std::uint32_t> loop;
        for (const auto v : one.faces[f]) loop.push_back(v + shift);
        faces.add(loop);
    }
    for (std::size_t c = 0; c < one.cells.size(); ++c) {
        std::vector<std::uint32_t> list;
        for (const auto f : one.cells[c]) list.push_back(f + static_cast<std::uint32_t>(one.faces.size()));
        cells.add(list);
    }
    EXPECT_FALSE(polytopes::makePolytope("compound", vertices, faces, cells).convex);
}

TEST(Convexity, IsInvariantUnderTranslation) {
    const polytopes::Polytope one = regular(k3, k4, k3);
    std::vector<glm::dvec4> vertices = one.vertices;
    for (glm::dvec4& v : vertices) v += glm::dvec4(7, 0, -3, 1);
    EXPECT_TRUE(polytopes::makePolytope("elsewhere", vertices, one.faces, one.cells).convex);
}

}  // namespace
