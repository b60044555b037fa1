#include "geometry/design.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "geometry/coxeter.hpp"
#include "geometry/diminished.hpp"
#include "geometry/uniform.hpp"
#include "geometry/words.hpp"

namespace oval4d::geometry {

namespace {

constexpr Branch kSquare{4, 1};

template <typename... F>
struct Overloaded : F... {
    using F::operator()...;
};
template <typename... F>
Overloaded(F...) -> Overloaded<F...>;  // Clang 16 does not deduce it

Diagram known(std::string_view symbol) { return std::get<Diagram>(parseDiagram(symbol)); }

// Designs by canonical diagram: all that have a name of their own, under each of their diagrams.
const std::map<Diagram, Design>& namedDesigns() {
    static const std::map<Diagram, Design> kDesigns = [] {
        std::map<Diagram, Design> designs;
        for (const UniformPolychoron& row : uniformPolychora()) {
            const Design design{std::string(row.name), known(row.symbol)};
            designs.emplace(canonical(known(row.symbol)), design);
            for (const std::string_view other : listOf(row.others)) designs.emplace(canonical(known(other)), design);
        }
        for (const NamedPolyhedron& base : namedPolyhedra()) {
            if (base.symbol.starts_with('s')) continue;
            const Diagram diagram = known(std::string(base.symbol) + " x");
            designs.emplace(canonical(diagram), base.name == "cube"
                                                    ? designs.at(canonical(known("x4o3o3o")))
                                                    : Design{std::string(base.adjective) + " prism", diagram});
        }
        // The tetrahedron's group is half the cube's.
        for (const auto& [half, whole] :
             {std::pair{"o3x3o x", "o4o3x x"}, {"x3o3x x", "o4x3o x"}, {"x3x3x x", "o4x3x x"}})
            designs.emplace(canonical(known(half)), designs.at(canonical(known(whole))));
        return designs;
    }();
    return kDesigns;
}

// The vertices of a snub polyhedron are as many as its group has rotations.
std::uint64_t rotationsOf(const SnubPrism& snub) {
    return groupOrder(Diagram::linear(snub.p, snub.q, {}, {true, true, true, true})) / 4;
}

ElementCounts countsOf(const SnubPrism& snub) {
    const std::uint64_t vertices = rotationsOf(snub);
    std::uint64_t edges = vertices / 2;  // between neighbouring triangles
    std::uint64_t faces = vertices;      // the triangles
    for (const Branch b : {snub.p, snub.q}) {
        edges += b.numerator == 2 ? vertices / 2 : vertices;
        faces += b.numerator == 2 ? 0 : vertices / static_cast<std::uint64_t>(b.numerator);
    }
    return {2 * vertices, 2 * edges + vertices, 2 * faces + edges, faces + 2};
}

Polytope buildWythoffian(const Design& design, const Diagram& diagram) {
    Mirrors mirrors = mirrorsOf(diagram);
    // The even permutations that the 120-cell's coordinates are usually given as are those of the mirror image.
    if (design.name == "120-cell") {
        for (auto& mirror : mirrors) std::swap(mirror.x, mirror.y);
    }
    const ElementCounts counts = elementCounts(diagram);
    Polytope p = wythoff(design.name, diagram, mirrors, counts.vertices);
    if (ElementCounts{p.vertices.size(), p.edges.size(), p.faces.size(), p.cells.size()} != counts)
        throw std::invalid_argument("elements of " + design.name + " coincide");
    return p;
}

}  // namespace

Design designOf(const Diagram& diagram) {
    const auto& named = namedDesigns();
    if (const auto found = named.find(canonical(diagram)); found != named.end()) return found->second;
    // Two polygons where every part has at most two mirrors; two single ones make a square.
    std::vector<Branch> polygons;
    int single = 0;
    for (const Subset part : partsOf(diagram)) {
        if (std::popcount(part) > 2) return {symbolOf(diagram), diagram};
        if (std::popcount(part) == 1) {
            if (++single % 2 == 0) polygons.push_back(kSquare);
            continue;
        }
        const int a = std::countr_zero(part);
        const int b = std::bit_width(part) - 1;
        polygons.push_back(diagram.branches[a][b]);
        if (diagram.ringed.at(a) && diagram.ringed.at(b)) polygons.back().numerator *= 2;
    }
    return duoprism(polygons.at(0), polygons.at(1));
}

Design duoprism(Branch p, Branch q) {
    if (p == kSquare && q == kSquare) return designOf(known("x4o3o3o"));
    if (q < p) std::swap(p, q);
    return {textOf(p) + "," + textOf(q) + "-duoprism", Diagram::linear(p, {}, q, {true, false, true, false})};
}

Design antiprismPrism(int sides) {
    if (sides == 3) return designOf(known("o4o3x x"));
    return {adjectiveOf({sides, 1}) + " antiprism prism", SnubPrism{{sides, 1}, {2, 1}}};
}

Design prismOf(const NamedPolyhedron& base) {
    if (!base.symbol.starts_with('s')) return designOf(known(std::string(base.symbol) + " x"));
    const auto digit = [&](std::size_t i) { return Branch{base.symbol[i] - '0', 1}; };
    return {std::string(base.adjective) + " prism", SnubPrism{digit(1), digit(3)}};
}

ElementCounts elementCounts(const Design& design) {
    return std::visit(Overloaded{[](const Diagram& diagram) { return elementCounts(diagram); },
                                 [](const SnubPrism& snub) { return countsOf(snub); },
                                 [](Diminished which) {
                                     // 600 − 24 · 20 tetrahedra and 24 icosahedra; twenty antiprisms and 300
                                     // tetrahedra.
                                     return which == Diminished::snub_24_cell ? ElementCounts{96, 432, 480, 144}
                                                                              : ElementCounts{100, 500, 720, 320};
                                 }},
                      design.recipe);
}

std::uint64_t symmetryOrder(const Design& design) {
    return std::visit(
        Overloaded{[](const Diagram& diagram) { return groupOrder(diagram) * symmetriesOf(diagram).size(); },
                   // Those of the base, twice; an antiprism's are four for each side.
                   [](const SnubPrism& snub) { return rotationsOf(snub) * (snub.q.numerator == 2 ? 4 : 2); },
                   [](Diminished which) { return std::uint64_t{which == Diminished::snub_24_cell ? 576U : 400U}; }},
        design.recipe);
}

std::string symbolOf(const Design& design) {
    return std::visit(
        Overloaded{[](const Diagram& diagram) { return symbolOf(diagram); },
                   [](const SnubPrism& snub) {
                       // An antiprism's chain of mirrors begins with the right angle.
                       const bool antiprism = snub.q.numerator == 2;
                       const Branch first = antiprism ? snub.q : snub.p;
                       const Branch second = antiprism ? snub.p : snub.q;
                       return "s" + textOf(first) + "s" + textOf(second) + "s x";
                   },
                   [](Diminished which) { return std::string(which == Diminished::snub_24_cell ? "s3s4o3o" : ""); }},
        design.recipe);
}

std::string schlaefliOf(const Design& design) {
    return std::visit(
        Overloaded{[](const Diagram& diagram) { return schlaefliOf(diagram); },
                   [](const SnubPrism& snub) {
                       return snub.q.numerator == 2 ? "s{2," + std::to_string(2 * snub.p.numerator) + "}×{}"
                                                    : "sr{" + textOf(snub.p) + "," + textOf(snub.q) + "}×{}";
                   },
                   [](Diminished which) { return std::string(which == Diminished::snub_24_cell ? "s{3,4,3}" : ""); }},
        design.recipe);
}

Polytope build(const Design& design) {
    return std::visit(Overloaded{[&](const Diagram& diagram) { return buildWythoffian(design, diagram); },
                                 [&](const SnubPrism& snub) { return prismOver(design.name, snubOf(snub.p, snub.q)); },
                                 [&](Diminished which) {
                                     return which == Diminished::snub_24_cell ? snub24Cell(design.name)
                                                                              : grandAntiprism(design.name);
                                 }},
                      design.recipe);
}

}  // namespace oval4d::geometry
