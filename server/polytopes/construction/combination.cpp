#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "polytopes/construction/convex_hull.hpp"
#include "polytopes/construction/design.hpp"
#include "polytopes/construction/dual.hpp"
#include "polytopes/construction/notations.hpp"
#include "polytopes/construction/polyhedra.hpp"
#include "text/message_text.hpp"
#include "text/words.hpp"

namespace oval4d::polytopes {

namespace {

constexpr double kLeastRadius = 0.01, kMostRadius = 100;

bool isCombinationWord(std::string_view word) { return word == "hull" || word == "intersection" || word == "product"; }

// One of the two polytopes of a hull or an intersection.
struct CombinationOperand {
    PolytopeDesign design;
    std::optional<double> circumradius;  // the circumradius that the name states; empty for the default (see
                                         // combinationNamed())

    // Returns a name from which operandNamed() makes an equal operand.
    std::string name() const {
        std::string result = design.name;
        if (circumradius) result += " of circumradius " + text::shortestDecimal(*circumradius);
        return result;
    }
};

using Words = std::vector<std::string>;

// Returns the index of the word "and" between the names of the two operands, or an empty optional if there is none.
// An "and" within the name of the first operand, as in "hull of hull of A and B and C", does not count.
std::optional<std::size_t> findAndBetweenOperands(const Words& words) {
    int nested = 0;
    for (std::size_t i = 2; i < words.size(); ++i) {
        if (isCombinationWord(words[i]) && i + 1 < words.size() && words[i + 1] == "of") ++nested;
        if (words[i] == "and" && nested-- == 0) return i;
    }
    return {};
}

std::variant<CombinationOperand, PolytopeNameError> operandNamed(const Words& words, const DesignLookup& lookup) {
    CombinationOperand operand;
    std::size_t end = words.size();
    // text::lowerCaseWords() divides a text at hyphens, so it turns the number 5e-1 into two words.
    const std::size_t numberWords = end > 1 && words[end - 2].ends_with('e') ? 2 : 1;
    const std::size_t suffix = 2 + numberWords;
    if (end > suffix && words[end - suffix] == "of" && words[end - suffix + 1] == "circumradius") {
        double value = 0;
        const std::string number = numberWords == 2 ? words[end - 2] + '-' + words[end - 1] : words[end - 1];
        const auto [rest, error] = std::from_chars(number.data(), number.data() + number.size(), value);
        if (error != std::errc{} || rest != number.data() + number.size() ||
            !(value >= kLeastRadius && value <= kMostRadius)) {
            return PolytopeNameError::impossible(
                text::inQuotes(number) + " is not a circumradius; it must be a number from " +
                text::shortestDecimal(kLeastRadius) + " to " + text::shortestDecimal(kMostRadius));
        }
        operand.circumradius = value;
        end -= suffix;
    }
    const PolytopeDesignOrError described = lookup(text::joined(words, 0, end));
    if (const auto* error = std::get_if<PolytopeNameError>(&described)) return *error;
    operand.design = std::get<PolytopeDesign>(described);
    return operand;
}

class HullOrIntersectionRecipe : public Recipe {
  public:
    HullOrIntersectionRecipe(bool intersection, CombinationOperand first, CombinationOperand second)
        : intersection_(intersection), operands_{std::move(first), std::move(second)} {}

    ElementCounts countElements() const override {
        const ElementCounts a = operands_[0].design.recipe->countElements(),
                            b = operands_[1].design.recipe->countElements();
        return {a.vertices + b.vertices, a.edges + b.edges, a.faces + b.faces, a.cells + b.cells};
    }
    std::uint64_t symmetryOrder() const override { return kUnknownOrder; }
    std::uint64_t hullPointCount() const override {
        const auto [vertices, edges, faces, cells] = countElements();
        return operands_[0].design.recipe->hullPointCount() + operands_[1].design.recipe->hullPointCount() +
               (intersection_ ? cells : vertices);
    }

    Polytope build(const std::string& name) const override {
        std::vector<glm::dvec4> points;
        double circumradius = 0;
        for (const CombinationOperand& operand : operands_) {
            const Polytope polytope = buildRequiringConvex(operand.design);
            if (circumradius == 0 || operand.circumradius)
                circumradius = operand.circumradius.value_or(polytope.circumradius);
            const double scale = circumradius / polytope.circumradius;
            // The intersection of two polytopes is the polar reciprocal of the hull of their polar reciprocals. The
            // vertices of the polar reciprocal of a polytope are the poles of its cells (see polesOf()).
            for (const glm::dvec4& point : intersection_ ? polesOf(polytope) : polytope.vertices)
                points.push_back(intersection_ ? point / scale : point * scale);
        }
        if (!intersection_) return centeredHull(name, points);
        const Polytope hull = hullPolytope(name, points);
        return centered(dualWithVertices(hull, name, polesOf(hull)));
    }

