#include "polytopes/construction/dual.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "polytopes/construction/design.hpp"
#include "polytopes/construction/diagram_text.hpp"
#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

namespace {

/// Returns the point nearest to the origin in the hyperplane of a cell.
glm::dvec4 footOf(const Polytope& polytope, std::uint32_t cell) {
    // Starts at a vertex and removes the components along three orthonormal directions in the hyperplane. The
    // Gram–Schmidt process finds the directions from differences of vertices; for accuracy, each direction is that of
    // the longest remainder.
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

class Dual : public Recipe {
  public:
    explicit Dual(Design base) : base_(std::move(base)) {}

    const Design& base() const { return base_; }

    ElementCounts counts() const override {
        const auto [vertices, edges, faces, cells] = base_.recipe->counts();
        return {cells, faces, edges, vertices};
    }
    std::uint64_t symmetryOrder() const override { return base_.recipe->symmetryOrder(); }

    // The dual has a vertex for each cell of the base, a 2-face for each edge (the loop of the cells around the edge),
    // and a cell for each vertex.
    Polytope build(const std::string& name) const override {
        const Polytope base = polytopes::build(base_);
        std::vector<glm::dvec4> vertices;
        double least = base.circumradius;
        for (std::uint32_t c = 0; c < base.cells.size(); ++c) {
            vertices.push_back(footOf(base, c));
            least = std::min(least, glm::length(vertices.back()));
        }
        constexpr double kNone = 1e-6;
        if (least < kNone * base.circumradius)
            throw std::invalid_argument("the hyperplane of a cell of the " + base.name + " passes through its center");
        for (glm::dvec4& v : vertices) v *= base.circumradius * least / glm::dot(v, v);

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
        return makePolytope(name, std::move(vertices), std::move(faces), std::move(cells));
    }

  private:
    Design base_;
};

/// Returns the dual of a regular polytope: its diagram has the ring at the other end. Returns std::nullopt for other
/// polytopes.
std::optional<Design> dualOfRegular(const Design& base) {
    const auto read = parseDiagram(base.recipe->linearNotation());
    const auto* diagram = std::get_if<Diagram>(&read);
    if (diagram == nullptr || componentsOf(*diagram).size() != 1) return {};
    for (const bool reversed : {false, true}) {
        std::array<bool, 4> ringed{true, false, false, false};
        if (reversed) std::ranges::reverse(ringed);
        const bool linear = diagram->branches[0][2].numerator == 2 && diagram->branches[0][3].numerator == 2 &&
                            diagram->branches[1][3].numerator == 2;
        if (!linear || diagram->ringed != ringed) continue;
        Diagram dual = *diagram;
        std::ranges::reverse(dual.ringed);
        return designOf(dual);
    }
    return {};
}

}  // namespace

std::optional<DesignOrError> dualNamed(const NameWords& text) {
    if (text.words.front() != "dual" || text.words.size() < 2) return {};
    const std::size_t skipped = text.words[1] == "of" ? 2 : 1;
    DesignOrError described = text.lookup(text.joinedFrom(skipped));
    const auto* base = std::get_if<Design>(&described);
    if (base == nullptr) {
        NameError error = std::get<NameError>(described);
        if (error.message.empty()) error.message = "'" + text.joinedFrom(skipped) + "' is not the name of a polytope";
        return error;
    }
    if (const auto* dual = dynamic_cast<const Dual*>(base->recipe.get())) return dual->base();
    if (auto regular = dualOfRegular(*base)) return *regular;
    return Design{"dual of " + base->name, std::make_shared<Dual>(*base)};
}

}  // namespace oval4d::polytopes
