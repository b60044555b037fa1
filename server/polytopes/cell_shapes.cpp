#include "polytopes/cell_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <vector>

#include <glm/geometric.hpp>

#include "polytopes/construction/polyhedra.hpp"
#include "polytopes/construction/solids.hpp"

namespace oval4d::polytopes {

namespace {

constexpr double kShapeTolerance = 0.01;  // the relative tolerance in comparisons of two lengths

bool areEqual(double a, double b) { return std::abs(a - b) <= kShapeTolerance * std::max(a, b); }

bool areAllEqual(const std::vector<double>& lengths) {
    const auto [least, greatest] = std::ranges::minmax(lengths);
    return areEqual(least, greatest);
}

// Counts of the 2-faces and the vertices of one cell.
struct CellFaceAndDegreeCounts {
    std::map<std::size_t, std::uint32_t> faces;      // number of sides → number of 2-faces with this number of sides
    std::map<std::uint32_t, std::uint32_t> degrees;  // vertex → number of edges of the cell at this vertex
    // number of edges → number of vertices with this number of edges
    std::map<std::uint32_t, std::uint32_t> verticesOfDegree;

    CellFaceAndDegreeCounts(const Polytope& p, std::uint32_t cell) {
        for (const std::uint32_t f : p.cells[cell]) {
            ++faces[p.faces[f].size()];
            for (const std::uint32_t v : p.faces[f]) ++degrees[v];
        }
        for (const auto& [vertex, degree] : degrees) ++verticesOfDegree[degree];
    }
    std::uint32_t countFacesWithSides(std::size_t sides) const {
        const auto found = faces.find(sides);
        return found == faces.end() ? 0 : found->second;
    }
    // Returns whether the cell has exactly n vertices with `degree` edges, m vertices with `otherDegree` edges, and no
    // other vertices.
    bool hasVertexDegrees(std::uint32_t n, std::uint32_t degree, std::uint32_t m, std::uint32_t otherDegree) const {
        std::map<std::uint32_t, std::uint32_t> wanted;
        wanted[degree] += n;
        wanted[otherDegree] += m;
        return verticesOfDegree == wanted;
    }
};

// The lengths of the sides and diagonals of a quadrilateral.
struct QuadrilateralLengths {
    double sides[4], diagonals[2];

