#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/jagged_array.hpp"
#include "polytopes/construction/convex_hull.hpp"
#include "polytopes/construction/design.hpp"
#include "polytopes/construction/diagram_text.hpp"
#include "polytopes/construction/notations.hpp"
#include "polytopes/polytope.hpp"
#include "text/words.hpp"

namespace oval4d::polytopes {

namespace {

// Returns the number of cells of the cyclic polytope with n vertices.
constexpr std::uint64_t cyclicPolytopeCellCount(std::uint64_t n) { return n * (n - 3) / 2; }

// The allowed numbers of vertices. With one vertex more than 448, the polytope would have more than kMaxHullCells
// cells.
constexpr int kLeastCyclicVertices = 5, kMostCyclicVertices = 448;
static_assert(cyclicPolytopeCellCount(kMostCyclicVertices) <= kMaxHullCells &&
              cyclicPolytopeCellCount(kMostCyclicVertices + 1) > kMaxHullCells);

/// A recipe for a cyclic polytope other than the 5-cell (Ziegler, Lectures on Polytopes, section 0). The polytope is
/// the convex hull of n points at equal distances on the trigonometric moment curve t ↦ (cos t, sin t, cos 2t, sin 2t).
/// Vertex k has t = 2πk/n; the indices of vertices are taken modulo n.
///
/// By Gale's evenness condition, the cells are the tetrahedra whose corners are two disjoint pairs of neighbors, {i,
/// i + 1} and {j, j + 1}. Proof: let a and b be the values of t halfway between the two vertices of each pair. The
/// function (cos(π/n) − cos(t − a)) (cos(π/n) − cos(t − b)) is 0 at these four vertices and positive at all others,
/// because no vertex lies between neighbors. The function is a trigonometric polynomial of degree 2, that is, an affine
/// function on the curve. So a hyperplane supports the polytope in the four vertices.
class CyclicPolytopeRecipe : public Recipe {
  public:
    /// Makes a recipe for n vertices. n must be at least 6.
    explicit CyclicPolytopeRecipe(std::uint32_t n) : n_(n) {}

    ElementCounts countElements() const override {
        const std::uint64_t n = n_;
        return {n, n * (n - 1) / 2, n * (n - 3), cyclicPolytopeCellCount(n)};
    }
    // The symmetries t → t + 2π/n and t → −t of the points on the curve generate a dihedral group of order 2n. If n is
    // 6, there are more symmetries: the vertices with even numbers and those with odd numbers are equal triangles in
    // perpendicular planes. The symmetries of each triangle, and the exchange of the two triangles, are symmetries of
    // the polytope.
    std::uint64_t symmetryOrder() const override { return hasPerpendicularTriangles() ? 2U * 6 * 6 : 2 * n_; }

    Polytope build(const std::string& name) const override {
        const std::uint32_t n = n_;
        const double step = 2 * std::numbers::pi / n;
        // With this radius r, the edges between neighbors have the length 2, and no edge is shorter. Proof: the edge
        // between vertices that are k steps apart has the length 2r √R, where R = s + 4s(1 − s) and s = sin²(kπ/n). R
        // is a concave function of s. Therefore, for s from its value for neighbors (k = 1) to 1, R is least at one of
        // these two ends. R is at most 1 for neighbors, and 1 for s = 1, so neighbors have the shortest edges.
        const double radius = 1 / std::hypot(std::sin(step / 2), std::sin(step));
        std::vector<glm::dvec4> vertices;
        for (std::uint32_t k = 0; k < n; ++k) {
            const double t = step * k;
            vertices.push_back(radius * glm::dvec4(std::cos(t), std::sin(t), std::cos(2 * t), std::sin(2 * t)));
        }

        // Each 2-face contains a pair of neighbors. The 2-face {i, i + 1, i + 2 + k}, with 0 ≤ k < n − 3, has the index
        // i (n − 3) + k.
        geometry::JaggedArray faces;
        for (std::uint32_t i = 0; i < n; ++i) {
            for (std::uint32_t k = 0; k < n - 3; ++k) faces.add(std::array{i, (i + 1) % n, (i + 2 + k) % n});
        }
        // Returns the index of the 2-face {i, i + 1, j}. If j = i − 1 modulo n, this is the 2-face {j, j + 1, j + 2} of
        // the list.
        const auto face = [n](std::uint32_t i, std::uint32_t j) {
            const std::uint32_t steps = (j + n - i) % n;
            return steps == n - 1 ? (i + n - 1) % n * (n - 3) : i * (n - 3) + steps - 2;
        };

        geometry::JaggedArray cells;
        std::vector<std::uint32_t> orbits;  // the orbit of each cell under the symmetry group
        for (std::uint32_t i = 0; i < n; ++i) {
            for (std::uint32_t j = i + 2; j < n; ++j) {
                const std::uint32_t steps = j - i;
                if (steps == n - 1) continue;  // the pairs {i, i + 1} and {j, j + 1} have vertex i in common
                cells.add(std::array{face(i, j), face(i, j + 1), face(j, i), face(j, i + 1)});
                orbits.push_back(hasPerpendicularTriangles() ? 0U : std::min(steps, n - steps));
            }
        }
        return makePolytope(name, std::move(vertices), std::move(faces), std::move(cells), std::move(orbits));
    }

