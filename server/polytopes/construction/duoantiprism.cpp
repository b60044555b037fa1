#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "geometry/jagged_array.hpp"
#include "polytopes/construction/design.hpp"
#include "polytopes/construction/diagram_text.hpp"
#include "polytopes/construction/notations.hpp"
#include "polytopes/construction/polyhedra.hpp"
#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

namespace {

// Returns point `index` of 2n points at equal distances on a circle around the origin. Every other point is a vertex of
// a regular n-gon of edge length 2 (for n = 2, an end of a segment of length 2).
//
// In the projections onto the xy plane and the zw plane, the vertices of a duoantiprism lie on two such circles, with
// n = p and n = q. With the radii of these circles, the ratio of the longest edge to the shortest edge is least. Proof:
// for any radii, let a and b be the edge lengths of the p-gons and of the q-gons, and c the length of the other edges.
// An edge of length c joins neighboring points in its projection onto the plane of each circle. These points are a / (2
// cos(π/(2p))) apart on the first circle, and b / (2 cos(π/(2q))) on the second.
//
// The sum of the squares is c² = a² / (4 cos²(π/(2p))) + b² / (4 cos²(π/(2q))). The coefficients of a² and b² are at
// most 1/2, and both are 1/2 only for p = q = 2. Hence all lengths can be equal only for p = q = 2. For other p and q,
// c is less than the larger of a and b, and max(a, b) / min(a, b, c) is least for a = b.
glm::dvec2 pointOnCircle(std::uint32_t n, std::uint32_t index) {
    const double angle = std::numbers::pi / n;
    return glm::dvec2(std::cos(angle * index), std::sin(angle * index)) / std::sin(angle);
}

/// A recipe for a duoantiprism other than the 16-cell. A vertex of the duoprism of a 2p-gon and a 2q-gon is a pair (i,
/// j). Here, i is one of 2p points on a circle in the xy plane, and j is one of 2q points on a circle in the zw plane.
/// The vertices of the duoantiprism are those with an even sum i + j.
class DuoantiprismRecipe : public Recipe {
  public:
    /// Makes a recipe for a p-gon and a q-gon. p must be at least 2, and q at least 3 and not less than p.
    DuoantiprismRecipe(int p, int q) : p_(static_cast<std::uint32_t>(p)), q_(static_cast<std::uint32_t>(q)) {}

    ElementCounts countElements() const override {
        const std::uint64_t p = p_, q = q_, pairs = p * q;
        const bool digons = p == 2;  // a digon is not a 2-face, and its two sides are the same edge
        return {2 * pairs, (digons ? 7 : 8) * pairs, 8 * pairs + 2 * p + (digons ? 0 : 2 * q), 2 * (pairs + p + q)};
    }
    // The dihedral groups of order 4p and 4q act on the two circles. There are 16pq pairs of an element of one group
    // and an element of the other. Half of these pairs map the vertices of the duoantiprism to each other. If p = q,
    // there are twice as many symmetries, because the two planes can be exchanged.
    std::uint64_t symmetryOrder() const override { return (p_ == q_ ? 8 : 4) * countElements().vertices; }
    std::string linearNotation() const override { return "s" + std::to_string(p_) + "s2s" + std::to_string(q_) + "s"; }
    std::string schlaefli() const override {
        return "ht0,1,2,3{" + std::to_string(p_) + ",2," + std::to_string(q_) + "}";
    }

