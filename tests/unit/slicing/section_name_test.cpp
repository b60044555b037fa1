#include "slicing/section_name.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "polytopes/construction/polyhedra.hpp"
#include "unit/slicing/support.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::support;
using namespace oval4d::slicing;

using Names = std::vector<std::string>;
using Points = std::vector<glm::dvec3>;

std::string nameOfSlice(const SliceSet& slices) { return std::string(SectionNamer().nameOfSlice(slices, 0)); }

/// Returns a rotation that turns the center of an element onto the w axis: of the first vertex, edge, 2-face or cell
/// (first = 0 … 3).
geometry::Rotation beginningWith(const polytopes::Polytope& p, int first) {
    std::vector<std::uint32_t> vertices;
    if (first == 0) vertices = {0};
    if (first == 1) vertices.assign(p.edges[0].begin(), p.edges[0].end());
    if (first == 2) vertices.assign(p.faces[0].begin(), p.faces[0].end());
    if (first == 3) {
        for (const std::uint32_t face : p.cells[0])
            vertices.insert(vertices.end(), p.faces[face].begin(), p.faces[face].end());
    }
    glm::dvec4 sum(0);
    for (const std::uint32_t v : vertices) sum += p.vertices[v];
    return ontoW(sum);
}

/// Returns the distinct w coordinates of the vertices, from the greatest to the least.
std::vector<double> levelsOf(const polytopes::Polytope& p, const geometry::Rotation& orientation) {
    std::vector<double> all;
    for (const auto& v : p.vertices) all.push_back(orientation(v).w);
    std::sort(all.begin(), all.end(), std::greater());
    std::vector<double> levels;
    for (const double w : all) {
        if (levels.empty() || levels.back() - w > 1e-9 * p.circumradius)
            levels.push_back(std::abs(w) < 1e-9 * p.circumradius ? 0 : w);
    }
    return levels;
}

/// The sections of a regular polytope through its vertices, with their names. An empty name stands for a section
/// without a name.
struct Sections {
    const char* polytope;
    int first;       ///< the dimension of the element toward +w, with which the sections begin
    Names slices;    ///< the names of the slices
    Names vertices;  ///< the names of the convex hulls of the vertices in the hyperplanes
};

/// The sections of regular polytopes. If the sections after the middle one repeat those before it in reverse order, the
/// list ends at the middle one.
const Sections kSections[] = {
    {"5-cell", 0, {"point", "tetrahedron"}, {"point", "tetrahedron"}},
    {"5-cell", 1, {"segment", "triangle"}, {"segment", "triangle"}},
    {"5-cell", 2, {"triangle", "segment"}, {"triangle", "segment"}},
    {"5-cell", 3, {"tetrahedron", "point"}, {"tetrahedron", "point"}},
    {"8-cell", 0, {"point", "tetrahedron", "octahedron"}, {"point", "tetrahedron", "octahedron"}},
    {"8-cell", 1, {"segment", "triangular prism"}, {"segment", "triangular prism"}},
    {"8-cell", 2, {"square", "cuboid"}, {"square", "cuboid"}},
    {"8-cell", 3, {"cube"}, {"cube"}},
    {"16-cell", 0, {"point", "octahedron"}, {"point", "octahedron"}},
    {"16-cell", 1, {"segment", "square bipyramid"}, {"segment", "square"}},
    {"16-cell", 2, {"triangle", "hexagonal bipyramid"}, {"triangle", "segment"}},
    {"16-cell", 3, {"tetrahedron"}, {"tetrahedron"}},
    {"24-cell", 0, {"point", "cube", "rhombic dodecahedron"}, {"point", "cube", "octahedron"}},
    {"24-cell", 1, {"segment", "", "", ""}, {"segment", "triangle", "", "segment"}},
    {"24-cell", 2, {"triangle", "", ""}, {"triangle", "", "hexagon"}},
    {"24-cell", 3, {"octahedron", "cuboctahedron"}, {"octahedron", "cuboctahedron"}},
    {"600-cell",
     0,
     {"point", "icosahedron", "", "", ""},
     {"point", "icosahedron", "dodecahedron", "icosahedron", "icosidodecahedron"}},
    {"600-cell",
     3,
     {"tetrahedron", "", "", "", "", "", "", ""},
     {"tetrahedron", "tetrahedron", "octahedron", "", "", "", "tetrahedron", "cuboctahedron"}},
    {"120-cell",
     0,
     {"point", "tetrahedron", "", "", "", "", "", "", "", "", "", "", "", "", "", ""},
     {"point", "tetrahedron", "", "", "", "tetrahedron", "", "", "", "", "", "", "", "", "", ""}},
    {"120-cell",
     3,
     {"dodecahedron", "dodecahedron", "icosidodecahedron", "", "", "rhombicosidodecahedron", "", ""},
     {"dodecahedron", "dodecahedron", "icosidodecahedron", "", "", "rhombicosidodecahedron", "dodecahedron", ""}},
};

