#include "polytopes/catalogue/catalogue.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "polytopes/catalogue/names.hpp"
#include "polytopes/construction/convex_hull.hpp"
#include "polytopes/construction/diagram_names.hpp"
#include "polytopes/construction/diagram_text.hpp"
#include "polytopes/construction/diminished.hpp"
#include "polytopes/construction/uniform.hpp"
#include "text/message_text.hpp"
#include "text/words.hpp"

namespace oval4d::polytopes {

namespace {

CatalogueEntry catalogueEntryOf(PolytopeDesign design, std::string family, std::vector<std::string> aliases) {
    const ElementCounts counts = elementCounts(design);
    const auto narrow = [](std::uint64_t count) { return static_cast<std::uint32_t>(count); };
    aliases.erase(std::remove_if(aliases.begin(), aliases.end(),
                                 [&](const std::string& alias) { return alias.empty() || alias == design.name; }),
                  aliases.end());
    return {design.name,          std::move(family),
            std::move(aliases),   linearNotationOf(design),
            schlaefliOf(design),  narrow(counts.vertices),
            narrow(counts.edges), narrow(counts.faces),
            narrow(counts.cells), narrow(symmetryOrder(design)),
            std::move(design)};
}

CatalogueEntry catalogueEntryOf(const NamedWythoffianPolychoron& row) {
    std::vector<std::string> aliases;
    for (const std::string_view name : text::splitAtCommas(row.otherNames)) aliases.emplace_back(name);
    aliases.insert(row.family == "regular" ? aliases.begin() + 1 : aliases.begin(), std::string(row.bowers));
    if (row.family == "regular" && aliases.size() < 2) aliases.emplace_back(row.bowers);
    const auto add = [&](std::string_view symbol) {
        for (std::string& name : operationNames(std::get<CoxeterDiagram>(parseDiagram(symbol)))) {
            if (std::find(aliases.begin(), aliases.end(), name) == aliases.end()) aliases.push_back(std::move(name));
        }
    };
    add(row.linearNotation);
    for (const std::string_view other : text::splitAtCommas(row.otherDiagrams)) {
        add(other);
        aliases.emplace_back(other);
    }
    return catalogueEntryOf(designOf(std::get<CoxeterDiagram>(parseDiagram(row.linearNotation))),
                            std::string(row.family), std::move(aliases));
}

// A duoprism in the catalogue: the numbers of sides of its two polygons, and Bowers' short name (empty if there is
// none).
struct DuoprismRow {
    int p, q;
    std::string_view bowersName;
};
constexpr auto kDuoprisms = std::to_array<DuoprismRow>({{3, 3, "triddip"},
                                                        {3, 4, "tisdip"},
                                                        {3, 5, "trapedip"},
                                                        {3, 6, "thiddip"},
                                                        {4, 5, "squipdip"},
                                                        {4, 6, "shiddip"},
                                                        {5, 5, "pedip"},
                                                        {5, 6, "phiddip"},
                                                        {5, 7, ""},
                                                        {6, 6, "hiddip"},
                                                        {8, 8, "odip"},
                                                        {12, 12, ""},
                                                        {3, 24, ""}});
// The antiprism prisms in the catalogue: the number of sides of the antiprism's base, and Bowers' short name.
constexpr auto kAntiprismPrisms = std::to_array<std::pair<int, std::string_view>>(
    {{4, "squappip"}, {5, "pappip"}, {6, "happip"}, {8, "oappip"}, {10, "dappip"}});

std::vector<CatalogueEntry> makeCatalogueEntries() {
    std::vector<CatalogueEntry> entries;
    for (const NamedWythoffianPolychoron& row : namedWythoffianPolychora()) entries.push_back(catalogueEntryOf(row));
    entries.push_back(
        catalogueEntryOf(snub24CellDesign(), "other", {"sadi", "snub icositetrachoron", "snub disicositetrachoron"}));
    entries.push_back(catalogueEntryOf(grandAntiprismDesign(), "other", {"gap", "pentagonal double antiprismoid"}));
    for (const NamedPolyhedron& base : namedPolyhedra()) {
        // `prism` is empty for the cube, whose prism is the 8-cell, and for the Kepler–Poinsot solids, whose prisms are
        // not in the catalogue.
        if (base.prism.empty()) continue;
        entries.push_back(catalogueEntryOf(prismDesignOver(base), "prism",
                                           {std::string(base.prism), std::string(base.name) + " prism"}));
    }
    for (const auto& [sides, bowersName] : kAntiprismPrisms) {
        entries.push_back(catalogueEntryOf(antiprismPrismDesign(sides), "antiprism prism", {std::string(bowersName)}));
    }
    for (const auto& [p, q, bowersName] : kDuoprisms) {
        const std::string names = adjectiveOf({p, 1}) + (p == q ? "" : "-" + adjectiveOf({q, 1})) + " duoprism";
        entries.push_back(
            catalogueEntryOf(duoprismDesign({p, 1}, {q, 1}), "duoprism", {std::string(bowersName), names}));
    }
    return entries;
}

const std::vector<CatalogueEntry>& catalogueEntries() {
    static const std::vector<CatalogueEntry> kEntries = makeCatalogueEntries();
    return kEntries;
}

// Returns a map to the entries. The keys of an entry are its name, aliases, diagram and Schläfli symbol, each converted
// by text::normalizedName().
const std::unordered_map<std::string, const CatalogueEntry*>& entriesByName() {
    static const auto kIndex = [] {
        std::unordered_map<std::string, const CatalogueEntry*> byName;
        for (const CatalogueEntry& entry : catalogueEntries()) {
            byName.emplace(text::normalizedName(entry.name), &entry);
            for (const std::string& alias : entry.aliases) byName.emplace(text::normalizedName(alias), &entry);
            for (const std::string& symbol : {entry.diagram, entry.schlaefli}) {
                if (!symbol.empty()) byName.emplace(text::normalizedName(symbol), &entry);
            }
        }
        return byName;
    }();
    return kIndex;
}

struct NearMatch {
    std::string_view name;
    const CatalogueEntry* entry;
};

// Returns whether a text of `length` letters may be a misspelling of a name at the edit distance `distance` from the
// text: whether `distance` is at most a third of `length`.
bool isPlausibleMisspelling(std::size_t distance, std::size_t length) { return 3 * distance <= length; }

// Returns the names with the least edit distance from `text`, at most one name for each entry. Returns an empty list if
// even this distance is too large for a misspelling. Of several names with this distance, keeps only those whose length
// is nearest to that of `text`, because a wrong letter is likelier than a missing one.
std::vector<NearMatch> nearMatches(std::string_view text) {
    text = text.substr(0, kMaxNameBytes);
    const std::size_t wanted = text::normalizedName(text).size();
    std::vector<NearMatch> best;
    std::pair<std::size_t, std::size_t> least(-1, -1);
    for (const polytopes::CatalogueEntry& entry : catalogueEntries()) {
        const auto consider = [&](std::string_view name) {
            const std::size_t known = text::normalizedName(name).size();
            const std::size_t longer = std::max(known, wanted) - std::min(known, wanted);
            // The edit distance is at least the difference of the lengths.
            if (longer > least.first || !isPlausibleMisspelling(longer, wanted)) return;
            const std::pair distance(polytopes::editDistanceOfNames(text, name), longer);
            if (distance < least) best.clear();
            if (distance <= least && (best.empty() || best.back().entry != &entry)) best.push_back({name, &entry});
            least = std::min(least, distance);
        };
        consider(entry.name);
        for (const std::string& alias : entry.aliases) consider(alias);
    }
    if (!isPlausibleMisspelling(least.first, wanted)) best.clear();
    return best;
}

// Returns the reason why a polytope is too large to be built; an empty optional if it is not too large.
std::optional<PolytopeNameError> tooLargeError(const PolytopeDesign& design, std::size_t maxVertices) {
    const auto error = [&](const std::string& what, std::uint64_t most) {
        return PolytopeNameError{PolytopeNameError::Reason::too_large,
                                 "the " + design.name + what + "; at most " + std::to_string(most) + " are allowed"};
    };
    const std::uint64_t vertices = elementCounts(design).vertices;
    if (vertices > maxVertices) return error(" has " + std::to_string(vertices) + " vertices", maxVertices);
    const std::uint64_t points = design.recipe->hullPointCount();
    if (points > kMaxHullPoints)
        return error(" takes convex hulls of about " + std::to_string(points) + " points", kMaxHullPoints);
    return {};
}

// Returns the design of the polytope that `text` names, like designNamed(). `text` is a part of a longer name, such as
// "tesseract" in "dual of tesseract". If designNamed() returns an error without a message, adds a message that quotes
// this part.
PolytopeDesignOrError designOfNamePart(std::string_view text, std::size_t maxVertices) {
    auto result = designNamed(text, maxVertices);
    if (auto* error = std::get_if<PolytopeNameError>(&result); error != nullptr && error->message.empty()) {
        error->message = text::inQuotes(text) + " is not the name of a polytope";
        std::vector<std::string> near;
        for (const std::string_view name : equallyNearestNames(text)) near.push_back(text::inQuotes(name));
        const std::vector<std::string_view> views(near.begin(), near.end());
        if (!near.empty()) error->message += "; did you mean " + text::joinedWithOr(views) + "?";
    }
    return result;
}

}  // namespace

std::span<const CatalogueEntry> catalogue() { return catalogueEntries(); }

const CatalogueEntry* findEntry(std::string_view text) {
    if (const auto found = entriesByName().find(text::normalizedName(text)); found != entriesByName().end())
        return found->second;
    const auto described = designDescribedBy(text, [](std::string_view base) -> PolytopeDesignOrError {
        const CatalogueEntry* entry = findEntry(base);
        return entry != nullptr ? PolytopeDesignOrError(entry->design) : PolytopeNameError{};
    });
    const auto* design = std::get_if<PolytopeDesign>(&described);
    if (design == nullptr) return nullptr;
    const auto found = entriesByName().find(text::normalizedName(design->name));
    return found == entriesByName().end() ? nullptr : found->second;
}

PolytopeDesignOrError designNamed(std::string_view text, std::size_t maxVertices) {
    if (const auto* entry = findEntry(text)) return entry->design;
    auto described =
        designDescribedBy(text, [=](std::string_view base) { return designOfNamePart(base, maxVertices); });
    if (const auto* design = std::get_if<PolytopeDesign>(&described)) {
        if (design->name.size() > kMaxNameBytes) {
            return PolytopeNameError::impossible("the name has " + std::to_string(design->name.size()) +
                                                 " bytes; at most " + std::to_string(kMaxNameBytes) + " are allowed");
        }
        if (auto error = tooLargeError(*design, maxVertices)) return *std::move(error);
    }
    return described;
}

std::size_t editDistanceOfNames(std::string_view one, std::string_view other) {
    const std::string a = text::normalizedName(one.substr(0, kMaxNameBytes));
    const std::string b = text::normalizedName(other.substr(0, kMaxNameBytes));
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

std::string_view nearestName(std::string_view text) {
    const auto near = nearMatches(text);
    return near.empty() ? std::string_view{} : near.front().name;
}

std::vector<std::string_view> equallyNearestNames(std::string_view text) {
    constexpr std::size_t kMost = 3;
    std::vector<std::string_view> names;
    for (const NearMatch& near : nearMatches(text)) names.push_back(near.name);
    names.resize(std::min(names.size(), kMost));
    return names;
}

}  // namespace oval4d::polytopes
