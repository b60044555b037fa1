#include "polytopes/construction/dual.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "polytopes/construction/design.hpp"
#include "polytopes/construction/diagram_text.hpp"
#include "polytopes/construction/notations.hpp"
#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

namespace {

/// Returns the point nearest to the origin in the hyperplane of a cell.
glm::dvec4 footOfPerpendicular(const Polytope& polytope, std::uint32_t cell) {
    // Start at a vertex, and remove the components along three orthonormal directions in the hyperplane. The
    // Gram–Schmidt process computes these directions from the differences of vertices; for accuracy, it always takes
    // the longest remainder as the next direction.
    std::vector<glm::dvec4> points;
    for (const std::uint32_t f : polytope.cells[cell]) {
        for (const std::uint32_t v : polytope.faces[f]) points.push_back(polytope.vertices[v]);
    }
    glm::dvec4 foot = points.front();
    std::vector<glm::dvec4> rests;
    for (const glm::dvec4& point : points) rests.push_back(point - points.front());
    for (int dimension = 0; dimension < 3; ++dimension) {
        const auto longest =
            std::ranges::max_element(rests, {}, [](const glm::dvec4& rest) { return glm::dot(rest, rest); });
        const glm::dvec4 direction = glm::normalize(*longest);
        for (glm::dvec4& rest : rests) rest -= glm::dot(rest, direction) * direction;
        foot -= glm::dot(foot, direction) * direction;
    }
    return foot;
}

class DualRecipe : public Recipe {
  public:
    explicit DualRecipe(PolytopeDesign base) : base_(std::move(base)) {}

    const PolytopeDesign& base() const { return base_; }

    ElementCounts countElements() const override {
        const auto [vertices, edges, faces, cells] = base_.recipe->countElements();
        return {cells, faces, edges, vertices};
    }
    std::uint64_t symmetryOrder() const override { return base_.recipe->symmetryOrder(); }

    std::uint64_t hullPointCount() const override { return base_.recipe->hullPointCount(); }

    Polytope build(const std::string& name) const override {
        const Polytope base = polytopes::build(base_);
        std::vector<glm::dvec4> vertices = polesOf(base);
        double farthest = 0;
        for (const glm::dvec4& v : vertices) farthest = std::max(farthest, glm::length(v));
        for (glm::dvec4& v : vertices) v *= base.circumradius / farthest;
        return dualWithVertices(base, name, std::move(vertices));
    }

  private:
    PolytopeDesign base_;
};

}  // namespace

std::vector<glm::dvec4> polesOf(const Polytope& polytope) {
    constexpr double kLeastDistance = 1e-6;  // the least distance of a hyperplane from the origin, in circumradii
    std::vector<glm::dvec4> poles;
    for (std::uint32_t c = 0; c < polytope.cells.size(); ++c) {
        const glm::dvec4 foot = footOfPerpendicular(polytope, c);
        if (glm::length(foot) < kLeastDistance * polytope.circumradius)
            throw std::invalid_argument("the hyperplane of a cell of the " + polytope.name +
                                        " passes through its center");
        poles.push_back(foot / glm::dot(foot, foot));
    }
    return poles;
}

Polytope dualWithVertices(const Polytope& base, std::string name, std::vector<glm::dvec4> vertices) {
    geometry::JaggedArray faces;
    std::vector<std::vector<std::uint32_t>> facesAt(base.vertices.size());
    for (std::uint32_t e = 0; e < base.edges.size(); ++e) {
        std::vector<std::uint32_t> loop;
        for (const std::uint32_t s : base.edgeFaces[e]) loop.push_back(base.faceCells[s / 2].at(1 - s % 2));
        faces.add(loop);
        for (const std::uint32_t v : base.edges[e]) facesAt[v].push_back(e);
    }
    geometry::JaggedArray cells;
    for (const auto& around : facesAt) cells.add(around);
    return makePolytope(std::move(name), std::move(vertices), std::move(faces), std::move(cells));
}

std::optional<CoxeterDiagram> diagramIfRegular(const PolytopeDesign& design) {
    const auto read = parseDiagram(design.recipe->linearNotation());
    const auto* diagram = std::get_if<CoxeterDiagram>(&read);
    if (diagram == nullptr || componentsOf(*diagram).size() != 1) return {};
    const bool linear = diagram->branches[0][2].numerator == 2 && diagram->branches[0][3].numerator == 2 &&
                        diagram->branches[1][3].numerator == 2;
    if (!linear) return {};
    constexpr std::array<bool, 4> kFirst{true, false, false, false};
    constexpr std::array<bool, 4> kLast{false, false, false, true};
    if (diagram->ringed == kFirst) return *diagram;
    if (diagram->ringed == kLast) return permuted(*diagram, {3, 2, 1, 0});
    return {};
}

namespace {

// Parses a text such as "dual of rectified 5-cell". Returns the design of the dual, or an error if the rest of the text
// names no polytope. Returns an empty optional if the text does not begin with "dual".
//
// The dual is the polar reciprocal of the named polytope (Coxeter, Regular Polytopes, §7.5). A vertex v of the dual
// corresponds to the cell of the polytope in the hyperplane v · x = r². Here, r² is the circumradius times the least
// distance of a cell's hyperplane from the center, so the dual has the circumradius of the named polytope.
//
// The dual of a dual has the design of the original polytope. The dual of a regular polytope has the design, and
// therefore the size, of a regular polytope: the dual of the 8-cell is the 16-cell with edge length 2. If the
// hyperplane of a cell passes through the center, there is no dual, and Recipe::build throws std::invalid_argument.
std::optional<PolytopeDesignOrError> dualNamed(const PolytopeNameWords& text) {
    if (text.words.front() != "dual" || text.words.size() < 2) return {};
    const std::size_t skipped = text.words[1] == "of" ? 2 : 1;
    PolytopeDesignOrError described = text.lookup(text.joinedFrom(skipped));
    const auto* base = std::get_if<PolytopeDesign>(&described);
    if (base == nullptr) return std::get<PolytopeNameError>(described);
    if (const auto* dual = dynamic_cast<const DualRecipe*>(base->recipe.get())) return dual->base();
    if (auto regular = diagramIfRegular(*base)) {
        regular->ringed = {false, false, false, true};
        return designOf(*regular);
    }
    return PolytopeDesign{"dual of " + base->name, std::make_shared<DualRecipe>(*base)};
}

}  // namespace

constinit const PolytopeNotation kDualNotation{
    .polytopes =
        "`dual of X`, of a convex polytope, or of a star without cells whose hyperplanes pass through the "
        "center: the polar reciprocal about the center. Its circumradius is that of X, unless X is "
        "regular. The dual of a dual is the polytope itself",
    .examples = "`dual of rectified 5-cell`, `dual 3,5-duoprism`",
    .edges = "2 if X is regular; otherwise they follow from X",
    .constructions = "dual",
    .parse = dualNamed,
};

}  // namespace oval4d::polytopes
