#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "polytopes/construction/design.hpp"
#include "polytopes/construction/diagram_text.hpp"
#include "polytopes/construction/notations.hpp"
#include "polytopes/construction/polyhedra.hpp"
#include "text/words.hpp"

namespace oval4d::polytopes {

namespace {

// Parses the name of a duoprism of two regular polygons: "5,7-duoprism", "5-7 duoprism", "triangular-square duoprism",
// "pentagonal duoprism" (of two pentagons). Returns an error if the text ends with "duoprism" but the words before it
// do not name two polygons with at least three sides. Returns an empty optional for other texts.
std::optional<PolytopeDesignOrError> duoprismNamed(const PolytopeNameWords& text) {
    if (text.words.back() != "duoprism") return {};
    const auto polygons = duoprismPolygonsNamed(text.withoutLast());
    if (!polygons || std::ranges::any_of(*polygons, [](RegularPolygon each) { return each.numerator < 3; })) {
        return PolytopeNameError::impossible(
            "a duoprism is named after two polygons with at least three sides, as in 5,7-duoprism or 5/2,5-duoprism");
    }
    if (polygons->size() != 2)
        return PolytopeNameError::impossible("a duoprism is named after two polygons, as in 5,7-duoprism");
    return duoprismDesign((*polygons)[0], (*polygons)[1]);
}

// Parses the name of a prism over a uniform polyhedron: "pentagonal antiprism prism", "6-gonal prism prism", "snub cube
// prism", "truncated cubic prism". Returns an error if a polygon has fewer than three sides, or if the polygon of an
// antiprism is a star. Returns an empty optional for other texts.
std::optional<PolytopeDesignOrError> prismNamed(const PolytopeNameWords& text) {
    if (text.words.back() != "prism" || text.words.size() < 2) return {};
    const std::vector<std::string> words = text.withoutLast();
    const std::string base = text::joined(words, 0, words.size());
    for (const NamedPolyhedron& solid : namedPolyhedra()) {
        if (base == solid.name || base == solid.adjective) return prismDesignOver(solid);
    }
    if (words.size() < 2) return {};
    const std::string_view last = words.back();
    const bool antiprism = last == "antiprism" || last == "antiprismatic";
    if (!antiprism && last != "prism" && last != "prismatic") return {};
    const auto polygon = polygonNamed(text::joined(words, 0, words.size() - 1));
    if (!polygon) return {};
    if (polygon->numerator < 3 || (antiprism && polygon->denominator != 1)) {
        return PolytopeNameError::impossible(
            antiprism ? "the polygon of an antiprism must have at least three sides and be no star"
                      : "the polygon of a prism must have at least three sides");
    }
    return antiprism ? antiprismPrismDesign(polygon->numerator) : duoprismDesign(*polygon, {4, 1});
}

// Parses the diagram of a prism over a snub polyhedron or an antiprism: "s4s3s x", "x s2s5s". Returns an empty optional
// for other texts.
std::optional<PolytopeDesignOrError> snubPrismDiagramNamed(const PolytopeNameWords& text) {
    const std::string wanted = text::normalizedName(text.joinedFrom(0));
    for (const NamedPolyhedron& base : namedPolyhedra()) {
        const std::string own(base.linearNotation);
        if (own.starts_with('s') && (wanted == own + "x" || wanted == "x" + own)) return prismDesignOver(base);
    }
    if (wanted == "s3s3sx" || wanted == "xs3s3s")
        return prismDesignOver(namedPolyhedra()[4]);  // s3s3s is the icosahedron
    for (const auto& [before, after] : {std::pair{"s2s", "sx"}, {"xs2s", "s"}}) {
        const std::string_view start(before);
        const std::string_view end(after);
        if (!wanted.starts_with(start) || !wanted.ends_with(end) || wanted.size() <= start.size() + end.size())
            continue;
        const auto polygon =
            parseBranch(std::string_view(wanted).substr(start.size(), wanted.size() - start.size() - end.size()));
        if (polygon && polygon->denominator == 1 && polygon->numerator > 2)
            return antiprismPrismDesign(polygon->numerator);
    }
    return {};
}

}  // namespace

constinit const PolytopeNotation kDuoprismNotation{
    .polytopes = "a duoprism, including those of star polygons; a single polygon stands for two",
    .examples = "`5,7-duoprism`, `5-7 duoprism`, `triangular-square duoprism`, `pentagonal duoprism`, `5/2,5-duoprism`",
    .edges = "2",
    .parse = duoprismNamed,
};

constinit const PolytopeNotation kPrismNotation{
    .polytopes = "a prism over a Platonic, Archimedean or Kepler–Poinsot solid, a prism or an antiprism",
    .examples =
        "`snub cube prism`, `truncated cubic prism`, `great icosahedral prism`, `9-gonal prism prism`, "
        "`pentagonal antiprism prism`",
    .edges = "2",
    .parse = prismNamed,
};

constinit const PolytopeNotation kSnubPrismDiagramNotation{
    .polytopes =
        "the diagram of a prism over a snub polyhedron or an antiprism, in which s is a node of the snub "
        "or antiprism",
    .examples = "`s4s3s x`, `s2s5s x`",
    .edges = "2",
    .parse = snubPrismDiagramNamed,
};

}  // namespace oval4d::polytopes
