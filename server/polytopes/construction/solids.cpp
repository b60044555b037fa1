#include "polytopes/construction/solids.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <string_view>
#include <utility>

#include <glm/geometric.hpp>

#include "polytopes/construction/coxeter.hpp"
#include "polytopes/construction/design.hpp"
#include "polytopes/construction/snub.hpp"
#include "text/words.hpp"

namespace oval4d::polytopes {

namespace {

// The name of each Platonic and Archimedean solid, and the name of its dual, a Platonic or Catalan solid.
constexpr auto kDuals = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"tetrahedron", "tetrahedron"},
    {"cube", "octahedron"},
    {"octahedron", "cube"},
    {"dodecahedron", "icosahedron"},
    {"icosahedron", "dodecahedron"},
    {"truncated tetrahedron", "triakis tetrahedron"},
    {"cuboctahedron", "rhombic dodecahedron"},
    {"truncated cube", "triakis octahedron"},
    {"truncated octahedron", "tetrakis hexahedron"},
    {"rhombicuboctahedron", "deltoidal icositetrahedron"},
    {"truncated cuboctahedron", "disdyakis dodecahedron"},
    {"snub cube", "pentagonal icositetrahedron"},
    {"icosidodecahedron", "rhombic triacontahedron"},
    {"truncated dodecahedron", "triakis icosahedron"},
    {"truncated icosahedron", "pentakis dodecahedron"},
    {"rhombicosidodecahedron", "deltoidal hexecontahedron"},
    {"truncated icosidodecahedron", "disdyakis triacontahedron"},
    {"snub dodecahedron", "pentagonal hexecontahedron"},
});

std::string_view dualName(std::string_view name) {
    return std::ranges::find(kDuals, name, &std::pair<std::string_view, std::string_view>::first)->second;
}

const NamedPolyhedron* polyhedronCalled(std::string_view name) {
    const auto found = std::ranges::find(namedPolyhedra(), name, &NamedPolyhedron::name);
    return found == namedPolyhedra().end() ? nullptr : &*found;
}

// Returns one canonical value for all descriptions of the same solid. For example, the square prism is the cube, the
// triangular antiprism is the octahedron, and the dual of a Platonic solid is a Platonic solid.
SolidDescription canonical(SolidDescription solid) {
    if (solid.named == nullptr && !solid.antiprism && solid.sides == 4)
        solid = {polyhedronCalled("cube"), 0, false, solid.dual};
    if (solid.named == nullptr && solid.antiprism && solid.sides == 3)
        solid = {polyhedronCalled("octahedron"), 0, false, solid.dual};
    if (solid.named == nullptr || !solid.dual) return solid;
    const NamedPolyhedron* const other = polyhedronCalled(dualName(solid.named->name));
    return other == nullptr ? solid : SolidDescription{other};
}

// A family of solids over polygons: the last word of their names, and the values of SolidDescription::antiprism and
// SolidDescription::dual.
struct SolidFamily {
    std::string_view word;
    bool antiprism, dual;
};
constexpr auto kPolygonFamilies = std::to_array<SolidFamily>({
    {"prism", false, false},
    {"antiprism", true, false},
    {"bipyramid", false, true},
    {"trapezohedron", true, true},
});

SolidMesh prismMesh(int sides) {
    SolidMesh prism;
    const double angle = 2 * std::numbers::pi / sides;
    const double circle = 1 / std::sin(angle / 2);
    for (const double z : {-1.0, 1.0}) {
        for (int i = 0; i < sides; ++i)
            prism.vertices.emplace_back(circle * std::cos(i * angle), circle * std::sin(i * angle), z);
    }
    const auto n = static_cast<std::uint32_t>(sides);
    std::vector<std::uint32_t> loop(n);
    for (const std::uint32_t first : {0U, n}) {
        std::iota(loop.begin(), loop.end(), first);
        prism.faces.add(loop);
    }
    for (std::uint32_t i = 0; i < n; ++i) prism.faces.add(std::array{i, (i + 1) % n, (i + 1) % n + n, i + n});
    return prism;
}

// Returns the mesh of a polyhedron that is not a snub: one base of the prism over it.
SolidMesh polyhedronMeshOf(const NamedPolyhedron& polyhedron) {
    const CoxeterDiagram diagram =
        std::get<CoxeterDiagram>(parseDiagram(std::string(polyhedron.linearNotation) + " x"));
    const Polytope prism = wythoffConstruction({}, diagram, mirrorsOf(diagram));
    SolidMesh base;
    std::vector<std::uint32_t> number(prism.vertices.size());
    for (std::size_t v = 0; v < prism.vertices.size(); ++v) {
        if (prism.vertices[v].w < 0) continue;
        number[v] = static_cast<std::uint32_t>(base.vertices.size());
        base.vertices.emplace_back(prism.vertices[v]);
    }
    for (std::size_t f = 0; f < prism.faces.size(); ++f) {
        std::vector<std::uint32_t> loop;
        for (const std::uint32_t v : prism.faces[f]) {
            if (prism.vertices[v].w > 0) loop.push_back(number[v]);
        }
        if (loop.size() == prism.faces[f].size()) base.faces.add(loop);
    }
    return base;
}

