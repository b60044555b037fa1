#include "polytopes/catalogue/names.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "polytopes/construction/combination.hpp"
#include "polytopes/construction/design.hpp"
#include "polytopes/construction/dual.hpp"
#include "polytopes/construction/duoantiprism.hpp"
#include "polytopes/construction/over_polyhedra.hpp"
#include "polytopes/construction/prism_names.hpp"
#include "polytopes/construction/solids.hpp"
#include "polytopes/construction/truncation_or_rectification.hpp"
#include "polytopes/construction/uniform.hpp"
#include "text/message_text.hpp"
#include "text/words.hpp"

namespace oval4d::polytopes {

namespace {

using Rings = std::array<bool, 4>;

// An operation on a regular polychoron. The diagram of the result is the diagram of the polychoron with other rings:
// around the nodes that `rings` selects.
struct Operation {
    std::string_view name;
    Rings rings;
};
constexpr auto kOperations = std::to_array<Operation>({
    {"rectified", {false, true, false, false}},
    {"birectified", {false, false, true, false}},
    {"trirectified", {false, false, false, true}},
    {"truncated", {true, true, false, false}},
    {"bitruncated", {false, true, true, false}},
    {"tritruncated", {false, false, true, true}},
    {"cantellated", {true, false, true, false}},
    {"bicantellated", {false, true, false, true}},
    {"runcinated", {true, false, false, true}},
    {"cantitruncated", {true, true, true, false}},
    {"bicantitruncated", {false, true, true, true}},
    {"runcitruncated", {true, true, false, true}},
    {"runcicantellated", {true, false, true, true}},
    {"omnitruncated", {true, true, true, true}},
    {"runcicantitruncated", {true, true, true, true}},
});

Diagram diagramOf(const UniformPolychoron& row) { return std::get<Diagram>(parseDiagram(row.linearNotation)); }

bool isRegular(const UniformPolychoron& row) { return row.family == "regular" || row.family == "star"; }

bool isCalled(const UniformPolychoron& row, std::string_view name) {
    const std::string wanted = text::normalizedName(name);
    if (text::normalizedName(row.name) == wanted || row.bowers == wanted) return true;
    const auto others = text::splitAtCommas(row.otherNames);
    return std::any_of(others.begin(), others.end(),
                       [&](std::string_view other) { return text::normalizedName(other) == wanted; });
}

template <typename Result>
DesignOrError designFrom(const Result& read) {
    if (const auto* error = std::get_if<NameError>(&read)) return *error;
    return designOf(std::get<Diagram>(read));
}

std::optional<DesignOrError> operationNamed(const NameWords& text) {
    for (const Operation& operation : kOperations) {
        if (text.words[0] != operation.name) continue;
        for (const UniformPolychoron& row : uniformPolychora()) {
            if (!isRegular(row) || !isCalled(row, text.joinedFrom(1))) continue;
            Diagram diagram = diagramOf(row);
            diagram.ringed = operation.rings;
            return designFrom(parseDiagram(linearNotationOf(diagram)));
        }
    }
    return {};
}

std::optional<DesignOrError> schlaefliNamed(const NameWords& text) {
    const std::string symbol = text.joinedFrom(0);
    if (symbol.find('{') == std::string::npos) return {};
    return designFrom(parseSchlaefli(symbol));
}

bool looksLikeDiagram(std::string_view text) {
    const bool begins = text.starts_with('x') || text.starts_with('o');
    return begins && text.size() > 2 && text.find_first_not_of("xo0123456789/ *abcd") == std::string_view::npos;
}

std::optional<DesignOrError> diagramNamed(const NameWords& text) {
    const std::string diagram = text.joinedFrom(0);
    if (!looksLikeDiagram(diagram)) return {};
    return designFrom(parseDiagram(diagram));
}

/// All notations, in the order in which they are tried. The first one that returns a design, or an error with a
/// message, gives the result. From the texts, tests/lint --fix makes the table of notations in protocol/README.md.
constexpr auto kNotations = std::to_array<NotationRow>({
    {
        .polytopes = "`dual of X`, of a convex polytope, or of a star without cells whose hyperplanes pass through the "
                     "center: the polar reciprocal about the center. Its circumradius is that of X, unless X is "
                     "regular. The dual of a dual is the polytope itself",
        .examples = "`dual of rectified 5-cell`, `dual 3,5-duoprism`",
        .edges = "2 if X is regular; otherwise they follow from X",
        .constructions = "dual",
        .parse = dualNamed,
    },
    {
        .polytopes = "`prism of P`, `pyramid of P` and `bipyramid of P`, over a polyhedron: the prism of height 2, or "
                     "the convex hull of P and a point, or two points, on its axis",
        .examples = "`prism of rhombic dodecahedron`, `pyramid of cube`, `bipyramid of icosahedron`",
        .edges = "those of P, which are 2 if P is uniform; 2 between the bases of a prism; to an apex, 2 if P is "
                 "uniform and has a circumradius of less than 2, otherwise such that the distance of the apex from the "
                 "center of P is the circumradius of P",
        .constructions = "prism,pyramid,bipyramid",
        .parse = overPolyhedronNamed,
    },
    {
        .polytopes =
            "`truncation of X`, of a convex polytope: the convex hull of the points that divide the edges into thirds. "
            "For regular polytopes with triangles, this is the `truncated` polytope; the squares of a `truncated "
            "tesseract` are cut to regular octagons instead.<br>`rectification of X`, of a convex polytope: the convex "
            "hull of the midpoints of the edges. For regular polytopes, this is the `rectified` polytope",
        .examples = "`truncation of grand antiprism`, `rectification of pyramid of cube`",
        .edges = "2 if it is a `truncated` or `rectified` polytope; otherwise they follow from X",
        .constructions = "truncation,rectification",
        .parse = truncationOrRectificationNamed,
    },
    {
        .polytopes = "`product of A and B`, of two polygons such as `5-gon`, `pentagon` and `5/2-gon`, or of a "
                     "polyhedron and `segment`: the duoprism, or the prism over the polyhedron.<br>`hull of X and Y`, "
                     "of two convex polytopes: the convex hull of both, with the same center.<br>`intersection of X "
                     "and Y`, of two convex polytopes: the points that belong to both, with the same center",
        .examples = "`product of 5-gon and 7-gon`, `hull of tesseract and 16-cell`, `intersection of tesseract and "
                    "16-cell of circumradius 3`",
        .edges = "2 for the product of polygons, or of a uniform polyhedron and a segment; otherwise they follow from "
                 "X and Y, or from the polyhedron",
        .constructions = "product,hull,intersection",
        .parse = combinationNamed,
    },
    {
        .polytopes = "a Schläfli symbol",
        .examples = "`{5,5/2,5}`, `t0,1{3,3,5}`, `{5}×{7}`, `tr{4,3}×{}`",
        .edges = "2",
        .parse = schlaefliNamed,
    },
    {
        .polytopes = "a Coxeter–Dynkin diagram in linear notation: x is a ringed node, o an unringed one, numbers "
                     "label branches, a blank separates unconnected parts, `*b` refers back to the second node",
        .examples = "`o5o3o3x`, `x3o3o *b3o`, `x5o x7o`, `x5/2o5o3o`",
        .edges = "2",
        .parse = diagramNamed,
    },
    {
        .polytopes = "the diagram of a prism over a snub polyhedron or an antiprism, in which s is a node of the snub "
                     "or antiprism",
        .examples = "`s4s3s x`, `s2s5s x`",
        .edges = "2",
        .parse = snubPrismDiagramNamed,
    },
    {
        .polytopes = "a duoprism, including those of star polygons; a single polygon stands for two",
        .examples =
            "`5,7-duoprism`, `5-7 duoprism`, `triangular-square duoprism`, `pentagonal duoprism`, `5/2,5-duoprism`",
        .edges = "2",
        .parse = duoprismNamed,
    },
    {
        .polytopes =
            "a duoantiprism: the convex hull of every other vertex of the duoprism of two polygons with twice as "
            "many sides. The polygons have at least two sides and are no stars; a single polygon stands for two",
        .examples = "`3,4-duoantiprism`, `3-4 duoantiprism`, `triangular-square duoantiprism`, `pentagonal "
                    "duoantiprism`, `2,5-duoantiprism`",
        .edges = "2 for the sides of the polygons; the other edges are equally long, and shorter unless the polytope "
                 "is the 16-cell",
        .parse = duoantiprismNamed,
    },
    {
        .polytopes = "a prism over a Platonic, Archimedean or Kepler–Poinsot solid, a prism or an antiprism",
        .examples = "`snub cube prism`, `truncated cubic prism`, `great icosahedral prism`, `9-gonal prism prism`, "
                    "`pentagonal antiprism prism`",
        .edges = "2",
        .parse = prismNamed,
    },
    {
        .polytopes = "an operation on a regular polytope by any of its names",
        .examples = "`truncated tesseract`, `rectified hexacosichoron`",
        .edges = "2",
        .parse = operationNamed,
    },
});

// Returns the words with which constructions begin: "dual", "prism", "hull" and so on. In a name, "of" follows them;
// after "dual", it may be omitted.
const std::vector<std::string_view>& constructionWords() {
    static const std::vector<std::string_view> all = [] {
        std::vector<std::string_view> found;
        for (const NotationRow& row : kNotations) {
            for (const std::string_view word : text::splitAtCommas(row.constructions)) found.push_back(word);
        }
        return found;
    }();
    return all;
}

// Counts the constructions in a name: each word of constructionWords() that is followed by "of", and each "dual" that
// is followed by any word.
std::size_t constructionsIn(const std::vector<std::string>& words) {
    std::size_t count = 0;
    for (std::size_t i = 0; i + 1 < words.size(); ++i) {
        const bool begins = std::ranges::find(constructionWords(), words[i]) != constructionWords().end();
        if (begins && (words[i + 1] == "of" || words[i] == "dual")) ++count;
    }
    return count;
}

// Returns why a text that is in none of the notations names no polytope: because it names a polyhedron, or because it
// has the form of a construction, but begins with an unknown word. Returns an empty string for other texts.
std::string reasonFor(const std::vector<std::string>& words) {
    if (const auto solid = solidNamed(words); solid && std::holds_alternative<Solid>(*solid)) {
        const std::string name = nameOf(std::get<Solid>(*solid));
        return "the " + name + " is a polyhedron; 4-D polytopes over it are the prism of " + name +
               ", the pyramid of " + name + " and the bipyramid of " + name;
    }
    if (words.size() < 3 || words[1] != "of") return {};
    const std::vector<std::string_view>& known = constructionWords();
    return text::inQuotes(words[0]) + " is not a construction" + text::didYouMean(words[0], known) + "; there are " +
           text::commaSeparated(known);
}

}  // namespace

std::span<const NotationRow> notations() { return kNotations; }

DesignOrError describedBy(std::string_view text, const DesignLookup& lookup) {
    const std::vector<std::string> words = text::wordsOf(text);
    if (words.empty()) return NameError{};
    if (const std::size_t count = constructionsIn(words); count > kMaxConstructions) {
        return NameError::impossible("the name has " + std::to_string(count) + " constructions; at most " +
                                     std::to_string(kMaxConstructions) + " are allowed");
    }
    for (const NotationRow& notation : kNotations) {
        auto found = notation.parse({words, lookup});
        if (!found) continue;
        const auto* error = std::get_if<NameError>(&*found);
        if (error == nullptr || error->reason != NameError::Reason::unknown || !error->message.empty())
            return *std::move(found);
    }
    return NameError{NameError::Reason::unknown, reasonFor(words)};
}

std::vector<std::string> operationNames(const Diagram& diagram) {
    std::vector<std::string> names;
    for (const UniformPolychoron& row : uniformPolychora()) {
        if (row.family != "regular") continue;
        for (const Operation& operation : kOperations) {
            // Skips operations that leave the first node without a ring, except rectification and bitruncation. The
            // result of a skipped operation has another name, as an operation on the dual.
            if (operation.rings < Rings{true} && operation.name != "rectified" && operation.name != "bitruncated")
                continue;
            Diagram regular = diagramOf(row);
            regular.ringed = operation.rings;
            if (canonical(regular) != canonical(diagram)) continue;
            names.push_back(std::string(operation.name) + " " + std::string(row.name));
            const std::string_view other = text::splitAtCommas(row.otherNames).front();
            names.push_back(std::string(operation.name) + " " + std::string(other));
        }
    }
    return names;
}

}  // namespace oval4d::polytopes