// The sections of regular polytopes through their vertices have the names in Coxeter, Regular Polytopes, table V, which
// lists the vertices. Coxeter's irregular sections have no name here.
TEST(SliceAndHullNames, ofTheRegularPolytopesThroughTheirVertices) {
    SectionNamer namer;
    for (const Sections& sections : kSections) {
        SCOPED_TRACE(std::string(sections.polytope) + " beginning with an element of dimension " +
                     std::to_string(sections.first));
        const polytopes::Polytope& p = named(sections.polytope);
        const geometry::Rotation orientation = beginningWith(p, sections.first);
        const std::vector<double> levels = levelsOf(p, orientation);
        Names slices;
        Names vertices;
        for (const double w : levels) {
            const SliceSet cut = cutAt(p, orientation, w);
            slices.emplace_back(namer.nameOfSlice(cut, 0));
            vertices.emplace_back(namer.nameOfHullOfObjectVertices(cut, 0, p.edges.size()));
        }
        const auto complete = [&](Names names) {
            for (std::size_t i = names.size(); i < levels.size(); ++i) names.push_back(names[levels.size() - 1 - i]);
            return names;
        };
        EXPECT_EQ(slices, complete(sections.slices));
        EXPECT_EQ(vertices, complete(sections.vertices));
    }
}

// Between the vertices of a polytope, sections have names, too. A polyhedron over a regular polygon (such as a prism)
// has its name at any height. Other polyhedra have a name only if they are uniform.
TEST(SliceAndHullNames, betweenTheVerticesAreThoseOfUniformSections) {
    struct Row {
        const char* polytope;
        int first;
        double w;  // the w of the hyperplane, in circumradii
        const char* name;
    };
    const double octahedra = std::numbers::sqrt2 / 2;  // the w at which the sections of the 24-cell are octahedra
    const double edge = std::sqrt(6) / 4;              // the w of the 5-cell's first section, an edge
    for (const Row& row : {Row{"8-cell", 0, 0.25, "truncated tetrahedron"},
                           {"8-cell", 0, 0.75, "tetrahedron"},
                           {"16-cell", 3, 0, "cuboctahedron"},
                           {"24-cell", 3, octahedra / 2, "truncated octahedron"},
                           {"5-cell", 1, edge - 5.0 / 6 * edge, "triangular prism"}}) {
        SCOPED_TRACE(row.polytope);
        const polytopes::Polytope& p = named(row.polytope);
        const geometry::Rotation orientation = beginningWith(p, row.first);
        EXPECT_EQ(nameOfSlice(cutAt(p, orientation, row.w * p.circumradius)), row.name);
        const std::string beside = nameOfSlice(cutAt(p, orientation, (row.w + 1e-4) * p.circumradius));
        const std::string_view name(row.name);
        EXPECT_EQ(beside, name == "tetrahedron" || name == "triangular prism" ? name : "");
    }
}

