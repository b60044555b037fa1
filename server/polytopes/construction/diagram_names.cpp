#include "polytopes/construction/diagram_names.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "polytopes/construction/design.hpp"
#include "polytopes/construction/notations.hpp"
#include "polytopes/construction/uniform.hpp"
#include "text/words.hpp"

namespace oval4d::polytopes {

namespace {

using RingedNodes = std::array<bool, 4>;

// An operation on a regular polychoron, such as truncation. The operation keeps the diagram of the polychoron, but
// rings the nodes that `rings` selects.
struct RingOperation {
    std::string_view name;
    RingedNodes rings;
};
constexpr auto kOperations = std::to_array<RingOperation>({
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

CoxeterDiagram diagramOf(const NamedWythoffianPolychoron& row) {
    return std::get<CoxeterDiagram>(parseDiagram(row.linearNotation));
}

bool isRegular(const NamedWythoffianPolychoron& row) { return row.family == "regular" || row.family == "star"; }

bool isCalled(const NamedWythoffianPolychoron& row, std::string_view name) {
    const std::string wanted = text::normalizedName(name);
    if (text::normalizedName(row.name) == wanted || row.bowers == wanted) return true;
    const auto others = text::splitAtCommas(row.otherNames);
    return std::any_of(others.begin(), others.end(),
                       [&](std::string_view other) { return text::normalizedName(other) == wanted; });
}

template <typename Result>
PolytopeDesignOrError designFrom(const Result& read) {
    if (const auto* error = std::get_if<PolytopeNameError>(&read)) return *error;
    return designOf(std::get<CoxeterDiagram>(read));
}

std::optional<PolytopeDesignOrError> designNamedByOperation(const PolytopeNameWords& text) {
    for (const RingOperation& operation : kOperations) {
        if (text.words[0] != operation.name) continue;
        for (const NamedWythoffianPolychoron& row : namedWythoffianPolychora()) {
            if (!isRegular(row) || !isCalled(row, text.joinedFrom(1))) continue;
            CoxeterDiagram diagram = diagramOf(row);
            diagram.ringed = operation.rings;
            return designFrom(parseDiagram(linearNotationOf(diagram)));
        }
    }
    return {};
}

std::optional<PolytopeDesignOrError> designNamedBySchlaefli(const PolytopeNameWords& text) {
    const std::string symbol = text.joinedFrom(0);
    if (symbol.find('{') == std::string::npos) return {};
    return designFrom(parseSchlaefli(symbol));
}

bool looksLikeDiagram(std::string_view text) {
    const bool begins = text.starts_with('x') || text.starts_with('o');
    return begins && text.size() > 2 && text.find_first_not_of("xo0123456789/ *abcd") == std::string_view::npos;
}

std::optional<PolytopeDesignOrError> designNamedByDiagram(const PolytopeNameWords& text) {
    const std::string diagram = text.joinedFrom(0);
    if (!looksLikeDiagram(diagram)) return {};
    return designFrom(parseDiagram(diagram));
}

}  // namespace

constinit const PolytopeNotation kSchlaefliNotation{
    .polytopes = "a Schläfli symbol",
    .examples = "`{5,5/2,5}`, `t0,1{3,3,5}`, `{5}×{7}`, `tr{4,3}×{}`",
    .edges = "2",
    .parse = designNamedBySchlaefli,
};

constinit const PolytopeNotation kDiagramNotation{
    .polytopes =
        "a Coxeter–Dynkin diagram in linear notation: x is a ringed node, o an unringed one, numbers "
        "label branches, a blank separates unconnected parts, `*b` refers back to the second node",
    .examples = "`o5o3o3x`, `x3o3o *b3o`, `x5o x7o`, `x5/2o5o3o`",
    .edges = "2",
    .parse = designNamedByDiagram,
};

constinit const PolytopeNotation kOperationNotation{
    .polytopes = "an operation on a regular polytope by any of its names",
    .examples = "`truncated tesseract`, `rectified hexacosichoron`",
    .edges = "2",
    .parse = designNamedByOperation,
};

std::vector<std::string> operationNames(const CoxeterDiagram& diagram) {
    std::vector<std::string> names;
    for (const NamedWythoffianPolychoron& row : namedWythoffianPolychora()) {
        if (row.family != "regular") continue;
        for (const RingOperation& operation : kOperations) {
            // Skip operations that leave the first node without a ring, except rectification and bitruncation. The
            // results of the skipped operations are usually named as operations on the dual polytope.
            if (operation.rings < RingedNodes{true} && operation.name != "rectified" && operation.name != "bitruncated")
                continue;
            CoxeterDiagram regular = diagramOf(row);
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
