#include "polytopes/construction/design.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "polytopes/construction/coxeter.hpp"
#include "polytopes/construction/diagram_text.hpp"
#include "polytopes/construction/prism_over.hpp"
#include "polytopes/construction/snub.hpp"
#include "polytopes/construction/uniform.hpp"
#include "polytopes/polytope.hpp"
#include "text/words.hpp"

namespace oval4d::polytopes {

namespace {

constexpr RegularPolygon kSquare{4, 1};

CoxeterDiagram parseValidDiagram(std::string_view linearNotation) {
    return std::get<CoxeterDiagram>(parseDiagram(linearNotation));
}

/// A recipe for the uniform polytopes that Wythoff's construction makes from Coxeter–Dynkin diagrams.
class WythoffianRecipe : public Recipe {
  public:
    explicit WythoffianRecipe(const CoxeterDiagram& diagram) : diagram_(diagram) {}

    ElementCounts countElements() const override { return elementCounts(diagram_); }
    std::uint64_t symmetryOrder() const override { return groupOrder(diagram_) * automorphismsOf(diagram_).size(); }
    std::string linearNotation() const override { return linearNotationOf(diagram_); }
    std::string schlaefli() const override { return schlaefliOf(diagram_); }

    Polytope build(const std::string& name) const override {
        Mirrors mirrors = mirrorsOf(diagram_);
        // In the usual coordinates of the 120-cell, the coordinates of some vertices are the even permutations of four
        // numbers. The mirrors of mirrorsOf() generate the mirror image, with the odd permutations; exchanging x and y
        // corrects this.
        if (name == "120-cell") {
            for (auto& mirror : mirrors) std::swap(mirror.x, mirror.y);
        }
        Polytope p = wythoffConstruction(name, diagram_, mirrors, countElements().vertices);
        if (ElementCounts{p.vertices.size(), p.edges.size(), p.faces.size(), p.cells.size()} != countElements())
            throw std::invalid_argument("elements of " + name + " coincide");
        return p;
    }

  private:
    CoxeterDiagram diagram_;
};

/// A recipe for the prism over the snub of {p, q}. For p = n and q = 2, the snub is the n-antiprism.
class SnubPrismRecipe : public Recipe {
  public:
    SnubPrismRecipe(DiagramBranch p, DiagramBranch q) : p_(p), q_(q) {}

    ElementCounts countElements() const override {
        const std::uint64_t vertices = rotationGroupOrder();
        std::uint64_t edges = vertices / 2;  // the edges between two of the triangles counted below
        std::uint64_t faces = vertices;      // the triangles of the snub that are neither p-gons nor q-gons
        for (const DiagramBranch b : {p_, q_}) {
            edges += b.numerator == 2 ? vertices / 2 : vertices;
            faces += b.numerator == 2 ? 0 : vertices / static_cast<std::uint64_t>(b.numerator);
        }
        return {2 * vertices, 2 * edges + vertices, 2 * faces + edges, faces + 2};
    }
    // The symmetries of the prism are those of its base, each with or without a reflection that exchanges the two
    // bases. A snub base has only the rotations as symmetries. An antiprism has twice as many, because half of its
    // symmetries are not rotations.
    std::uint64_t symmetryOrder() const override { return rotationGroupOrder() * (q_.numerator == 2 ? 4 : 2); }
    std::string linearNotation() const override {
        // By convention, the diagram of an antiprism begins with the branch number 2: the prism over the 5-antiprism is
        // "s2s5s x", not "s5s2s x".
        const bool antiprism = q_.numerator == 2;
        return "s" + textOf(antiprism ? q_ : p_) + "s" + textOf(antiprism ? p_ : q_) + "s x";
    }
    std::string schlaefli() const override {
        return q_.numerator == 2 ? "s{2," + std::to_string(2 * p_.numerator) + "}×{}"
                                 : "sr{" + textOf(p_) + "," + textOf(q_) + "}×{}";
    }
    Polytope build(const std::string& name) const override { return prismOver(name, snubOf(p_, q_)); }

  private:
    // Returns the order of the rotation group of {p, q}, which is also the number of vertices of the snub polyhedron.
    std::uint64_t rotationGroupOrder() const {
        return groupOrder(CoxeterDiagram::linear(p_, q_, {}, {true, true, true, true})) / 4;
    }

