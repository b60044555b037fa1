// Tests of elements: turning them toward +w, their sizes, and the heights of vertices.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "fields/array_field.hpp"
#include "geometry/point_cloud.hpp"
#include "slicing/element.hpp"
#include "unit/slicing/field_support.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::slicing {
namespace {

using polytopes::Polytope;
using support::shared;

const glm::dvec4 kW(0, 0, 0, 1);

// Returns the w coordinates of the element's vertices after rotation by `orientation`.
std::vector<double> heightsOf(const Polytope& p, const Element& element, const geometry::Rotation& orientation) {
    std::set<std::uint32_t> vertices;
    switch (element.kind) {
        case ElementKind::vertex:
            vertices.insert(static_cast<std::uint32_t>(element.index));
            break;
        case ElementKind::edge:
            vertices.insert(p.edges[element.index].begin(), p.edges[element.index].end());
            break;
        case ElementKind::face:
            for (const auto v : p.faces[element.index]) vertices.insert(v);
            break;
        case ElementKind::cell:
            for (const auto face : p.cells[element.index]) {
                for (const auto v : p.faces[face]) vertices.insert(v);
            }
    }
    std::vector<double> heights;
    for (const auto v : vertices) heights.push_back(orientation(p.vertices[v]).w);
    return heights;
}

geometry::Rotation turnedTo(const Object& object, const Element& element, const geometry::Rotation& from) {
    return rotationToW(object, element, from) * from;
}

TEST(Elements, LieInOneHyperplaneOnceTheyPointToW) {
    std::mt19937 random(11);
    for (const char* name : {"5-cell", "tesseract", "24-cell", "rectified 5-cell", "snub 24-cell", "3,5-duoprism",
                             "small stellated 120-cell", "dual of rectified tesseract"}) {
        const auto polytope = shared(name);
        const Object object = polytope;
        for (const auto& [kindName, kind] : kElementKinds) {
            ASSERT_EQ(elementCount(object, kind), elementCounts(object).at(static_cast<std::size_t>(kind)));
            for (int round = 0; round < 10; ++round) {
                const Element element{kind, random() % elementCount(object, kind)};
                const auto orientation = turnedTo(object, element, support::randomRotation(random));
                const auto heights = heightsOf(*polytope, element, orientation);
                const auto [least, most] = std::ranges::minmax(heights);
                EXPECT_LT(most - least, 1e-12 * polytope->circumradius) << name << ", " << kindName;
                if (!polytope->convex) continue;
                EXPECT_GT(least, 0) << name << ", " << kindName;
                if (kind != ElementKind::cell) continue;
                EXPECT_NEAR(most, rangeOfW(object, orientation).second, 1e-12 * polytope->circumradius)
                    << "a cell of a convex polytope supports it";
            }
        }
    }
}

// An element that is turned toward +w lies in one hyperplane, even if the vertices are rounded, as those of objects
// from files are. The rounding errors do not count as directions of the element.
TEST(Elements, LieInOneHyperplaneToWithinTheRoundingOfTheirVertices) {
    std::mt19937 random(48);
    for (const char* name : {"5-cell", "tesseract", "24-cell", "3,3-duoprism", "3,5-duoprism", "snub 24-cell"}) {
        for (const double unit : {1e-3, 1e-4, 1e-5}) {
            const auto exact = shared(name);
            const geometry::Rotation turned = support::randomRotation(random);
            std::vector<glm::dvec4> vertices;
            for (const glm::dvec4& v : exact->vertices) vertices.push_back(glm::round(turned(v) / unit) * unit);
            const auto rounded = std::make_shared<const Polytope>(
                polytopes::makePolytope("rounded", std::move(vertices), exact->faces, exact->cells));
            const Object object = rounded;
            for (const auto& [kindName, kind] : kElementKinds) {
                for (std::size_t i = 0; i < elementCount(object, kind); ++i) {
                    const auto heights = heightsOf(*rounded, {kind, i}, turnedTo(object, {kind, i}, turned));
                    const auto [least, most] = std::ranges::minmax(heights);
                    ASSERT_LE(most - least, 10 * unit) << name << ' ' << unit << ' ' << kindName << ' ' << i;
                }
            }
        }
    }
}

TEST(Elements, ThroughTheOriginTurnTheShortestWay) {
    // A point at the origin has no direction of its own, so the rotation leaves it where it is.
    const Object object = std::make_shared<const geometry::PointCloud>(
        geometry::makePointCloud("points", {{0, 0, 0, 0}, {1, 0, 0, 0}}, {0, 0}));
    std::mt19937 random(12);
    const auto from = support::randomRotation(random);
    const glm::dvec4 direction = elementDirectionOf(object, {ElementKind::vertex, 0}, from.inverse()(kW));
    EXPECT_LT(glm::distance(glm::normalize(direction), from.inverse()(kW)), 1e-12);
    EXPECT_LT(glm::distance(glm::normalize(elementDirectionOf(object, {ElementKind::vertex, 1}, kW)), {1, 0, 0, 0}),
              1e-12);
    EXPECT_EQ(elementCount(object, ElementKind::cell), 0U);
    EXPECT_FALSE(elementToTurnTo(object, ElementKind::cell, from));
}

TEST(Elements, ClosestToWIsChosenAndThenTheNext) {
    const auto polytope = shared("24-cell");
    const Object object = polytope;
    std::mt19937 random(13);
    for (const auto& [kindName, kind] : kElementKinds) {
        const auto from = support::randomRotation(random);
        const auto closest = elementToTurnTo(object, kind, from);
        ASSERT_TRUE(closest);
        const auto cosineOf = [&](std::size_t i) {
            return glm::normalize(from(elementDirectionOf(object, {kind, i}, kW))).w;
        };
        for (std::size_t i = 0; i < elementCount(object, kind); ++i)
            EXPECT_LE(cosineOf(i), cosineOf(closest->index) + 1e-9) << kindName;
        std::set<std::size_t> visited;
        geometry::Rotation orientation = from;
        for (std::size_t i = 0; i < elementCount(object, kind); ++i) {
            const auto next = elementToTurnTo(object, kind, orientation);
            ASSERT_TRUE(next);
            visited.insert(next->index);
            orientation = turnedTo(object, *next, orientation);
        }
        EXPECT_EQ(visited.size(), elementCount(object, kind)) << "repetition visits every " << kindName;
    }
}

// The element to turn to can be restricted to elements at another element. In a 24-cell, every 2-face belongs to two
// cells and has three edges and three vertices; every vertex belongs to six cells (Coxeter, Regular Polytopes, table
// I).
TEST(Elements, AreChosenAmongThoseAtAnother) {
    const Object object = shared("24-cell");
    std::mt19937 random(14);
    struct {
        ElementKind lit, kind;
        std::size_t count;
    } const rows[] = {{ElementKind::face, ElementKind::cell, 2},   {ElementKind::face, ElementKind::edge, 3},
                      {ElementKind::face, ElementKind::vertex, 3}, {ElementKind::face, ElementKind::face, 1},
                      {ElementKind::vertex, ElementKind::cell, 6}, {ElementKind::cell, ElementKind::vertex, 6},
                      {ElementKind::edge, ElementKind::face, 3},   {ElementKind::cell, ElementKind::face, 8}};
    for (const auto& [litKind, kind, count] : rows) {
        const Element lit{litKind, random() % elementCount(object, litKind)};
        geometry::Rotation orientation = support::randomRotation(random);
        std::set<std::size_t> visited;
        for (std::size_t i = 0; i < 2 * count; ++i) {
            const auto next = elementToTurnTo(object, kind, orientation, lit);
            ASSERT_TRUE(next);
            visited.insert(next->index);
            orientation = turnedTo(object, *next, orientation);
        }
        EXPECT_EQ(visited.size(), count);
        if (kind == litKind) {
            EXPECT_EQ(*visited.begin(), lit.index);
        }
    }
}

TEST(ElementsCutBy, AreThoseFromWhichTheSliceIsCut) {
    std::mt19937 random(17);
    for (const char* name : {"5-cell", "24-cell", "snub 24-cell", "3,5-duoprism"}) {
        const auto polytope = shared(name);
        const Object object = polytope;
        for (int round = 0; round < 5; ++round) {
            const geometry::Rotation orientation = support::randomRotation(random);
            const double w = std::uniform_real_distribution<double>(-0.9, 0.9)(random) * polytope->circumradius;
            const SliceSet slice = support::cutAt(*polytope, orientation, w);
            const auto expectSources = [&](ElementKind kind, const std::vector<std::uint32_t>& sources) {
                const std::vector<bool> isCut = elementsCutBy(object, kind, orientation, {0, 1, 1, w});
                ASSERT_EQ(isCut.size(), elementCount(object, kind));
                for (std::uint32_t i = 0; i < isCut.size(); ++i)
                    EXPECT_EQ(isCut[i], std::ranges::count(sources, i) > 0) << name << ", " << i;
            };
            expectSources(ElementKind::vertex, {});
            expectSources(ElementKind::edge, slice.vertexSource);
            expectSources(ElementKind::face, slice.edgeSource);
            expectSources(ElementKind::cell, slice.faceSource);
        }
    }
}

TEST(ElementsCutBy, LieInTheHyperplaneOrOnBothSides) {
    const Object tesseract = shared("tesseract");
    const auto countAt = [&](double w, ElementKind kind) {
        return std::ranges::count(elementsCutBy(tesseract, kind, {}, {0, 1, 1, w}), true);
    };
    // The hyperplane w = 1 contains a cell, and cuts all elements of this cell. Elements that only touch the hyperplane
    // are not cut.
    struct {
        ElementKind kind;
        std::ptrdiff_t atOne, atZero;
    } const rows[] = {
        {ElementKind::vertex, 8, 0}, {ElementKind::edge, 12, 8}, {ElementKind::face, 6, 12}, {ElementKind::cell, 1, 6}};
    for (const auto& [kind, atOne, atZero] : rows) {
        EXPECT_EQ(countAt(1, kind), atOne);
        EXPECT_EQ(countAt(0, kind), atZero);
        EXPECT_EQ(countAt(1.5, kind), 0);
    }
}

// Returns the length, the area or the volume: the one that an element of this kind has. Expects that the other two are
// absent. Returns 1 for a vertex.
double sizeIn(const ElementMeasurements& measured, ElementKind kind) {
    EXPECT_EQ(measured.length.has_value(), kind == ElementKind::edge);
    EXPECT_EQ(measured.area.has_value(), kind == ElementKind::face);
    EXPECT_EQ(measured.volume.has_value(), kind == ElementKind::cell);
    return measured.length.value_or(1) * measured.area.value_or(1) * measured.volume.value_or(1);
}

TEST(ElementMeasurements, AreThoseOfRegularPolygonsAndPolyhedra) {
    const double root2 = std::sqrt(2), root3 = std::sqrt(3), root5 = std::sqrt(5);
    struct {
        const char* name;
        double area, volume;  // the area and the volume of a polygon and a polyhedron with the edge length 2
    } const rows[] = {{"5-cell", root3, 2 * root2 / 3},
                      {"tesseract", 4, 8},
                      {"24-cell", root3, 8 * root2 / 3},
                      {"120-cell", std::sqrt(25 + 10 * root5), 2 * (15 + 7 * root5)},
                      {"600-cell", root3, 2 * root2 / 3}};
    std::mt19937 random(15);
    for (const auto& [name, area, volume] : rows) {
        const Object object = shared(name);
        const double sizes[] = {1, 2, area, volume};
        for (const auto& [kindName, kind] : kElementKinds) {
            for (int round = 0; round < 10; ++round) {
                const Element element{kind, random() % elementCount(object, kind)};
                const ElementMeasurements measured = measureElement(object, element);
                const double size = sizes[static_cast<std::size_t>(kind)];
                EXPECT_NEAR(sizeIn(measured, kind), size, 1e-9 * size) << name << ", " << kindName;
                // The center of an element of a regular polytope is the point of the element's span that is closest to
                // the origin.
                EXPECT_LT(glm::distance(measured.center, elementDirectionOf(object, element, kW)), 1e-9) << name;
            }
        }
    }
}

// Areas and volumes count a region that a star encloses several times as often as the star encloses it. A pentagram
// with sides of the length s encloses its middle twice. So its area is that of five triangles with the base s, whose
// apex is the center.
TEST(ElementMeasurements, CountWhatAStarEnclosesSeveralTimes) {
    const auto polytope = shared("small stellated 120-cell");
    const Object object = polytope;
    std::vector<glm::dvec4> normals;
    std::vector<double> offsets;
    findCellHyperplanes(object, normals, offsets);  // the length of a normal is six times the volume of the cell
    std::mt19937 random(16);
    for (int round = 0; round < 10; ++round) {
        const auto [a, b] = polytope->edges[0];
        const double side = glm::distance(polytope->vertices[a], polytope->vertices[b]);
        const double area = 5 * side * side / (4 * std::tan(2 * std::numbers::pi / 5));
        const Element face{ElementKind::face, random() % polytope->faces.size()};
        const Element cell{ElementKind::cell, random() % polytope->cells.size()};
        EXPECT_NEAR(sizeIn(measureElement(object, face), ElementKind::face), area, 1e-9 * area);
        const double volume = glm::length(normals[cell.index]) / 6;
        EXPECT_GT(volume, 0);
        EXPECT_NEAR(sizeIn(measureElement(object, cell), ElementKind::cell), volume, 1e-9 * volume);
    }
}

// The areas of triangles that are not regular follow from their sides by Heron's formula.
TEST(ElementMeasurements, OfTrianglesFollowFromTheirSides) {
    const Object object = transformedTo(shared("5-cell"), {2, glm::dvec3(0.3, -0.2, 0.1), glm::dvec3(0, 0.5, 0.3)});
    const Polytope& image = *std::get<PolytopePtr>(object);
    std::vector<glm::dvec4> normals;
    std::vector<double> offsets;
    findCellHyperplanes(object, normals, offsets);
    for (std::size_t i = 0; i < image.faces.size(); ++i) {
        double sides[3], half = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Element edge{ElementKind::edge, image.faceEdges[i][k]};
            sides[k] = sizeIn(measureElement(object, edge), ElementKind::edge);
            half += sides[k] / 2;
        }
        const double area = std::sqrt(half * (half - sides[0]) * (half - sides[1]) * (half - sides[2]));
        EXPECT_NEAR(sizeIn(measureElement(object, {ElementKind::face, i}), ElementKind::face), area, 1e-9);
    }
    for (std::size_t i = 0; i < image.cells.size(); ++i) {
        EXPECT_NEAR(sizeIn(measureElement(object, {ElementKind::cell, i}), ElementKind::cell),
                    glm::length(normals[i]) / 6, 1e-9);
    }
}

