#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "polytopes/construction/design.hpp"
#include "polytopes/construction/notations.hpp"
#include "polytopes/construction/prism_over.hpp"
#include "polytopes/construction/solids.hpp"
#include "text/words.hpp"

namespace oval4d::polytopes {

namespace {

enum class PrismOrPyramidKind : std::uint8_t { prism, pyramid, bipyramid };

constexpr auto kWords =
    std::to_array<std::pair<std::string_view, PrismOrPyramidKind>>({{"prism", PrismOrPyramidKind::prism},
                                                                    {"pyramid", PrismOrPyramidKind::pyramid},
                                                                    {"bipyramid", PrismOrPyramidKind::bipyramid}});

class PrismOrPyramidRecipe : public Recipe {
  public:
    PrismOrPyramidRecipe(PrismOrPyramidKind over, const SolidDescription& solid) : over_(over), solid_(solid) {}

    ElementCounts countElements() const override {
        const auto [v, e, f] = countsOf(solid_);
        switch (over_) {
            case PrismOrPyramidKind::prism:
                return {2 * v, 2 * e + v, 2 * f + e, f + 2};
            case PrismOrPyramidKind::pyramid:
                return {v + 1, e + v, f + e, f + 1};
            case PrismOrPyramidKind::bipyramid:
                break;
        }
        return {v + 2, e + 2 * v, f + 2 * e, 2 * f};
    }

    std::uint64_t symmetryOrder() const override { return kUnknownOrder; }

    Polytope build(const std::string& name) const override {
        SolidMesh base = meshOf(solid_);
        if (over_ == PrismOrPyramidKind::prism) {
            // The base is the dual of a uniform polyhedron, because uniformPrismOver() makes the prisms over uniform
            // polyhedra. The symmetries of such a dual map each face to every other face, so all faces are in one
            // orbit.
            const std::vector<std::uint32_t> orbits(base.faces.size(), 0);
            return prismOver(name, {std::move(base.vertices), std::move(base.faces), orbits});
        }
        const auto n = static_cast<std::uint32_t>(base.vertices.size());
        const double height = apexHeightOver(base.vertices);
        const double shift =
            over_ == PrismOrPyramidKind::pyramid ? height / (n + 1) : 0;  // by which the vertices are moved along −w,
                                                                          // so that their mean is the origin
        std::vector<glm::dvec4> vertices;
        for (const glm::dvec3& v : base.vertices) vertices.emplace_back(v, -shift);
        vertices.emplace_back(0, 0, 0, height - shift);
        if (over_ == PrismOrPyramidKind::bipyramid) vertices.emplace_back(0, 0, 0, -height);

        geometry::JaggedArray faces = base.faces;
        geometry::JaggedArray cells;
        std::vector<std::uint32_t> all(base.faces.size());
        std::iota(all.begin(), all.end(), 0U);
        if (over_ == PrismOrPyramidKind::pyramid) cells.add(all);
        for (std::uint32_t apex = n; apex < vertices.size(); ++apex) {
            std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> triangles;
            for (std::uint32_t f = 0; f < base.faces.size(); ++f) {
                const auto loop = base.faces[f];
                std::vector<std::uint32_t> cell{f};
                for (std::size_t i = 0; i < loop.size(); ++i) {
                    const std::pair<std::uint32_t, std::uint32_t> edge =
                        std::minmax(loop[i], loop[(i + 1) % loop.size()]);
                    const auto [triangle, fresh] =
                        triangles.try_emplace(edge, static_cast<std::uint32_t>(faces.size()));
                    if (fresh) faces.add(std::array{edge.first, edge.second, apex});
                    cell.push_back(triangle->second);
                }
                cells.add(cell);
            }
        }
        return makePolytope(name, std::move(vertices), std::move(faces), std::move(cells));
    }