    DiagramBranch p_, q_;
};

std::shared_ptr<const Recipe> makeWythoffianRecipe(const CoxeterDiagram& diagram) {
    return std::make_shared<WythoffianRecipe>(diagram);
}

// Returns the designs that have names of their own. The key of a design is its canonical diagram; a design with several
// diagrams has an entry for each of them.
const std::map<CoxeterDiagram, PolytopeDesign>& designsByDiagram() {
    static const std::map<CoxeterDiagram, PolytopeDesign> kDesigns = [] {
        std::map<CoxeterDiagram, PolytopeDesign> designs;
        for (const NamedWythoffianPolychoron& row : namedWythoffianPolychora()) {
            const PolytopeDesign design{std::string(row.name),
                                        makeWythoffianRecipe(parseValidDiagram(row.linearNotation))};
            designs.emplace(canonical(parseValidDiagram(row.linearNotation)), design);
            for (const std::string_view other : text::splitAtCommas(row.otherDiagrams))
                designs.emplace(canonical(parseValidDiagram(other)), design);
        }
        for (const NamedPolyhedron& base : namedPolyhedra()) {
            if (base.linearNotation.starts_with('s')) continue;
            const CoxeterDiagram diagram = parseValidDiagram(std::string(base.linearNotation) + " x");
            designs.emplace(canonical(diagram), base.name == "cube"
                                                    ? designs.at(canonical(parseValidDiagram("x4o3o3o")))
                                                    : PolytopeDesign{std::string(base.adjective) + " prism",
                                                                     makeWythoffianRecipe(diagram)});
        }
        // The tetrahedral group is a subgroup of the octahedral group. The bases of the following three prisms have the
        // full octahedral symmetry, so each of these prisms also has a diagram of the octahedral group.
        for (const auto& [half, whole] :
             {std::pair{"o3x3o x", "o4o3x x"}, {"x3o3x x", "o4x3o x"}, {"x3x3x x", "o4x3x x"}})
            designs.emplace(canonical(parseValidDiagram(half)), designs.at(canonical(parseValidDiagram(whole))));
        return designs;
    }();
    return kDesigns;
}

}  // namespace

PolytopeDesign designOf(const CoxeterDiagram& diagram) {
    const auto& named = designsByDiagram();
    if (const auto found = named.find(canonical(diagram)); found != named.end()) return found->second;
    // If every connected component of the diagram has at most two mirrors, the polytope is a duoprism. A component of
    // two mirrors generates a polygon. Two components that have one mirror each generate a square together.
    std::vector<RegularPolygon> polygons;
    int single = 0;
    for (const MirrorSet component : componentsOf(diagram)) {
        if (std::popcount(component) > 2) return {linearNotationOf(diagram), makeWythoffianRecipe(diagram)};
        if (std::popcount(component) == 1) {
            if (++single % 2 == 0) polygons.push_back(kSquare);
            continue;
        }
        const int a = std::countr_zero(component);
        const int b = std::bit_width(component) - 1;
        polygons.push_back(diagram.branches[a][b]);
        if (diagram.ringed.at(a) && diagram.ringed.at(b)) polygons.back().numerator *= 2;
    }
    return duoprismDesign(polygons.at(0), polygons.at(1));
}

PolytopeDesign duoprismDesign(RegularPolygon p, RegularPolygon q) {
    if (p == kSquare && q == kSquare) return designOf(parseValidDiagram("x4o3o3o"));
    if (q < p) std::swap(p, q);
    return {textOf(p) + "," + textOf(q) + "-duoprism",
            makeWythoffianRecipe(CoxeterDiagram::linear(p, {}, q, {true, false, true, false}))};
}

PolytopeDesign antiprismPrismDesign(int sides) {
    if (sides == 3) return designOf(parseValidDiagram("o4o3x x"));
    return {adjectiveOf({sides, 1}) + " antiprism prism",
            std::make_shared<SnubPrismRecipe>(DiagramBranch{sides, 1}, DiagramBranch{2, 1})};
}

PolytopeDesign prismDesignOver(const NamedPolyhedron& base) {
    if (!base.linearNotation.starts_with('s'))
        return designOf(parseValidDiagram(std::string(base.linearNotation) + " x"));
    const auto digit = [&](std::size_t i) { return DiagramBranch{base.linearNotation[i] - '0', 1}; };
    return {std::string(base.adjective) + " prism", std::make_shared<SnubPrismRecipe>(digit(1), digit(3))};
}

ElementCounts elementCounts(const PolytopeDesign& design) { return design.recipe->countElements(); }
std::uint64_t symmetryOrder(const PolytopeDesign& design) { return design.recipe->symmetryOrder(); }
std::string linearNotationOf(const PolytopeDesign& design) { return design.recipe->linearNotation(); }
std::string schlaefliOf(const PolytopeDesign& design) { return design.recipe->schlaefli(); }

Polytope build(const PolytopeDesign& design) {
    Polytope polytope = design.recipe->build(design.name);
    polytope.rebuildableFromName = true;
    return polytope;
}

}  // namespace oval4d::polytopes