// The section in the hyperplane of a cell has the name of the cell. The names of cells are found from their faces,
// without the class under test.
TEST(SliceAndHullNames, inTheHyperplaneOfACellAreTheNamesOfTheCells) {
    Names polytopes{"snub 24-cell", "rectified 600-cell", "runcitruncated 16-cell", "omnitruncated 24-cell"};
    for (const polytopes::NamedPolyhedron& solid : polytopes::namedPolyhedra()) {
        if (isConvex(solid)) polytopes.push_back(std::string(solid.name) + " prism");
    }
    for (int n = 3; n <= 20; ++n) {
        polytopes.push_back(std::to_string(n) + ",7-duoprism");
        polytopes.push_back(std::to_string(n) + "-gonal antiprism prism");
    }
    std::map<std::string, int> seen;
    std::vector<glm::dvec4> normals;
    std::vector<double> offsets;
    for (const std::string& name : polytopes) {
        SCOPED_TRACE(name);
        const polytopes::Polytope& p = named(name);
        findCellHyperplanes(objectOf(p), normals, offsets);
        for (std::uint32_t type = 0; type < p.cellTypes.size(); ++type) {
            const auto cell = std::find(p.typeOfCell.begin(), p.typeOfCell.end(), type) - p.typeOfCell.begin();
            const double w = offsets[cell] / glm::length(normals[cell]);
            const SliceSet cut = cutAt(p, ontoW(normals[cell]), w);
            EXPECT_EQ(nameOfSlice(cut), p.cellTypes[type].name);
            EXPECT_EQ(SectionNamer().nameOfHullOfObjectVertices(cut, 0, p.edges.size()), p.cellTypes[type].name);
            ++seen[p.cellTypes[type].name];
        }
    }
    EXPECT_EQ(seen.size(), 18U + 17 + 17);
}

// Catalan solids and duals of antiprisms are named. The middle section of a prism over a polyhedron is this polyhedron.
// Each section of a pyramid between the base and the apex is similar to the base.
TEST(SliceAndHullNames, areThoseOfCatalanSolidsAndOfDualsOfAntiprisms) {
    for (const char* solid :
         {"triakis tetrahedron", "rhombic dodecahedron", "triakis octahedron", "tetrakis hexahedron",
          "deltoidal icositetrahedron", "disdyakis dodecahedron", "pentagonal icositetrahedron",
          "rhombic triacontahedron", "triakis icosahedron", "pentakis dodecahedron", "deltoidal hexecontahedron",
          "disdyakis triacontahedron", "pentagonal hexecontahedron", "square trapezohedron", "pentagonal trapezohedron",
          "hexagonal bipyramid"}) {
        for (const char* over : {"prism of ", "pyramid of "}) {
            SCOPED_TRACE(std::string(over) + solid);
            const polytopes::Polytope& p = named(std::string(over) + solid);
            const auto [least, most] = std::ranges::minmax(levelsOf(p, geometry::Rotation()));
            EXPECT_EQ(nameOfSlice(cutAt(p, geometry::Rotation(), (2 * least + most) / 3)), solid);
        }
    }
}

TEST(SliceAndHullNames, areThoseOfPrismsAndCuboidsOfAnyHeight) {
    // Every section w = const of a duoprism is a prism over its first polygon, the one with fewer sides.
    for (const auto& [duoprism, name] : {std::pair{"3,5-duoprism", "triangular prism"},
                                         {"4,5-duoprism", "cuboid"},
                                         {"5,7-duoprism", "pentagonal prism"},
                                         {"20,25-duoprism", "20-gonal prism"},
                                         {"21,25-duoprism", ""}}) {
        SCOPED_TRACE(duoprism);
        const polytopes::Polytope& p = named(duoprism);
        for (const double w : {0.0, 0.1, -0.2}) EXPECT_EQ(nameOfSlice(cutAt(p, geometry::Rotation(), w)), name);
    }
    // A hyperplane that turns about a 2-face of one of the tesseract's cubes cuts a cuboid. A hyperplane that turns
    // about an edge does not.
    const polytopes::Polytope& tesseract = named("8-cell");
    EXPECT_EQ(nameOfSlice(cutAt(tesseract, ontoW({0.1, 0, 0, 1}), 0)), "cuboid");
    EXPECT_EQ(nameOfSlice(cutAt(tesseract, ontoW({0.1, 0.1, 0, 1}), 0)), "");
    EXPECT_EQ(nameOfSlice(cutAt(tesseract, ontoW({0, 1, 1, 1}), 0)), "hexagonal prism");
}

