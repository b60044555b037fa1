#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "polytopes/construction/convex_hull.hpp"
#include "polytopes/construction/design.hpp"
#include "polytopes/construction/dual.hpp"
#include "polytopes/construction/notations.hpp"

namespace oval4d::polytopes {

namespace {

class TruncationOrRectificationRecipe : public Recipe {
  public:
    TruncationOrRectificationRecipe(bool truncation, PolytopeDesign base)
        : truncation_(truncation), base_(std::move(base)) {}

    // The number of vertices is exact: all points that build() takes from the edges of the convex base are vertices of
    // the hull, because for each edge, some hyperplane touches the base only in this edge. The other numbers are
    // estimates. They assume that one cell replaces each vertex of the base, and that each of the f 2-faces of the base
    // has four corners. An edge replaces each of these 4 f corners. After a truncation, a part of each of the e edges
    // of the base also remains. Euler's relation (vertices − edges + 2-faces − cells = 0) gives the number of 2-faces.
    ElementCounts countElements() const override {
        const auto [v, e, f, c] = base_.recipe->countElements();
        const std::uint64_t corners = 4 * f;
        const std::uint64_t cells = c + v;
        if (truncation_) return {2 * e, corners + e, corners + e + cells - 2 * e, cells};
        return {e, corners, corners + cells - e, cells};
    }
    std::uint64_t symmetryOrder() const override { return kUnknownOrder; }
    std::uint64_t hullPointCount() const override { return base_.recipe->hullPointCount() + countElements().vertices; }

    Polytope build(const std::string& name) const override {
        const Polytope base = buildRequiringConvex(base_);
        std::vector<glm::dvec4> points;
        for (const auto& [a, b] : base.edges) {
            const glm::dvec4 p = base.vertices[a], q = base.vertices[b];
            if (truncation_) {
                points.push_back((2.0 * p + q) / 3.0);
                points.push_back((p + 2.0 * q) / 3.0);
            } else {
                points.push_back((p + q) / 2.0);
            }
        }
        return centeredHull(name, points);
    }

  private:
    bool truncation_;
    PolytopeDesign base_;
};

bool isConvex(const CoxeterDiagram& diagram) {
    return std::ranges::all_of(diagram.branches, [](const auto& row) {
        return std::ranges::all_of(row, [](const DiagramBranch& branch) { return branch.denominator == 1; });
    });
}

// Parses the name of a convex polytope whose vertices are cut off: "truncation of grand antiprism", "rectification of
// dual of 5,7-duoprism". Returns an error if the text begins with "truncation of" or "rectification of" but the rest
// names no polytope. Returns an empty optional for other texts.
//
// The rectification is the convex hull of the midpoints of the edges. The truncation is the convex hull of the points
// that divide the edges into thirds. If the points next to a vertex do not lie in one hyperplane, several cells replace
// the vertex. Recipe::build throws std::invalid_argument if the named polytope is not convex, and TooLarge if a limit
// of convex_hull.hpp is exceeded.
//
// The rectification of a regular polytope has the design of the rectified uniform polytope. The truncation of a regular
// polytope whose 2-faces are triangles has the design of the truncated uniform polytope. For other 2-faces, the uniform
// truncation does not cut the edges at their thirds.
std::optional<PolytopeDesignOrError> truncationOrRectificationNamed(const PolytopeNameWords& text) {
    const bool truncation = text.words[0] == "truncation";
    if ((!truncation && text.words[0] != "rectification") || text.words.size() < 3 || text.words[1] != "of") return {};
    const PolytopeDesignOrError described = text.lookup(text.joinedFrom(2));
    const auto* base = std::get_if<PolytopeDesign>(&described);
    if (base == nullptr) return described;
    if (auto regular = diagramIfRegular(*base); regular && isConvex(*regular)) {
        const bool triangles = regular->branches[0][1] == DiagramBranch{3, 1};
        regular->ringed = {truncation, true, false, false};
        if (triangles || !truncation) return designOf(*regular);
    }
    return PolytopeDesign{text.words[0] + " of " + base->name,
                          std::make_shared<TruncationOrRectificationRecipe>(truncation, *base)};
}

}  // namespace

constinit const PolytopeNotation kTruncationOrRectificationNotation{
    .polytopes =
        "`truncation of X`, of a convex polytope: the convex hull of the points that divide the edges into thirds. "
        "For regular polytopes with triangles, this is the `truncated` polytope; the squares of a `truncated "
        "tesseract` are cut to regular octagons instead.<br>`rectification of X`, of a convex polytope: the convex "
        "hull of the midpoints of the edges. For regular polytopes, this is the `rectified` polytope",
    .examples = "`truncation of grand antiprism`, `rectification of pyramid of cube`",
    .edges = "2 if it is a `truncated` or `rectified` polytope; otherwise they follow from X",
    .constructions = "truncation,rectification",
    .parse = truncationOrRectificationNamed,
};

}  // namespace oval4d::polytopes