TEST(ElementMeasurements, OfABoxHaveTheUnitsOfItsAxes) {
    fields::FieldArray array;
    array.shape = {2, 2, 2, 2};
    array.box = {glm::dvec4(0), glm::dvec4(1, 2, 3, 40)};
    array.samples = fields::SampleStorage(std::vector<float>(16, 1));
    array.units = {"m", "m", "", "s"};
    const Object object = std::make_shared<const fields::Field>(*fields::fieldFromArray("run", array));
    const std::map<double, std::string> unitOfLength{{1, "m"}, {2, "m"}, {3, ""}, {40, "s"}};
    for (std::size_t i = 0; i < elementCount(object, ElementKind::edge); ++i) {
        const ElementMeasurements edge = measureElement(object, {ElementKind::edge, i});
        EXPECT_EQ(edge.unit, unitOfLength.at(std::round(edge.length.value())));
    }
    std::map<std::string, int> unitsOfAreas, unitsOfVolumes;
    for (std::size_t i = 0; i < elementCount(object, ElementKind::face); ++i)
        ++unitsOfAreas[measureElement(object, {ElementKind::face, i}).unit];
    for (std::size_t i = 0; i < elementCount(object, ElementKind::cell); ++i)
        ++unitsOfVolumes[measureElement(object, {ElementKind::cell, i}).unit];
    EXPECT_EQ(unitsOfAreas, (std::map<std::string, int>{{"m²", 4}, {"m s", 8}, {"", 12}}));
    EXPECT_EQ(unitsOfVolumes, (std::map<std::string, int>{{"m² s", 2}, {"", 6}}));
    EXPECT_EQ(measureElement(object, {ElementKind::vertex, 0}).unit, "");
}

