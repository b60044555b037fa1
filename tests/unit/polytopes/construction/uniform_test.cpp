// Tests that build every uniform polychoron of the catalogue and compare it with theory.

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include <gtest/gtest.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "polytopes/catalogue/catalogue.hpp"
#include "polytopes/catalogue/names.hpp"
#include "polytopes/construction/coxeter.hpp"
#include "polytopes/construction/diagram_text.hpp"
#include "unit/slicing/support.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::support;
using namespace oval4d::polytopes;

const double kRoot2 = std::sqrt(2.0);
const double kRoot5 = std::sqrt(5.0);

const Polytope& built(std::string_view name) {
    if (findEntry(name) == nullptr) throw std::invalid_argument(std::string(name));
    return named(name);
}

ElementCounts countsOf(const Polytope& p) {
    return {p.vertices.size(), p.edges.size(), p.faces.size(), p.cells.size()};
}

bool isConvex(const CatalogueEntry& entry) { return entry.family != "star"; }

class Uniform : public testing::TestWithParam<CatalogueEntry> {
  protected:
    const CatalogueEntry& entry = GetParam();
    const std::shared_ptr<const Polytope> polytope = shared(entry.name);
    const Polytope& p = *polytope;
};

/// Invariants of a vertex. The invariants are equal for all vertices if the symmetry group is transitive on the
/// vertices.
struct Surroundings {
    std::vector<long> neighbors;               // the distances of the nearest other vertices, rounded
    std::map<std::uint32_t, int> cellTypes;    // for each cell type, the number of cells at the vertex
    std::map<std::size_t, std::size_t> sides;  // for each number of sides, the number of 2-faces
    bool operator==(const Surroundings&) const = default;
};

std::vector<Surroundings> surroundingsOf(const Polytope& p) {
    std::vector<Surroundings> all(p.vertices.size());
    for (std::size_t f = 0; f < p.faces.size(); ++f) {
        for (const auto v : p.faces[f]) ++all[v].sides[p.faces[f].size()];
    }
    for (std::size_t c = 0; c < p.cells.size(); ++c) {
        std::set<std::uint32_t> corners;
        for (const auto f : p.cells[c]) corners.insert(p.faces[f].begin(), p.faces[f].end());
        for (const auto v : corners) ++all[v].cellTypes[p.typeOfCell[c]];
    }
    // To save time, considers only about 50 vertices, and the 30 least distances from each.
    const std::size_t step = std::max<std::size_t>(p.vertices.size() / 50, 1);
    for (std::size_t v = 0; v < p.vertices.size(); v += step) {
        std::vector<long> distances;
        for (const auto& other : p.vertices)
            distances.push_back(std::lround(glm::distance(p.vertices[v], other) * 1e6));
        const std::size_t most = std::min<std::size_t>(30, distances.size());
        std::partial_sort(distances.begin(), distances.begin() + long(most), distances.end());
        distances.resize(most);
        all[v].neighbors = distances;
    }
    return all;
}

TEST_P(Uniform, looksTheSameFromEveryVertex) {
    const auto all = surroundingsOf(p);
    for (const auto& one : all) {
        EXPECT_EQ(one.cellTypes, all[0].cellTypes);
        EXPECT_EQ(one.sides, all[0].sides);
        if (!one.neighbors.empty()) {
            EXPECT_EQ(one.neighbors, all[0].neighbors);
        }
        if (HasFailure()) return;
    }
}

TEST_P(Uniform, hasRegularPolygons) {
    for (std::size_t f = 0; f < p.faces.size(); ++f) {
        const auto loop = p.faces[f];
        glm::dvec4 center(0);
        for (const auto v : loop) center += p.vertices[v] / double(loop.size());
        const double radius = glm::distance(p.vertices[loop[0]], center);
        for (std::size_t i = 0; i < loop.size(); ++i) {
            ASSERT_NEAR(glm::distance(p.vertices[loop[i]], center), radius, 1e-9);
            ASSERT_NEAR(glm::distance(p.vertices[loop[i]], p.vertices[loop[(i + 1) % loop.size()]]), 2, 1e-9);
        }
    }
}