/// Returns a slice with these vertices and edges, and with as many faces as a convex polyhedron with them has.
SliceSet sliceWith(const Points& points, const std::vector<std::array<std::uint32_t, 2>>& edges) {
    SliceSet slice;
    slice.vertices = points;
    slice.vertexSource.resize(points.size());
    slice.edges = edges;
    slice.vertexBegin = {0, static_cast<std::uint32_t>(points.size())};
    slice.edgeBegin = {0, static_cast<std::uint32_t>(edges.size())};
    slice.faceBegin = {0, static_cast<std::uint32_t>(edges.size() + 2 - points.size())};
    return slice;
}

TEST(SliceAndHullNames, areThoseOfRightPolyhedraOverRegularPolygonsOnly) {
    // The base is a pentagon with the radius 1 in the plane z = 0. Over it stand an antiprism, a pyramid and a
    // bipyramid.
    constexpr std::uint32_t kSides = 5;
    const auto pointAt = [](double turns, double z) {
        const double angle = 2 * std::numbers::pi * turns / kSides;
        return glm::dvec3(std::cos(angle), std::sin(angle), z);
    };
    for (const double height : {0.3, 1.0, 4.0}) {
        SCOPED_TRACE(height);
        Points pyramid, antiprism;
        std::vector<std::array<std::uint32_t, 2>> base, toApex, toSecondApex, lateral;
        for (std::uint32_t i = 0; i < kSides; ++i) {
            const std::uint32_t next = (i + 1) % kSides;
            pyramid.push_back(pointAt(i, 0));
            base.push_back({i, next});
            toApex.push_back({i, kSides});
            toSecondApex.push_back({i, kSides + 1});
            lateral.insert(lateral.end(), {{i, kSides + i}, {next, kSides + i}, {kSides + i, kSides + next}});
        }
        antiprism = pyramid;
        for (std::uint32_t i = 0; i < kSides; ++i) antiprism.push_back(pointAt(i + 0.5, height));
        pyramid.emplace_back(0, 0, height);
        Points bipyramid = pyramid;
        bipyramid.emplace_back(0, 0, -height);
        const auto joined = [](auto edges, const auto& more) {
            edges.insert(edges.end(), more.begin(), more.end());
            return edges;
        };
        const auto pyramidEdges = joined(base, toApex);
        const auto shapes = std::map<std::string, SliceSet>{
            {"pentagonal pyramid", sliceWith(pyramid, pyramidEdges)},
            {"pentagonal bipyramid", sliceWith(bipyramid, joined(pyramidEdges, toSecondApex))},
            {"pentagonal antiprism", sliceWith(antiprism, joined(base, lateral))}};
        for (const auto& [name, slice] : shapes) {
            EXPECT_EQ(nameOfSlice(slice), name);
            EXPECT_EQ(SectionNamer().nameOfHullOfObjectVertices(slice, 0, 0), name);
            SliceSet oblique = slice, stretched = slice;
            for (glm::dvec3& v : oblique.vertices) v.x += 0.1 * v.z;
            for (glm::dvec3& v : stretched.vertices) v.x *= 1.1;
            EXPECT_EQ(nameOfSlice(oblique), "") << name;
            EXPECT_EQ(nameOfSlice(stretched), "") << name;
        }
    }
}

TEST(SliceAndHullNames, dependNeitherOnTheOrientationNorOnTheSize) {
    std::mt19937 random(41);
    std::normal_distribution<double> normal;
    SectionNamer namer;
    for (const Sections& sections : kSections) {
        const polytopes::Polytope& p = named(sections.polytope);
        const geometry::Rotation orientation = beginningWith(p, sections.first);
        const std::vector<double> levels = levelsOf(p, orientation);
        for (std::size_t i = 0; i < sections.slices.size(); ++i) {
            SCOPED_TRACE(std::string(sections.polytope) + " " + std::to_string(i));
            const glm::dquat turn(normal(random), normal(random), normal(random), normal(random));
            const geometry::Rotation around(turn, glm::conjugate(turn));  // this rotation does not change w
            SliceSet cut = cutAt(p, around * orientation, levels[i]);
            const double scale = std::exp(5 * normal(random));
            for (glm::dvec3& v : cut.vertices) v = v * scale + glm::dvec3(scale, 0, -scale);
            EXPECT_EQ(namer.nameOfSlice(cut, 0), sections.slices[i]);
            EXPECT_EQ(namer.nameOfHullOfObjectVertices(cut, 0, p.edges.size()), sections.vertices[i]);
        }
    }
}