// Returns the dual of a convex polyhedron, with the same circumradius. The pole of the plane n · x = 1 is the point n.
// The vertices of the dual are the poles of the planes of the base's faces, all multiplied by one factor. Each face of
// the dual is the loop of the base's faces around a vertex.
SolidMesh dualOf(const SolidMesh& base) {
    SolidMesh dual;
    double circumradius = 0, farthest = 0;
    for (const glm::dvec3& v : base.vertices) circumradius = std::max(circumradius, glm::length(v));
    // Make all loops counterclockwise, seen from outside. Each directed edge then occurs in exactly one loop. `corners`
    // maps each directed edge to the face of this loop, and to the vertex before the edge in the loop.
    struct FaceCorner {
        std::uint32_t face, before;
    };
    std::map<std::array<std::uint32_t, 2>, FaceCorner> corners;
    for (std::uint32_t f = 0; f < base.faces.size(); ++f) {
        std::vector<std::uint32_t> loop(base.faces[f].begin(), base.faces[f].end());
        const auto at = [&](std::size_t i) { return base.vertices[loop[i % loop.size()]]; };
        glm::dvec3 normal = glm::normalize(glm::cross(at(1) - at(0), at(2) - at(1)));
        if (glm::dot(normal, at(0)) < 0) {
            std::ranges::reverse(loop);
            normal = -normal;
        }
        dual.vertices.push_back(normal / glm::dot(normal, at(0)));
        farthest = std::max(farthest, glm::length(dual.vertices.back()));
        const std::size_t n = loop.size();
        for (std::size_t i = 0; i < n; ++i) corners[{loop[i], loop[(i + 1) % n]}] = {f, loop[(i + n - 1) % n]};
    }
    for (glm::dvec3& v : dual.vertices) v *= circumradius / farthest;
    std::vector<std::uint32_t> loop;
    for (auto start = corners.begin(); start != corners.end();) {
        const std::uint32_t v = start->first[0];
        loop.clear();
        for (std::uint32_t next = start->first[1]; loop.empty() || next != start->first[1];) {
            const FaceCorner& corner = corners.at({v, next});
            loop.push_back(corner.face);
            next = corner.before;
        }
        dual.faces.add(loop);
        while (start != corners.end() && start->first[0] == v) ++start;
    }
    return dual;
}

}  // namespace

std::optional<std::variant<SolidDescription, PolytopeNameError>> solidNamed(const std::vector<std::string>& words) {
    using SolidOrError = std::variant<SolidDescription, PolytopeNameError>;
    std::size_t first = 0;
    bool dual = false;
    while (first + 1 < words.size() && words[first] == "dual") {
        dual = !dual;
        first += words[first + 1] == "of" ? 2 : 1;
    }
    if (first >= words.size()) return {};
    const std::string name = text::joined(words, first, words.size());
    const auto solid = [&](const NamedPolyhedron* named, bool dualOfNamed) {
        return SolidOrError(canonical({named, 0, false, dual != dualOfNamed}));
    };
    if (const NamedPolyhedron* const named = polyhedronCalled(name)) {
        if (!isConvex(*named))
            return PolytopeNameError::impossible("the " + name + " is a star; the polyhedron must be convex");
        return solid(named, false);
    }
    for (const auto& [base, own] : kDuals) {
        if (own == name) return solid(polyhedronCalled(base), true);
    }
    if (words.size() - first < 2) return {};
    for (const auto& [word, antiprism, isDual] : kPolygonFamilies) {
        if (words.back() != word) continue;
        const auto polygon = polygonNamed(text::joined(words, first, words.size() - 1));
        if (!polygon) return {};
        if (polygon->numerator < 3 || polygon->denominator != 1) {
            return PolytopeNameError::impossible("the polygon of " + std::string(word == "antiprism" ? "an " : "a ") +
                                                 std::string(word) + " must have at least three sides and be no star");
        }
        return canonical({nullptr, polygon->numerator, antiprism, dual != isDual});
    }
    return {};
}

std::string nameOf(const SolidDescription& solid) {
    if (solid.named != nullptr) return std::string(solid.dual ? dualName(solid.named->name) : solid.named->name);
    const auto family = std::ranges::find_if(kPolygonFamilies, [&](const SolidFamily& each) {
        return each.antiprism == solid.antiprism && each.dual == solid.dual;
    });
    return adjectiveOf({solid.sides, 1}) + " " + std::string(family->word);
}

SolidCounts countsOf(const SolidDescription& solid) {
    // The prism over a polyhedron with v vertices, e edges and f faces has 2v vertices, 2e + v edges and f + 2 cells.
    const ElementCounts prism = uniformPrismOver({solid.named, solid.sides, solid.antiprism}).recipe->countElements();
    const std::uint64_t vertices = prism.vertices / 2;
    const SolidCounts own{vertices, (prism.edges - vertices) / 2, prism.cells - 2};
    return solid.dual ? SolidCounts{own.faces, own.edges, own.vertices} : own;
}

SolidMesh meshOf(const SolidDescription& solid) {
    if (solid.dual) return dualOf(meshOf({solid.named, solid.sides, solid.antiprism}));
    if (solid.named == nullptr && !solid.antiprism) return prismMesh(solid.sides);
    if (solid.named != nullptr && !solid.named->linearNotation.starts_with('s')) return polyhedronMeshOf(*solid.named);
    const auto digit = [&](std::size_t i) { return DiagramBranch{solid.named->linearNotation[i] - '0', 1}; };
    PolyhedronWithFaceOrbits snub = solid.antiprism ? snubOf({solid.sides, 1}, {2, 1}) : snubOf(digit(1), digit(3));
    return {std::move(snub.vertices), std::move(snub.faces)};
}

PolytopeDesign uniformPrismOver(const SolidDescription& solid) {
    if (solid.named != nullptr) return prismDesignOver(*solid.named);
    return solid.antiprism ? antiprismPrismDesign(solid.sides) : duoprismDesign({solid.sides, 1}, {4, 1});
}

}  // namespace oval4d::polytopes
