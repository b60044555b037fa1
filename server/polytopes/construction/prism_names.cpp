#include "polytopes/construction/prism_names.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "polytopes/construction/design.hpp"
#include "polytopes/construction/diagram_text.hpp"
#include "polytopes/construction/polyhedra.hpp"
#include "text/words.hpp"

namespace oval4d::polytopes {

std::optional<DesignOrError> duoprismNamed(const NameWords& text) {
    if (text.words.back() != "duoprism") return {};
    const auto polygons = polygonsNamed(text.withoutLast());
    if (!polygons || std::ranges::any_of(*polygons, [](RegularPolygon each) { return each.numerator < 3; })) {
        return NameError::impossible(
            "a duoprism is named after two polygons with at least three sides, as in 5,7-duoprism or 5/2,5-duoprism");
    }
    if (polygons->size() != 2)
        return NameError::impossible("a duoprism is named after two polygons, as in 5,7-duoprism");
    return duoprism((*polygons)[0], (*polygons)[1]);
}

std::optional<DesignOrError> prismNamed(const NameWords& text) {
    if (text.words.back() != "prism" || text.words.size() < 2) return {};
    const std::vector<std::string> words = text.withoutLast();
    const std::string base = text::joined(words, 0, words.size());
    for (const NamedPolyhedron& solid : namedPolyhedra()) {
        if (base == solid.name || base == solid.adjective) return prismOf(solid);
    }
    if (words.size() < 2) return {};
    const std::string_view last = words.back();
    const bool antiprism = last == "antiprism" || last == "antiprismatic";
    if (!antiprism && last != "prism" && last != "prismatic") return {};
    const auto polygon = polygonNamed(text::joined(words, 0, words.size() - 1));
    if (!polygon) return {};
    if (polygon->numerator < 3 || (antiprism && polygon->denominator != 1)) {
        return NameError::impossible(antiprism
                                         ? "the polygon of an antiprism must have at least three sides and be no star"
                                         : "the polygon of a prism must have at least three sides");
    }
    return antiprism ? antiprismPrism(polygon->numerator) : duoprism(*polygon, {4, 1});
}

std::optional<DesignOrError> snubPrismDiagramNamed(const NameWords& text) {
    const std::string wanted = text::normalizedName(text.joinedFrom(0));
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

}  // namespace oval4d::polytopes