TEST(SliceAndHullNames, areFoundForEachSliceOfASet) {
    const polytopes::Polytope& p = named("8-cell");
    SliceSet slices;
    CellComplexSlicer().slice(p, ontoW({1, 1, 1, 1}), {-5, 11, 0.5}, slices);
    SectionNamer namer;
    Names names;
    for (int i = 0; i < slices.planes.count; ++i) names.emplace_back(namer.nameOfSlice(slices, i));
    EXPECT_EQ(names, (Names{"", "point", "tetrahedron", "tetrahedron", "truncated tetrahedron", "octahedron",
                            "truncated tetrahedron", "tetrahedron", "tetrahedron", "point", ""}));
}

TEST(SliceAndHullNames, areNotThoseOfStretchedSolids) {
    const polytopes::Polytope& p = named("600-cell");
    SliceSet cut = cutAt(p, beginningWith(p, 0), 0.9 * p.circumradius);
    ASSERT_EQ(nameOfSlice(cut), "icosahedron");
    const std::vector<glm::dvec3> vertices = cut.vertices;
    for (const auto& [stretch, name] : {std::pair{1 + 1e-8, "icosahedron"}, {1 + 1e-4, ""}, {1.01, ""}, {2.0, ""}}) {
        for (std::size_t i = 0; i < vertices.size(); ++i) cut.vertices[i] = vertices[i] * glm::dvec3(1, stretch, 1);
        EXPECT_EQ(nameOfSlice(cut), name) << stretch;
        EXPECT_EQ(SectionNamer().nameOfHullOfObjectVertices(cut, 0, 0), name) << stretch;
    }
}

/// Returns a slice with these vertices. Its edges join the nearest vertices. It has as many faces as a convex
/// polyhedron with these vertices and edges, according to Euler's formula.
SliceSet sliceOf(const Points& points) {
    SliceSet slice;
    slice.vertices = points;
    slice.vertexSource.resize(points.size());
    double nearest = 1e300;
    for (const auto& a : points) {
        for (const auto& b : points) nearest = a == b ? nearest : std::min(nearest, glm::distance(a, b));
    }
    for (std::uint32_t a = 0; a < points.size(); ++a) {
        for (std::uint32_t b = a + 1; b < points.size(); ++b) {
            if (glm::distance(points[a], points[b]) < nearest * 1.0001) slice.edges.push_back({a, b});
        }
    }
    const auto vertices = static_cast<std::uint32_t>(points.size());
    const auto edges = static_cast<std::uint32_t>(slice.edges.size());
    slice.vertexBegin = {0, vertices};
    slice.edgeBegin = {0, edges};
    slice.faceBegin = {0, edges + 2 - vertices};
    return slice;
}

Points verticesOf(std::string_view name) {
    for (const polytopes::NamedPolyhedron& solid : polytopes::namedPolyhedra()) {
        if (solid.name == name) return polytopes::verticesOf(solid);
    }
    return {};
}