// A polytope of the catalogue is convex, unless it is a star: it lies on one side of each cell's hyperplane.
TEST_P(Uniform, isConvexUnlessAStar) {
    EXPECT_EQ(p.convexFaces, isConvex(entry) || p.faces[0].size() == 3 || entry.schlaefli.starts_with("{5,"));
    const std::size_t step = std::max<std::size_t>(p.cells.size() / 60, 1);
    bool convex = true;
    for (std::size_t c = 0; c < p.cells.size(); c += step) {
        glm::dvec4 outward(0);
        for (const auto f : p.cells[c]) {
            for (const auto v : p.faces[f]) outward += p.vertices[v];
        }
        outward = glm::normalize(outward);
        const double height = glm::dot(outward, p.vertices[p.faces[p.cells[c][0]][0]]);
        for (const auto& v : p.vertices) convex = convex && glm::dot(outward, v) < height + 1e-9;
    }
    EXPECT_EQ(convex, isConvex(entry));
}

TEST_P(Uniform, hasNamedCellTypes) {
    ASSERT_EQ(p.typeOfCell.size(), p.cells.size());
    std::vector<std::size_t> cells(p.cellTypes.size());
    std::vector<std::set<std::vector<std::size_t>>> shapes(p.cellTypes.size());
    for (std::size_t c = 0; c < p.cells.size(); ++c) {
        ASSERT_LT(p.typeOfCell[c], p.cellTypes.size());
        ++cells[p.typeOfCell[c]];
        std::vector<std::size_t> sides;
        for (const auto f : p.cells[c]) sides.push_back(p.faces[f].size());
        std::sort(sides.begin(), sides.end());
        shapes[p.typeOfCell[c]].insert(sides);
    }
    EXPECT_TRUE(std::is_sorted(cells.begin(), cells.end()));
    for (std::size_t k = 0; k < p.cellTypes.size(); ++k) {
        EXPECT_GT(cells[k], 0U);
        EXPECT_EQ(cells[k], p.cellTypes[k].cells);
        EXPECT_EQ(shapes[k].size(), 1U) << p.cellTypes[k].name;
        EXPECT_FALSE(p.cellTypes[k].name.starts_with("cell of")) << p.cellTypes[k].name;
        EXPECT_EQ(entry.symmetryOrder % cells[k], 0U);  // the size of an orbit divides the order of the group
    }
}

std::map<std::string, long> cellsByName(const Polytope& p) {
    std::map<std::string, long> cells;
    for (const auto type : p.typeOfCell) ++cells[p.cellTypes[type].name];
    return cells;
}

// In a polytope that is read from a file with three decimals, the cell types are found by shape alone, and have the
// same names as in the catalogue.
TEST_P(Uniform, hasCellsRecognizedByTheirShape) {
    auto rounded = p.vertices;
    for (auto& v : rounded) v = glm::round(v * 1000.0) / 1000.0;
    const Polytope read = makePolytope("read", rounded, p.faces, p.cells);
    EXPECT_EQ(cellsByName(read), cellsByName(p));
    EXPECT_EQ(read.cellTypes.size(), cellsByName(read).size());
}

TEST(CellTypes, ofIrregularCellsAreNamedByTheirNumbersOfFaces) {
    const Polytope& regular = built("120-cell");
    std::mt19937 random(33);
    std::uniform_real_distribution<double> factor(0.5, 1.5);
    auto moved = regular.vertices;
    for (auto& v : moved) v *= factor(random);
    const Polytope p = makePolytope("crumpled", moved, regular.faces, regular.cells);
    EXPECT_EQ(p.cellTypes, (std::vector<CellType>{{"cell of 12 faces", 120}}));  // the cells have more shapes than
                                                                                 // there may be types
    auto sheared = built("8-cell").vertices;
    for (auto& v : sheared) v += glm::dvec4(0.4 * v.y, 0.3 * v.z, 0.2 * v.w, 0.1 * v.x);
    const Polytope oblique = makePolytope("oblique", sheared, built("8-cell").faces, built("8-cell").cells);
    EXPECT_EQ(cellsByName(oblique), (std::map<std::string, long>{{"cell of 6 faces", 8}}));
}