    QuadrilateralLengths(const Polytope& p, std::span<const std::uint32_t> loop) {
        const auto distance = [&](std::size_t i, std::size_t j) {
            return glm::distance(p.vertices[loop[i % 4]], p.vertices[loop[j % 4]]);
        };
        for (std::size_t i = 0; i < 4; ++i) sides[i] = distance(i, i + 1);
        for (std::size_t i = 0; i < 2; ++i) diagonals[i] = distance(i, i + 2);
    }
    bool isRhombus() const {
        return areEqual(sides[0], sides[1]) && areEqual(sides[1], sides[2]) && areEqual(sides[2], sides[3]);
    }
    bool isRectangle() const {
        return areEqual(sides[0], sides[2]) && areEqual(sides[1], sides[3]) && areEqual(diagonals[0], diagonals[1]);
    }
};

std::string adjectiveOfBase(const Polytope& p, std::span<const std::uint32_t> loop) {
    if (loop.size() != 4) return adjectiveOf({static_cast<int>(loop.size()), 1});
    const QuadrilateralLengths base(p, loop);
    if (base.isRhombus()) return base.isRectangle() ? "square" : "rhombic";
    return base.isRectangle() ? "rectangular" : "quadrilateral";
}

std::string pyramidName(const Polytope& p, std::uint32_t cell, const CellFaceAndDegreeCounts& tally) {
    const std::size_t n = p.cells[cell].size() - 1;
    if (n < 4 || tally.degrees.size() != n + 1 || tally.countFacesWithSides(3) != n ||
        tally.countFacesWithSides(n) != 1)
        return {};
    for (const std::uint32_t f : p.cells[cell]) {
        if (p.faces[f].size() == n) return adjectiveOfBase(p, p.faces[f]) + " pyramid";
    }
    return {};
}

// Returns the name of the cell if it is a cuboid or a right prism, else an empty string.
std::string prismName(const Polytope& p, std::uint32_t cell) {
    const std::size_t n = p.cells[cell].size() - 2;
    std::size_t rectangles = 0;
    std::vector<std::uint32_t> others;
    for (const std::uint32_t f : p.cells[cell]) {
        const bool rectangle = p.faces[f].size() == 4 && QuadrilateralLengths(p, p.faces[f]).isRectangle();
        if (rectangle)
            ++rectangles;
        else
            others.push_back(f);
    }
    if (n == 4 && others.empty()) return "cuboid";
    if (rectangles != n || others.size() != 2) return {};
    for (const std::uint32_t f : others) {
        if (p.faces[f].size() != n) return {};
    }
    return adjectiveOfBase(p, p.faces[others[0]]) + " prism";
}

// Returns the distances of the cell's vertices from their mean.
std::vector<double> radiiOf(const Polytope& p, const CellFaceAndDegreeCounts& tally) {
    glm::dvec4 middle(0);
    for (const auto& [v, degree] : tally.degrees) middle += p.vertices[v] / static_cast<double>(tally.degrees.size());
    std::vector<double> radii;
    for (const auto& [v, degree] : tally.degrees) radii.push_back(glm::distance(p.vertices[v], middle));
    return radii;
}

// Returns whether two 2-faces of a cell may be the bases of an antiprism. The 2-faces must have no vertex in common.
// All edges of both 2-faces must be equally long, and so must all other edges of the cell.
bool mayBeAntiprismBases(const Polytope& p, std::uint32_t cell, std::uint32_t base, std::uint32_t otherBase) {
    const std::set<std::uint32_t> corners(p.faces[base].begin(), p.faces[base].end());
    const auto isCorner = [&](std::uint32_t v) { return corners.contains(v); };
    if (std::ranges::any_of(p.faces[otherBase], isCorner)) return false;
    std::vector<double> sides, lateral;
    for (const std::uint32_t f : p.cells[cell]) {
        const auto loop = p.faces[f];
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
            (isCorner(a) == isCorner(b) ? sides : lateral).push_back(glm::distance(p.vertices[a], p.vertices[b]));
        }
    }
    return areAllEqual(sides) && areAllEqual(lateral);
}

// Returns the name of the cell if it is a right antiprism over a regular polygon, else an empty string.
std::string antiprismName(const Polytope& p, std::uint32_t cell, const CellFaceAndDegreeCounts& tally) {
    const auto n = static_cast<std::uint32_t>(p.cells[cell].size() / 2 - 1);
    std::map<std::size_t, std::uint32_t> wanted;
    wanted[n] += 2;
    wanted[3] += 2 * n;
    if (n < 3 || tally.faces != wanted || !tally.hasVertexDegrees(n, 4, n, 4)) return {};
    // The vertices of a right antiprism lie on a sphere. Therefore the vertices of a base lie on a circle, and a base
    // with equally long edges is regular.
    if (!areAllEqual(radiiOf(p, tally))) return {};
    std::vector<std::uint32_t> bases;  // the two n-gons or, if n = 3, all eight triangles
    for (const std::uint32_t f : p.cells[cell]) {
        if (p.faces[f].size() == n) bases.push_back(f);
    }
    for (const std::uint32_t base : bases) {
        for (const std::uint32_t other : bases) {
            if (base < other && mayBeAntiprismBases(p, cell, base, other))
                return adjectiveOf({static_cast<int>(n), 1}) + " antiprism";
        }
    }
    return {};
}

// Returns the name of a cell if it is a bipyramid or a trapezohedron, else an empty string. `faces` is the number of
// 2-faces of the cell. Only this number and `tally` decide, not the positions of the vertices. Bipyramids and
// trapezohedra have two apexes; their other vertices lie around the axis through the apexes.
std::string twoApexName(std::uint32_t faces, const CellFaceAndDegreeCounts& tally) {
    const std::uint32_t n = faces / 2;
    const auto vertices = static_cast<std::uint32_t>(tally.degrees.size());
    const std::string adjective = adjectiveOf({static_cast<int>(n), 1});
    // An irregular octahedron (n = 4) is not called a bipyramid, nor a deformed cube (n = 3) a trapezohedron,
    // because any two opposite vertices could be the apexes.
    if (n != 4 && vertices == n + 2 && tally.countFacesWithSides(3) == 2 * n && tally.hasVertexDegrees(2, n, n, 4))
        return adjective + " bipyramid";
    if (n > 3 && vertices == 2 * n + 2 && tally.countFacesWithSides(4) == 2 * n &&
        tally.hasVertexDegrees(2, n, 2 * n, 3))
        return adjective + " trapezohedron";
    return {};
}

// Returns whether the cell has the shape of the solid: whether the distances of the cell's vertices from their mean
// have the same ratios as the distances of the solid's vertices from its center. The caller must have compared the
// numbers of faces and vertices; these numbers alone do not identify a solid.
bool hasRadiiOf(const SolidDescription& solid, const Polytope& p, const CellFaceAndDegreeCounts& tally) {
    const SolidMesh mesh = meshOf(solid);
    std::vector<double> known, own = radiiOf(p, tally);
    for (const glm::dvec3& v : mesh.vertices) known.push_back(glm::length(v));
    std::ranges::sort(known);
    std::ranges::sort(own);
    const double scale = own.back() / known.back();
    return std::ranges::equal(known, own, [&](double a, double b) { return areEqual(scale * a, b); });
}

bool isPlatonic(const NamedPolyhedron& polyhedron) {
    const std::string_view diagram = polyhedron.linearNotation;
    return std::ranges::count(diagram, 'x') == 1 && (diagram.starts_with('x') || diagram.ends_with('x'));
}

struct CatalanSolid {
    SolidDescription solid;
    SolidCounts counts;
};

const std::vector<CatalanSolid>& catalanSolids() {
    static const std::vector<CatalanSolid> kSolids = [] {
        std::vector<CatalanSolid> solids;
        for (const NamedPolyhedron& base : namedPolyhedra()) {
            const SolidDescription solid{&base, 0, false, true};
            if (isConvex(base) && !isPlatonic(base)) solids.push_back({solid, countsOf(solid)});
        }
        return solids;
    }();
    return kSolids;
}

std::string catalanName(const Polytope& p, const CellFaceAndDegreeCounts& tally, std::uint32_t faces) {
    if (tally.faces.size() != 1) return {};
    for (const auto& [solid, counts] : catalanSolids()) {
        if (counts.faces == faces && counts.vertices == tally.degrees.size() && hasRadiiOf(solid, p, tally))
            return nameOf(solid);
    }
    return {};
}

}  // namespace

std::string nameOfIrregularCell(const Polytope& p, std::uint32_t cell) {
    const auto faces = static_cast<std::uint32_t>(p.cells[cell].size());
    if (!p.convexFaces || faces < 5) return {};
    const CellFaceAndDegreeCounts tally(p, cell);
    std::string name = pyramidName(p, cell, tally);
    if (name.empty()) name = prismName(p, cell);
    if (name.empty()) name = antiprismName(p, cell, tally);
    if (name.empty()) name = catalanName(p, tally, faces);
    return name.empty() ? twoApexName(faces, tally) : name;
}

}  // namespace oval4d::polytopes
