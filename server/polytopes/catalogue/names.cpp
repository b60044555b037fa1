#include "polytopes/catalogue/names.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "polytopes/construction/combination.hpp"
#include "polytopes/construction/design.hpp"
#include "polytopes/construction/dual.hpp"
#include "polytopes/construction/over_polyhedra.hpp"
#include "polytopes/construction/solids.hpp"
#include "polytopes/construction/truncation_or_rectification.hpp"
#include "polytopes/construction/uniform.hpp"
#include "text/message_text.hpp"
#include "text/words.hpp"

namespace oval4d::polytopes {

namespace {

using Rings = std::array<bool, 4>;

// An operation on a regular polychoron: the diagram of the result is the same, but with rings around these nodes.
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

std::optional<Design> snubPrismNamed(std::string_view linearNotation) {
    const std::string wanted = text::normalizedName(linearNotation);
    for (const NamedPolyhedron& base : namedPolyhedra()) {
        const std::string own(base.linearNotation);
        if (own.starts_with('s') && (wanted == own + "x" || wanted == "x" + own)) return prismOf(base);
    }
    if (wanted == "s3s3sx" || wanted == "xs3s3s") return prismOf(namedPolyhedra()[4]);  // the icosahedral prism
    for (const auto& [before, after] : {std::pair{"s2s", "sx"}, {"xs2s", "s"}}) {
        const std::string_view start(before);
        const std::string_view end(after);
        if (!wanted.starts_with(start) || !wanted.ends_with(end) || wanted.size() <= start.size() + end.size())
            continue;
        const auto polygon =
            parseBranch(std::string_view(wanted).substr(start.size(), wanted.size() - start.size() - end.size()));
        if (polygon && polygon->denominator == 1 && polygon->numerator > 2) return antiprismPrism(polygon->numerator);
    }
    return {};
}

DesignOrError duoprismNamed(std::vector<std::string> words) {
    // "5,7" and "5x7" are single words.
    if (words.size() == 1) {
        std::string pair = words[0];
        for (const std::string_view times : {"×", "*"}) {
            if (const std::size_t at = pair.find(times); at != std::string::npos) pair.replace(at, times.size(), ",");
        }
        const std::size_t between = std::min(pair.find(','), pair.find('x'));
        if (between != std::string::npos) words = {pair.substr(0, between), pair.substr(between + 1)};
    }
    std::vector<RegularPolygon> polygons;
    for (const std::string& word : words) {
        std::string own = word;
        if (own.ends_with(',')) own.pop_back();
        if (own == "gonal" || own.empty()) continue;
        const auto polygon = polygonNamed(own);
        if (!polygon || polygon->numerator < 3) {
            return NameError::impossible(
                "a duoprism is named after two polygons with at least three sides, as in 5,7-duoprism or "
                "5/2,5-duoprism");
        }
        polygons.push_back(*polygon);
    }
    if (polygons.size() == 1) polygons.push_back(polygons[0]);
    if (polygons.size() != 2)
        return NameError::impossible("a duoprism is named after two polygons, as in 5,7-duoprism");
    return duoprism(polygons[0], polygons[1]);
}

DesignOrError prismNamed(const std::vector<std::string>& words) {
    const std::string base = text::joined(words, 0, words.size());
    for (const NamedPolyhedron& solid : namedPolyhedra()) {
        if (base == solid.name || base == solid.adjective) return prismOf(solid);
    }
    if (words.size() < 2) return NameError{};
    const std::string_view last = words.back();
    const bool antiprism = last == "antiprism" || last == "antiprismatic";
    if (!antiprism && last != "prism" && last != "prismatic") return NameError{};
    const auto polygon = polygonNamed(text::joined(words, 0, words.size() - 1));
    if (!polygon) return NameError{};
    if (polygon->numerator < 3 || (antiprism && polygon->denominator != 1)) {
        return NameError::impossible(antiprism
                                         ? "the polygon of an antiprism must have at least three sides and be no star"
                                         : "the polygon of a prism must have at least three sides");
    }
    return antiprism ? antiprismPrism(polygon->numerator) : duoprism(*polygon, {4, 1});
}

DesignOrError operationNamed(const std::vector<std::string>& words) {
    for (const Operation& operation : kOperations) {
        if (words[0] != operation.name) continue;
        for (const UniformPolychoron& row : uniformPolychora()) {
            if (!isRegular(row) || !isCalled(row, text::joined(words, 1, words.size()))) continue;
            Diagram diagram = diagramOf(row);
            diagram.ringed = operation.rings;
            return designFrom(parseDiagram(linearNotationOf(diagram)));
        }
    }
    return NameError{};
}

bool looksLikeDiagram(std::string_view text) {
    const bool begins = text.starts_with('x') || text.starts_with('o');
    return begins && text.size() > 2 && text.find_first_not_of("xo0123456789/ *abcd") == std::string_view::npos;
}

/// All notations, in the order in which they are tried. The first one that returns a design, or an error with a
/// message, gives the result.
constexpr auto kNotations = std::to_array<Notation>({
    // A dual: "dual of rectified 5-cell", "dual 3,5-duoprism".
    dualNamed,
    // A polytope over a polyhedron: "prism of rhombic dodecahedron", "pyramid of cube", "bipyramid of icosahedron".
    overPolyhedronNamed,
    // A polytope with its vertices cut off: "truncation of grand antiprism", "rectification of pyramid of cube".
    truncationOrRectificationNamed,
    // Two polytopes or polygons: "hull of tesseract and 16-cell", "intersection of …", "product of 5-gon and 7-gon".
    combinationNamed,
    // A Schläfli symbol: "{5,5/2,5}", "t0,1{3,3,5}".
    [](const NameWords& text) -> std::optional<DesignOrError> {
        if (text.joinedFrom(0).find('{') == std::string::npos) return {};
        return designFrom(parseSchlaefli(text.joinedFrom(0)));
    },
    // A diagram: "x5o3o3x", "x3o3o *b3o", "x5o x7o".
    [](const NameWords& text) -> std::optional<DesignOrError> {
        if (!looksLikeDiagram(text.joinedFrom(0))) return {};
        return designFrom(parseDiagram(text.joinedFrom(0)));
    },
    // The diagram of a snub prism: "s4s3s x".
    [](const NameWords& text) -> std::optional<DesignOrError> {
        if (auto snub = snubPrismNamed(text.joinedFrom(0))) return *snub;
        return {};
    },
    // A duoprism: "5,7-duoprism", "5-7 duoprism", "triangular-square duoprism", "pentagonal duoprism" (both pentagons).
    [](const NameWords& text) -> std::optional<DesignOrError> {
        if (text.words.back() != "duoprism") return {};
        return duoprismNamed(text.withoutLast());
    },
    // A prism: "pentagonal antiprism prism", "6-gonal prism prism", "snub cube prism", "truncated cubic prism".
    [](const NameWords& text) -> std::optional<DesignOrError> {
        if (text.words.back() != "prism" || text.words.size() < 2) return {};
        return prismNamed(text.withoutLast());
    },
    // An operation on a regular polychoron: "omnitruncated 120-cell", "rectified hexacosichoron".
    [](const NameWords& text) -> std::optional<DesignOrError> { return operationNamed(text.words); },
});

// Returns the reason why a text in none of the notations names no polytope; an empty string if no particular reason is
// known.
std::string reasonFor(const std::vector<std::string>& words) {
    if (const auto solid = solidNamed(words); solid && std::holds_alternative<Solid>(*solid)) {
        const std::string name = nameOf(std::get<Solid>(*solid));
        return "the " + name + " is a polyhedron; 4-D polytopes over it are the prism of " + name +
               ", the pyramid of " + name + " and the bipyramid of " + name;
    }
    if (words.size() < 3 || words[1] != "of") return {};
    const auto known = constructionWords();
    return text::inQuotes(words[0]) + " is not a construction" + text::didYouMean(words[0], known) + "; there are " +
           text::commaSeparated(known);
}

}  // namespace

DesignOrError describedBy(std::string_view text, const DesignLookup& lookup) {
    const std::vector<std::string> words = text::wordsOf(text);
    if (words.empty()) return NameError{};
    if (const std::size_t count = constructionsIn(words); count > kMaxConstructions) {
        return NameError::impossible("the name has " + std::to_string(count) + " constructions; at most " +
                                     std::to_string(kMaxConstructions) + " are allowed");
    }
    for (const Notation notation : kNotations) {
        auto found = notation({words, lookup});
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
            // Skips operations that leave the first node without a ring, because their results also have names as
            // operations on the dual. Rectification and bitruncation are not skipped.
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