    Polytope build(const std::string& name) const override {
        const std::uint32_t m = 2 * p_, n = 2 * q_;  // the numbers of points on the two circles
        std::vector<glm::dvec4> vertices;
        for (std::uint32_t i = 0; i < m; ++i) {
            for (std::uint32_t j = i % 2; j < n; j += 2)
                vertices.emplace_back(pointOnCircle(p_, i), pointOnCircle(q_, j));
        }
        const auto vertex = [&](std::uint32_t i, std::uint32_t j) { return (i % m) * q_ + (j % n) / 2; };

        geometry::JaggedArray faces;
        const auto nextFace = [&] { return static_cast<std::uint32_t>(faces.size()); };
        // The 2-faces of the antiprisms, as indices in `faces`. betweenQ[i] belongs to the antiprism between the q-gons
        // at the points i and i + 1 of the first circle. betweenP[j] belongs to the antiprism between the p-gons at the
        // points j and j + 1 of the second circle.
        std::vector<std::vector<std::uint32_t>> betweenQ(m), betweenP(n);
        std::vector<std::uint32_t> loop;
        for (std::uint32_t i = 0; i < m; ++i) {
            loop.clear();
            for (std::uint32_t j = i % 2; j < n; j += 2) loop.push_back(vertex(i, j));
            betweenQ[(i + m - 1) % m].push_back(nextFace());
            betweenQ[i].push_back(nextFace());
            faces.add(loop);
        }
        for (std::uint32_t j = 0; j < n && p_ > 2; ++j) {
            loop.clear();
            for (std::uint32_t i = j % 2; i < m; i += 2) loop.push_back(vertex(i, j));
            betweenP[(j + n - 1) % n].push_back(nextFace());
            betweenP[j].push_back(nextFace());
            faces.add(loop);
        }

        // All other 2-faces are triangles. Each triangle separates an antiprism from a disphenoid, a tetrahedron whose
        // opposite edges are equally long. The four corners of a disphenoid are the neighbors of a vertex (i, j) of the
        // duoprism that is not a vertex of the duoantiprism.
        geometry::JaggedArray cells;
        std::vector<std::uint32_t> orbits;  // the orbit of each cell under the symmetry group
        for (std::uint32_t i = 0; i < m; ++i) {
            for (std::uint32_t j = 1 - i % 2; j < n; j += 2) {
                const std::uint32_t beforeI = vertex(i + m - 1, j), afterI = vertex(i + 1, j);
                const std::uint32_t beforeJ = vertex(i, j + n - 1), afterJ = vertex(i, j + 1);
                const std::uint32_t first = nextFace();
                faces.add(std::array{beforeJ, afterJ, beforeI});
                faces.add(std::array{beforeJ, afterJ, afterI});
                faces.add(std::array{beforeI, afterI, beforeJ});
                faces.add(std::array{beforeI, afterI, afterJ});
                betweenQ[(i + m - 1) % m].push_back(first);
                betweenQ[i].push_back(first + 1);
                betweenP[(j + n - 1) % n].push_back(first + 2);
                betweenP[j].push_back(first + 3);
                cells.add(std::array{first, first + 1, first + 2, first + 3});
                orbits.push_back(0);
            }
        }
        for (const auto& antiprism : betweenQ) {
            cells.add(antiprism);
            orbits.push_back(1);
        }
        for (const auto& antiprism : betweenP) {
            cells.add(antiprism);
            orbits.push_back(p_ == q_ ? 1 : 2);
        }
        return makePolytope(name, std::move(vertices), std::move(faces), std::move(cells), std::move(orbits));
    }

  private:
    std::uint32_t p_, q_;
};

// Parses the name of a duoantiprism of two regular polygons: "3,4-duoantiprism", "3-4 duoantiprism", "triangular-square
// duoantiprism", "pentagonal duoantiprism" (of two pentagons). Returns an error if the text ends with "duoantiprism"
// but the words before it do not name two polygons, or name a star. Returns an empty optional for other texts. The
// canonical name has the smaller number of sides first, as in "3,4-duoantiprism".
//
// The duoantiprism of a p-gon and a q-gon is the convex hull of every other vertex of the duoprism of a 2p-gon and a
// 2q-gon. Its cells are 2p q-gonal antiprisms, 2q p-gonal antiprisms and, in place of the removed vertices, 2pq
// disphenoids. A polygon may have two sides: this digon is a single edge, and an antiprism over it is a disphenoid.
// The design for p = q = 2 is that of the 16-cell.
//
// The sides of all p-gons and q-gons have length 2, because the ratio of the longest edge to the shortest edge is least
// if these sides are equal. The edges that join the polygons are all equally long; their length is between √2 and 2, or
// 2 for p = q = 2.
std::optional<PolytopeDesignOrError> duoantiprismNamed(const PolytopeNameWords& text) {
    if (text.words.back() != "duoantiprism") return {};
    const auto polygons = duoprismPolygonsNamed(text.withoutLast());
    const auto isStar = [](RegularPolygon each) { return each.denominator != 1; };
    if (!polygons || polygons->size() != 2 || std::ranges::any_of(*polygons, isStar)) {
        return PolytopeNameError::impossible(
            "a duoantiprism is named after two polygons that have at least two sides and are no stars, as in "
            "3,4-duoantiprism");
    }
    const auto [p, q] = std::minmax((*polygons)[0].numerator, (*polygons)[1].numerator);
    if (q == 2) return designOf(std::get<CoxeterDiagram>(parseDiagram("x3o3o4o")));
    return PolytopeDesign{std::to_string(p) + "," + std::to_string(q) + "-duoantiprism",
                          std::make_shared<DuoantiprismRecipe>(p, q)};
}

}  // namespace

constinit const PolytopeNotation kDuoantiprismNotation{
    .polytopes =
        "a duoantiprism: the convex hull of every other vertex of the duoprism of two polygons with twice as "
        "many sides. The polygons have at least two sides and are no stars; a single polygon stands for two",
    .examples =
        "`3,4-duoantiprism`, `3-4 duoantiprism`, `triangular-square duoantiprism`, `pentagonal "
        "duoantiprism`, `2,5-duoantiprism`",
    .edges =
        "2 for the sides of the polygons; the other edges are equally long, and shorter unless the polytope "
        "is the 16-cell",
    .parse = duoantiprismNamed,
};

}  // namespace oval4d::polytopes