TEST(CellTypes, ofBoxesAreCubesAndCuboids) {
    auto stretched = built("8-cell").vertices;
    for (auto& v : stretched) v.x *= 2;
    const Polytope box = makePolytope("box", stretched, built("8-cell").faces, built("8-cell").cells);
    EXPECT_EQ(box.cellTypes, (std::vector<CellType>{{"cube", 2}, {"cuboid", 6}}));
}

std::string asName(const testing::TestParamInfo<CatalogueEntry>& info) {
    std::string name(info.param.name);
    std::replace_if(
        name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
    return "the_" + name;
}

INSTANTIATE_TEST_SUITE_P(All, Uniform, testing::ValuesIn(catalogue().begin(), catalogue().end()), asName);

// Slices are closed surfaces. Slices of convex polytopes are spheres, which Euler's formula shows.
class Sections : public testing::TestWithParam<CatalogueEntry> {};

TEST_P(Sections, areClosedSpheres) {
    const auto polytope = shared(GetParam().name);
    std::mt19937 random(31);
    slicing::SliceSet s;
    slicing::CellComplexSlicer slicer;
    for (int trial = 0; trial < 4; ++trial) {
        geometry::Rotation orientation = trial < 2 ? geometry::Rotation() : randomRotation(random);
        if (trial == 1)
            orientation = geometry::Rotation(geometry::RotationAngles{geometry::Plane::xw, std::numbers::pi / 4, {}});
        slicer.slice(*polytope, orientation, {-5, 11, polytope->circumradius / 5.5}, s);
        for (int i = 0; i < s.planes.count; ++i) {
            if (s.faceCount(i) < 2) continue;
            ASSERT_EQ(s.vertexCount(i) + s.faceCount(i), s.edgeCount(i) + 2) << "slice " << i << " trial " << trial;
            std::vector<int> passes(s.edgeCount(i));
            for (auto f = s.faceBegin[i]; f < s.faceBegin[i + 1]; ++f) {
                for (auto k = s.cornerBegin[f]; k < s.cornerBegin[f + 1]; ++k) {
                    const auto& edge = s.edges[s.edgeBegin[i] + s.cornerEdges[k]];
                    passes[s.cornerEdges[k]] += edge[0] == s.corners[k] ? 1 : -1;
                }
            }
            for (const int sum : passes) ASSERT_EQ(sum, 0);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Convex, Sections, testing::ValuesIn([] {
                             std::vector<CatalogueEntry> convex;
                             std::copy_if(catalogue().begin(), catalogue().end(), std::back_inserter(convex), isConvex);
                             return convex;
                         }()),
                         asName);

/// Returns the hypervolume of the polytope: the sum over cones from the origin to the cells, each divided into
/// simplices.
double hypervolumeOf(const Polytope& p) {
    double sum = 0;
    for (std::uint32_t c = 0; c < p.cells.size(); ++c) {
        const glm::dvec4 apex = p.vertices[p.faces[p.cells[c][0]][0]];
        for (auto slot = p.cells.begin[c]; slot < p.cells.begin[c + 1]; ++slot) {
            const auto loop = p.faces[p.cells.items[slot]];
            for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
                sum += p.cellSigns[slot] * glm::determinant(glm::dmat4(apex, p.vertices[loop[0]], p.vertices[loop[i]],
                                                                       p.vertices[loop[i + 1]]));
            }
        }
    }
    return std::abs(sum) / 24;
}

TEST(Hypervolume, isThatOfTheRegularPolytopeMinusItsCorners) {
    const double cell5 = std::sqrt(5.0) / 96 * 16;
    const double cell16 = 16.0 / 6;
    const double cell600 = 25.0 / 4 * (2 + kRoot5) * 16;
    const auto pow4 = [](double x) { return x * x * x * x; };
    // Rectification cuts a pyramid off each vertex of a regular polytope of edge length 4, truncation off each vertex
    // of a polytope of edge length 6. Each pyramid has edges of length 2.
    EXPECT_NEAR(hypervolumeOf(built("rectified 5-cell")), (16 - 5) * cell5, 1e-9);
    EXPECT_NEAR(hypervolumeOf(built("truncated 5-cell")), (81 - 5) * cell5, 1e-9);
    EXPECT_NEAR(hypervolumeOf(built("truncated 16-cell")), (81 - 8 / 2.0) * cell16, 1e-9);
    // A vertex of a tesseract is cut off with a simplex that has four perpendicular edges of length √2.
    EXPECT_NEAR(hypervolumeOf(built("rectified tesseract")), pow4(2 * kRoot2) - 16 * 4 / 24.0, 1e-9);
    EXPECT_NEAR(hypervolumeOf(built("truncated tesseract")), pow4(2 + 2 * kRoot2) - 16 * 4 / 24.0, 1e-9);
    // A vertex of a 24-cell is cut off with a pyramid of height 1 over a cube.
    EXPECT_NEAR(hypervolumeOf(built("rectified 24-cell")), 16 * 32 - 24 * 8 / 4.0, 1e-9);
    // A vertex of a 600-cell of circumradius 2φ is cut off with a pyramid over an icosahedron of circumradius √(φ√5).
    const double phi = std::numbers::phi;
    const double icosahedron = 5.0 / 12 * (3 + kRoot5) * 8;
    const double height = 2 * phi - 2 * phi * phi / 2;
    EXPECT_NEAR(hypervolumeOf(built("snub 24-cell")), cell600 - 24 * icosahedron * height / 4, 1e-8);
    // Closed forms of the hypervolumes for edge length 1, from Klitzing.
    EXPECT_NEAR(hypervolumeOf(built("runcitruncated tesseract")) / 16, 8 * (27 + 20 * kRoot2) / 3, 1e-9);
    EXPECT_NEAR(hypervolumeOf(built("runcitruncated 24-cell")) / 16, 305 + 224 * kRoot2, 1e-8);
    EXPECT_NEAR(hypervolumeOf(built("runcitruncated 600-cell")) / 16, 25 * (1814 + 779 * kRoot5) / 4, 1e-5);
}

TEST(Hypervolume, ofProductsIsTheProduct) {
    const auto area = [](int n) { return n / std::tan(std::numbers::pi / n); };
    EXPECT_NEAR(hypervolumeOf(built("5,7-duoprism")), area(5) * area(7), 1e-9);
    EXPECT_NEAR(hypervolumeOf(built("3,24-duoprism")), area(3) * area(24), 1e-9);
    EXPECT_NEAR(hypervolumeOf(built("cuboctahedral prism")), 2 * 5 / 3.0 * kRoot2 * 8, 1e-9);
    EXPECT_NEAR(hypervolumeOf(built("truncated icosahedral prism")), 2 * (125 + 43 * kRoot5) / 4 * 8, 1e-9);
    // With edge length 1, the snub cube has the volume 7.889477399975…, and the square antiprism √(4 + 3√2) / 3.
    EXPECT_NEAR(hypervolumeOf(built("square antiprism prism")), 2 * std::sqrt(4 + 3 * kRoot2) / 3 * 8, 1e-9);
    EXPECT_NEAR(hypervolumeOf(built("snub cube prism")), 2 * 7.889477399975 * 8, 1e-9);
}

TEST(Hypervolume, isTheIntegralOfTheSlices) {
    std::mt19937 random(32);
    for (const char* name : {"grand antiprism", "snub 24-cell", "omnitruncated tesseract", "cantellated 24-cell",
                             "snub dodecahedral prism", "decagonal antiprism prism", "5,7-duoprism"}) {
        const Polytope& p = built(name);
        EXPECT_NEAR(hypervolumeBySlices(p, randomRotation(random)) / hypervolumeOf(p), 1, 1e-6) << name;
    }
}

// Diagrams of subgroups give the same polytopes as the diagrams of the catalogue, which have larger groups.
TEST(Diagrams, ofSubgroupsGenerateTheSamePolytopes) {
    const auto same = [](const char* symbol, std::string_view name) {
        const CoxeterDiagram diagram = std::get<CoxeterDiagram>(parseDiagram(symbol));
        const Polytope p = wythoffConstruction(symbol, diagram, mirrorsOf(diagram));
        const Polytope& known = built(name);
        EXPECT_EQ(countsOf(p), countsOf(known)) << symbol;
        EXPECT_EQ(countsOf(p), elementCounts(diagram)) << symbol;
        EXPECT_NEAR(p.circumradius, known.circumradius, 1e-12) << symbol;
        EXPECT_NEAR(hypervolumeOf(p), hypervolumeOf(known), 1e-9) << symbol;
        EXPECT_EQ(findEntry(symbol), findEntry(name)) << symbol;
    };
    same("x3o3o *b3o", "16-cell");
    same("o3x3o *b3o", "24-cell");
    same("x3x3o *b3o", "truncated 16-cell");
    same("x3o3x *b3o", "rectified tesseract");
    same("x3x3x *b3o", "bitruncated tesseract");
    same("x3o3x *b3x", "rectified 24-cell");
    same("x3x3x *b3x", "truncated 24-cell");
    same("o4o3x3o", "24-cell");
    same("x4o x4o", "8-cell");
    same("x x x x", "8-cell");
    same("x4o3o x", "8-cell");
    same("o3x3o x", "octahedral prism");
    same("x3x3x x", "truncated octahedral prism");
}

TEST(CellTypes, areTheOrbitsOfTheFullSymmetryGroup) {
    const auto typesOfCells = [](std::string_view name) {
        const Polytope& p = built(name);
        std::vector<std::pair<std::string, long>> types;
        for (std::size_t k = 0; k < p.cellTypes.size(); ++k)
            types.emplace_back(p.cellTypes[k].name, std::count(p.typeOfCell.begin(), p.typeOfCell.end(), k));
        return types;
    };
    using Expected = std::vector<std::pair<std::string, long>>;
    EXPECT_EQ(typesOfCells("24-cell"), (Expected{{"octahedron", 24}}));
    EXPECT_EQ(typesOfCells("truncated tesseract"), (Expected{{"truncated cube", 8}, {"tetrahedron", 16}}));
    EXPECT_EQ(typesOfCells("runcinated 5-cell"), (Expected{{"tetrahedron", 10}, {"triangular prism", 20}}));
    EXPECT_EQ(typesOfCells("runcinated tesseract"),
              (Expected{{"cube", 8}, {"tetrahedron", 16}, {"cube", 24}, {"triangular prism", 32}}));
    EXPECT_EQ(typesOfCells("bitruncated 24-cell"), (Expected{{"truncated cube", 48}}));
    EXPECT_EQ(typesOfCells("omnitruncated 120-cell"), (Expected{{"truncated icosidodecahedron", 120},
                                                                {"truncated octahedron", 600},
                                                                {"decagonal prism", 720},
                                                                {"hexagonal prism", 1200}}));
    EXPECT_EQ(typesOfCells("snub 24-cell"), (Expected{{"icosahedron", 24}, {"tetrahedron", 24}, {"tetrahedron", 96}}));
    EXPECT_EQ(typesOfCells("grand antiprism"),
              (Expected{{"pentagonal antiprism", 20}, {"tetrahedron", 100}, {"tetrahedron", 200}}));
    EXPECT_EQ(typesOfCells("snub cube prism"),
              (Expected{{"snub cube", 2}, {"cube", 6}, {"triangular prism", 8}, {"triangular prism", 24}}));
    EXPECT_EQ(typesOfCells("5,5-duoprism"), (Expected{{"pentagonal prism", 10}}));
    EXPECT_EQ(typesOfCells("5,7-duoprism"), (Expected{{"heptagonal prism", 5}, {"pentagonal prism", 7}}));
}

}  // namespace