  private:
    bool intersection_;
    std::array<CombinationOperand, 2> operands_;
};

PolytopeDesignOrError productNamed(const Words& one, const Words& other, const DesignLookup& lookup) {
    const std::string first = text::joined(one, 0, one.size());
    const std::string second = text::joined(other, 0, other.size());
    for (const auto& [factor, solid] : {std::pair(first, second), std::pair(second, first)}) {
        if (factor == "segment") return lookup("prism of " + solid);
    }
    const auto p = polygonNamed(first);
    const auto q = polygonNamed(second);
    if (!p || !q || p->numerator < 3 || q->numerator < 3) {
        return PolytopeNameError::impossible(
            text::inQuotes(!p || p->numerator < 3 ? first : second) +
            " is not a polygon with at least three sides; a product is that of two polygons, as in "
            "product of 5-gon and 7-gon, or of a polyhedron and a segment, as in product of cube and "
            "segment");
    }
    return duoprismDesign(*p, *q);
}

// Parses the name of a combination of two polytopes: "hull of tesseract and 16-cell", "intersection of 120-cell and
// 600-cell of circumradius 4", "product of 5-gon and 7-gon". Returns an error if the text begins with "hull of",
// "intersection of" or "product of" but is not a valid name. Returns an empty optional for other texts.
//
// Both polytopes of a hull or an intersection must be convex; each is centered at the origin. By default, the first
// polytope has the size that it has alone, and the second polytope has the circumradius of the first. A name followed
// by "of circumradius" and a number from 0.01 to 100 sets another circumradius. The hull or intersection is moved such
// that the mean of its vertices is the origin. Recipe::build throws std::invalid_argument if one of the two polytopes
// is not convex, and TooLarge if a limit of convex_hull.hpp is exceeded.
//
// The product of two polygons is their duoprism. The product of a polyhedron and a segment (of length 2) is the prism
// over the polyhedron.
std::optional<PolytopeDesignOrError> combinationNamed(const PolytopeNameWords& text) {
    const Words& words = text.words;
    if (!isCombinationWord(words[0]) || words.size() < 3 || words[1] != "of") return {};
    const auto at = findAndBetweenOperands(words);
    if (!at || *at == 2 || *at + 1 == words.size()) {
        const std::string example = words[0] == "product" ? "5-gon and 7-gon" : "tesseract and 16-cell";
        return PolytopeNameError::impossible("the word 'and' must stand between two names, as in " + words[0] + " of " +
                                             example);
    }
    const auto middle = words.begin() + static_cast<std::ptrdiff_t>(*at);
    const Words one(words.begin() + 2, middle), other(middle + 1, words.end());
    if (words[0] == "product") return productNamed(one, other, text.lookup);
    auto first = operandNamed(one, text.lookup);
    if (const auto* error = std::get_if<PolytopeNameError>(&first)) return *error;
    auto second = operandNamed(other, text.lookup);
    if (const auto* error = std::get_if<PolytopeNameError>(&second)) return *error;
    auto& a = std::get<CombinationOperand>(first);
    auto& b = std::get<CombinationOperand>(second);
    return PolytopeDesign{words[0] + " of " + a.name() + " and " + b.name(),
                          std::make_shared<HullOrIntersectionRecipe>(words[0] == "intersection", a, b)};
}

}  // namespace

constinit const PolytopeNotation kCombinationNotation{
    .polytopes =
        "`product of A and B`, of two polygons such as `5-gon`, `pentagon` and `5/2-gon`, or of a "
        "polyhedron and `segment`: the duoprism, or the prism over the polyhedron.<br>`hull of X and Y`, "
        "of two convex polytopes: the convex hull of both, with the same center.<br>`intersection of X "
        "and Y`, of two convex polytopes: the points that belong to both, with the same center",
    .examples =
        "`product of 5-gon and 7-gon`, `hull of tesseract and 16-cell`, `intersection of tesseract and "
        "16-cell of circumradius 3`",
    .edges =
        "2 for the product of polygons, or of a uniform polyhedron and a segment; otherwise they follow from "
        "X and Y, or from the polyhedron",
    .constructions = "product,hull,intersection",
    .parse = combinationNamed,
};

}  // namespace oval4d::polytopes