TEST(ElementMeasurements, AreInTheCoordinatesOfTheFile) {
    const auto polytope = shared("tesseract");
    Polytope moved = *polytope;
    moved.originInFile = {5e6, -1, 0.25, 7};
    const Object object = polytope, far = std::make_shared<const Polytope>(moved);
    for (const auto& [kindName, kind] : kElementKinds) {
        const Element element{kind, 5};
        const ElementMeasurements measured = measureElement(object, element), there = measureElement(far, element);
        EXPECT_EQ(sizeIn(there, kind), sizeIn(measured, kind)) << kindName << ": no digits are lost";
        EXPECT_LT(glm::distance(there.center, measured.center + moved.originInFile), 1e-8) << kindName;
    }
    const Object cloud = std::make_shared<const geometry::PointCloud>(
        geometry::makePointCloud("points", {{1, 2, 3, 4}, {5, 6, 7, 8}}, {0, 1}));
    const ElementMeasurements point = measureElement(cloud, {ElementKind::vertex, 1});
    EXPECT_EQ(point.center, glm::dvec4(5, 6, 7, 8));
    EXPECT_EQ(sizeIn(point, ElementKind::vertex), 1);
}

// The elements of a field are those of its box. An element of the box extends along the axes along which its center is
// in the middle of the box.
TEST(ElementMeasurements, OfAFieldAreThoseOfItsBox) {
    const fields::Box box{{0, -1, 2, 10}, {1, 1, 5, 14}};
    const auto function = std::make_shared<TestFunction>([](const glm::dvec4& p) { return p.x; }, 1);
    const Object field =
        std::make_shared<const fields::Field>(fields::makeField("box", function, box, glm::dvec4(1, 1, 1, 0.25)));
    for (const Object& object : {field, transformedTo(field, {2, glm::dvec3(0.3, 0, 0), glm::dvec3(0, 0.5, 0)})}) {
        for (const auto& [kindName, kind] : kElementKinds) {
            for (std::size_t i = 0; i < elementCount(object, kind); ++i) {
                const ElementMeasurements measured = measureElement(object, {kind, i});
                double size = 1;
                int extended = 0;
                for (int axis = 0; axis < 4; ++axis) {
                    if (std::abs(measured.center[axis] - box.center()[axis]) > 1e-9) continue;
                    size *= box.max[axis] - box.min[axis];
                    ++extended;
                }
                EXPECT_EQ(extended, static_cast<int>(kind));
                EXPECT_NEAR(sizeIn(measured, kind), size, 1e-9 * size) << kindName << ' ' << i;
            }
        }
    }
}