// Solids with turned caps do not have the name of the original solid. If caps of these solids are turned by half of
// their symmetry, the results have the same faces and the same circumradius: Johnson's solids J27, J34, J37, J72 and
// J73.
TEST(SliceAndHullNames, areNotThoseOfSolidsWithTurnedCaps) {
    struct Row {
        const char *solid, *axis;  // the axis runs through the first vertex of the solid with the name `axis`
        int order;                 // the order of the symmetry around the axis
        double height;             // the height of the cap above the center, relative to the circumradius
        bool both;                 // whether the cap on the opposite side is turned, too
    };
    for (const Row& row : {Row{"cuboctahedron", "cube", 3, 0.5, false},
                           {"icosidodecahedron", "icosahedron", 5, 0.3, false},
                           {"rhombicuboctahedron", "octahedron", 4, 0.7, false},
                           {"rhombicosidodecahedron", "icosahedron", 5, 0.9, false},
                           {"rhombicosidodecahedron", "icosahedron", 5, 0.9, true}}) {
        const Points solid = verticesOf(row.solid);
        const glm::dvec3 axis = glm::normalize(verticesOf(row.axis).at(0));
        const double height = row.height * glm::length(solid.at(0));
        for (const int halves : {0, 1, 2}) {
            SCOPED_TRACE(std::string(row.solid) + ", caps turned by " + std::to_string(halves) + " halves");
            const glm::dquat turn = glm::angleAxis(halves * std::numbers::pi / row.order, axis);
            Points turned;
            for (const auto& v : solid) {
                const double above = glm::dot(v, axis);
                turned.push_back(above > height || (row.both && above < -height) ? turn * v : v);
            }
            const SliceSet slice = sliceOf(turned);
            ASSERT_EQ(slice.edges.size(), sliceOf(solid).edges.size());
            const std::string name = halves == 1 ? "" : row.solid;
            EXPECT_EQ(nameOfSlice(slice), name);
            EXPECT_EQ(SectionNamer().nameOfHullOfObjectVertices(slice, 0, 0), name);
        }
    }
}

TEST(SliceAndHullNames, areThoseOfRegularStars) {
    std::size_t stars = 0;
    for (const polytopes::NamedPolyhedron& solid : polytopes::namedPolyhedra()) {
        if (isConvex(solid)) continue;
        ++stars;
        SCOPED_TRACE(solid.name);
        const polytopes::Polytope& p = named(std::string(solid.name) + " prism");
        for (const double w : {0.0, 0.5}) {
            const SliceSet cut = cutAt(p, geometry::Rotation(), w);
            EXPECT_EQ(cut.edgeCount(0), 30U);
            EXPECT_EQ(nameOfSlice(cut), solid.name);
        }
        // The convex hull has a name: its vertices are those of an icosahedron or a dodecahedron.
        const SliceSet base = cutAt(p, geometry::Rotation(), 1);
        EXPECT_EQ(SectionNamer().nameOfHullOfObjectVertices(base, 0, p.edges.size()),
                  base.vertexCount(0) == 12 ? "icosahedron" : "dodecahedron");
    }
    EXPECT_EQ(stars, 4U);
}

TEST(SliceAndHullNames, areThoseOfPrismsOverStarPolygons) {
    // In the name of the duoprism, the polygon with fewer sides comes first. This polygon is the base of the sections.
    for (const auto& [duoprism, name] : {std::pair{"5/2,7-duoprism", "pentagrammic prism"},
                                         {"7/2,8-duoprism", "7/2-gonal prism"},
                                         {"7/3,8-duoprism", "7/3-gonal prism"}}) {
        SCOPED_TRACE(duoprism);
        EXPECT_EQ(nameOfSlice(cutAt(named(duoprism), geometry::Rotation(), 0.1)), name);
    }
}

TEST(SliceAndHullNames, areNotThoseOfCompounds) {
    // A compound of two tetrahedra has the vertices of a cube, but not its name.
    SliceSet slice = sliceOf(verticesOf("cube"));
    ASSERT_EQ(nameOfSlice(slice), "cube");
    slice.edges.clear();
    for (std::uint32_t a = 0; a < 8; ++a) {
        for (std::uint32_t b = a + 1; b < 8; ++b) {
            if (std::abs(glm::distance(slice.vertices[a], slice.vertices[b]) - std::sqrt(8)) < 0.1)
                slice.edges.push_back({a, b});
        }
    }
    ASSERT_EQ(slice.edges.size(), 12U);
    EXPECT_EQ(nameOfSlice(slice), "");  // it would have no name even if it had six faces
    slice.faceBegin[1] = 8;
    EXPECT_EQ(nameOfSlice(slice), "");
}

}  // namespace