  private:
    // Returns the height of a pyramid, or of each half of a bipyramid, over a polyhedron with the vertices `base`. The
    // comment of prismOrPyramidNamed() has the rules.
    double apexHeightOver(const std::vector<glm::dvec3>& base) const {
        constexpr double kEdge = 2, kFlat = 1e-6;
        double circumradius = 0;
        for (const glm::dvec3& v : base) circumradius = std::max(circumradius, glm::length(v));
        const double square = kEdge * kEdge - circumradius * circumradius;
        return solid_.dual || square < kFlat ? circumradius : std::sqrt(square);
    }

    PrismOrPyramidKind over_;
    SolidDescription solid_;
};

PolytopeDesign prismOrPyramidOver(PrismOrPyramidKind over, const SolidDescription& solid) {
    const auto is = [&](std::string_view name) { return nameOf(solid) == name; };
    if (over == PrismOrPyramidKind::prism && !solid.dual) return uniformPrismOver(solid);
    if (over == PrismOrPyramidKind::pyramid && is("tetrahedron"))
        return designOf(std::get<CoxeterDiagram>(parseDiagram("x3o3o3o")));
    if (over == PrismOrPyramidKind::bipyramid && is("octahedron"))
        return designOf(std::get<CoxeterDiagram>(parseDiagram("x3o3o4o")));
    const auto word = std::ranges::find(kWords, over, &std::pair<std::string_view, PrismOrPyramidKind>::second)->first;
    return {std::string(word) + " of " + nameOf(solid), std::make_shared<PrismOrPyramidRecipe>(over, solid)};
}

// Parses the name of a prism, pyramid or bipyramid over a polyhedron: "prism of cube", "pyramid of rhombic
// dodecahedron", "bipyramid of 5-gonal antiprism". solids.hpp describes the polyhedra. Returns an error if the text
// begins with "prism of", "pyramid of" or "bipyramid of" but the rest names no convex polyhedron. Returns an empty
// optional for other texts.
//
// The prism has the height 2. If the polyhedron is uniform and its circumradius is less than 2, all edges to the apex
// of a pyramid or bipyramid have length 2. Otherwise, the height of a pyramid, and of each half of a bipyramid, is the
// circumradius of the polyhedron. The mean of the vertices is the origin. If the name denotes a uniform polytope,
// returns the design of this polytope, for example the 5-cell for "pyramid of tetrahedron".
std::optional<PolytopeDesignOrError> prismOrPyramidNamed(const PolytopeNameWords& text) {
    if (text.words.size() < 3 || text.words[1] != "of") return {};
    const auto word = std::ranges::find(kWords, text.words[0], &std::pair<std::string_view, PrismOrPyramidKind>::first);
    if (word == kWords.end()) return {};
    const auto solid = solidNamed({text.words.begin() + 2, text.words.end()});
    if (!solid) {
        return PolytopeNameError::impossible(
            "'" + text.joinedFrom(2) + "' is not the name of a polyhedron; a " + std::string(word->first) +
            " is built over a Platonic or Archimedean solid, a prism, an antiprism, or the dual of "
            "one of these, as in " +
            std::string(word->first) + " of cube");
    }
    if (const auto* error = std::get_if<PolytopeNameError>(&*solid)) return *error;
    return prismOrPyramidOver(word->second, std::get<SolidDescription>(*solid));
}

}  // namespace

constinit const PolytopeNotation kOverPolyhedronNotation{
    .polytopes =
        "`prism of P`, `pyramid of P` and `bipyramid of P`, over a polyhedron: the prism of height 2, or "
        "the convex hull of P and a point, or two points, on its axis",
    .examples = "`prism of rhombic dodecahedron`, `pyramid of cube`, `bipyramid of icosahedron`",
    .edges =
        "those of P, which are 2 if P is uniform; 2 between the bases of a prism; to an apex, 2 if P is "
        "uniform and has a circumradius of less than 2, otherwise such that the distance of the apex from the "
        "center of P is the circumradius of P",
    .constructions = "prism,pyramid,bipyramid",
    .parse = prismOrPyramidNamed,
};

}  // namespace oval4d::polytopes