  private:
    bool hasPerpendicularTriangles() const { return n_ == 6; }

    std::uint32_t n_;
};

// Returns n for the symbol "c(n,4)". Returns an empty optional for other texts.
std::optional<DiagramBranch> vertexCountInSymbol(std::string_view symbol) {
    constexpr std::string_view kBegin = "c(", kEnd = ")";
    if (!symbol.starts_with(kBegin) || !symbol.ends_with(kEnd)) return {};
    symbol.remove_prefix(kBegin.size());
    symbol.remove_suffix(kEnd.size());
    const std::vector<std::string_view> numbers = text::splitAtCommas(symbol);
    if (numbers.size() != 2 || text::trimmed(numbers[1]) != "4") return {};
    return parseBranch(text::trimmed(numbers[0]));
}

// Parses the name of a cyclic polytope: "cyclic polytope C(7,4)", "C(7, 4)", "7-cyclic polytope". Returns an error
// if the text has such a form but names no allowed number of vertices, and an empty optional for other texts. The
// design for five vertices is that of the 5-cell.
std::optional<PolytopeDesignOrError> cyclicPolytopeNamed(const PolytopeNameWords& text) {
    const std::vector<std::string>& words = text.words;
    const auto isFamily = [&](std::size_t at) {
        return at + 2 <= words.size() && words[at] == "cyclic" && words[at + 1] == "polytope";
    };
    std::optional<DiagramBranch> number;
    if (words.size() > 2 && isFamily(words.size() - 2)) {
        number = parseBranch(text::joined(words, 0, words.size() - 2));
    } else {
        const std::string symbol = text.joinedFrom(isFamily(0) ? 2 : 0);
        if (!isFamily(0) && !symbol.starts_with("c(")) return {};
        number = vertexCountInSymbol(symbol);
    }
    if (!number || number->denominator != 1 || number->numerator < kLeastCyclicVertices) {
        return PolytopeNameError::impossible("a cyclic polytope is named after the number of its vertices, from " +
                                             std::to_string(kLeastCyclicVertices) + " to " +
                                             std::to_string(kMostCyclicVertices) +
                                             ", as in cyclic polytope C(7,4) or 7-cyclic polytope");
    }
    const int n = number->numerator;
    if (n == 5) return designOf(std::get<CoxeterDiagram>(parseDiagram("x3o3o3o")));
    const std::string name = "cyclic polytope C(" + std::to_string(n) + ",4)";
    if (n > kMostCyclicVertices) {
        return PolytopeNameError{PolytopeNameError::Reason::too_large,
                                 "the " + name + " has " + std::to_string(n) + " vertices; at most " +
                                     std::to_string(kMostCyclicVertices) + " are allowed"};
    }
    return PolytopeDesign{name, std::make_shared<CyclicPolytopeRecipe>(static_cast<std::uint32_t>(n))};
}

}  // namespace

constinit const PolytopeNotation kCyclicPolytopeNotation{
    .polytopes =
        "a cyclic polytope C(n,4) with n from 5 to 448: the convex hull of n points at equal distances on the "
        "trigonometric moment curve (cos t, sin t, cos 2t, sin 2t). Every two of its vertices are joined by an edge, "
        "and its n(n − 3)/2 cells are tetrahedra",
    .examples = "`cyclic polytope C(7,4)`, `C(8, 4)`, `9-cyclic polytope`",
    .edges = "2 between neighbors on the curve; no other edge is shorter",
    .parse = cyclicPolytopeNamed,
};

}  // namespace oval4d::polytopes