TEST(RangeOfW, OfAnElementIsThatOfItsVertices) {
    std::mt19937 random(52);
    for (const char* name : {"5-cell", "3,5-duoprism", "small stellated 120-cell"}) {
        const auto polytope = shared(name);
        for (const auto& [kindName, kind] : kElementKinds) {
            const Element element{kind, random() % elementCount(polytope, kind)};
            const geometry::Rotation orientation = support::randomRotation(random);
            const auto [least, most] = rangeOfW(polytope, orientation, element);
            const auto heights = heightsOf(*polytope, element, orientation);
            const auto expected = std::ranges::minmax(heights);
            EXPECT_NEAR(least, expected.min, 1e-12 * polytope->circumradius) << name << ", " << kindName;
            EXPECT_NEAR(most, expected.max, 1e-12 * polytope->circumradius) << name << ", " << kindName;
        }
    }
}

// The heights of vertices are those of Coxeter's sections. Regular Polytopes, table V, has the distances of the
// 600-cell's vertices from one of them.
TEST(VertexHeights, AreThoseOfCoxetersSections) {
    struct Case {
        const char* name;
        ElementKind kind;
        std::size_t count;
    };
    for (const auto& [name, kind, count] :
         {Case{"600-cell", ElementKind::vertex, 9}, Case{"120-cell", ElementKind::cell, 15},
          Case{"24-cell", ElementKind::vertex, 5}, Case{"24-cell", ElementKind::cell, 3},
          Case{"tesseract", ElementKind::vertex, 5}, Case{"tesseract", ElementKind::cell, 2},
          Case{"16-cell", ElementKind::vertex, 3}, Case{"16-cell", ElementKind::cell, 2},
          Case{"5-cell", ElementKind::vertex, 2}}) {
        const Object object = shared(name);
        std::mt19937 random(14);
        const auto orientation = turnedTo(object, {kind, 0}, support::randomRotation(random));
        std::vector<double> up, down;
        for (auto w = nextVertexHeight(object, orientation, -1e9, true); w;
             w = nextVertexHeight(object, orientation, *w, true))
            up.push_back(*w);
        for (auto w = nextVertexHeight(object, orientation, 1e9, false); w;
             w = nextVertexHeight(object, orientation, *w, false))
            down.push_back(*w);
        EXPECT_EQ(up.size(), count) << name;
        ASSERT_EQ(down.size(), up.size()) << name;
        std::ranges::reverse(down);
        for (std::size_t i = 0; i < up.size(); ++i) EXPECT_NEAR(up[i], down[i], 1e-9) << name;
        const auto [least, most] = rangeOfW(object, orientation);
        EXPECT_NEAR(up.front(), least, 1e-9);
        EXPECT_NEAR(up.back(), most, 1e-9);
    }
}

TEST(Elements, AreShownByExactlyTheListedVerticesAndEdgesOfSlices) {
    constexpr std::uint32_t kSources = 40;
    PartsShowingElement parts;
    for (std::size_t count = 0; count < 10; ++count) {
        for (std::uint32_t source = 0; source < kSources; ++source) {
            EXPECT_EQ(parts.hasVertex(source), std::ranges::count(parts.vertices, source) == 1)
                << source << " of " << count;
            EXPECT_EQ(parts.hasEdge(source), std::ranges::count(parts.edges, source) == 1) << source << " of " << count;
        }
        parts.vertices.push_back(static_cast<std::uint32_t>(4 * count));
        parts.edges.push_back(static_cast<std::uint32_t>(3 * count + 5));
    }
}

}  // namespace
}  // namespace oval4d::slicing
