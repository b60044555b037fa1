#include "geometry/catalogue.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <mutex>
#include <numeric>
#include <utility>

#include "geometry/coxeter.hpp"

namespace oval4d::geometry {

namespace {

const std::array<CatalogueEntry, 6> kEntries{{
    {"5-cell",
     {"pentachoron", "pen", "4-simplex", "simplex", "pentatope", "hyperpyramid"},
     "{3,3,3}",
     5,
     10,
     10,
     5,
     120},
    {"8-cell", {"tesseract", "tes", "hypercube", "4-cube", "octachoron"}, "{4,3,3}", 16, 32, 24, 8, 384},
    {"16-cell", {"hexadecachoron", "hex", "4-orthoplex", "cross-polytope"}, "{3,3,4}", 8, 24, 32, 16, 384},
    {"24-cell", {"icositetrachoron", "ico", "octaplex", "polyoctahedron"}, "{3,4,3}", 24, 96, 96, 24, 1152},
    {"120-cell", {"hecatonicosachoron", "hi", "dodecaplex", "polydodecahedron"}, "{5,3,3}", 600, 1200, 720, 120, 14400},
    {"600-cell", {"hexacosichoron", "ex", "tetraplex", "polytetrahedron"}, "{3,3,5}", 120, 720, 1200, 600, 14400},
}};

// The diagram of a regular polychoron {p, q, r}: the first mirror is ringed.
Polytope build(const CatalogueEntry& entry) {
    const auto branch = [&](std::size_t i) { return Branch{entry.schlaefli.at(i) - '0', 1}; };
    const Diagram diagram = Diagram::linear(branch(1), branch(3), branch(5), {true, false, false, false});
    Mirrors mirrors = mirrorsOf(diagram);
    // The even permutations that the 120-cell's coordinates are usually given as are those of the mirror image.
    if (entry.name == "120-cell") {
        for (auto& mirror : mirrors) std::swap(mirror.x, mirror.y);
    }
    return wythoff(std::string(entry.name), diagram, mirrors);
}

// Case and the difference between blanks, hyphens and underscores do not matter in a name.
std::string folded(std::string_view text) {
    std::string result;
    for (const char c : text) {
        const auto u = static_cast<unsigned char>(c);
        if (c == '-' || c == '_' || std::isspace(u) != 0) continue;
        result += static_cast<char>(std::tolower(u));
    }
    return result;
}

std::size_t editDistance(std::string_view a, std::string_view b) {
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

}  // namespace

std::span<const CatalogueEntry> catalogue() { return kEntries; }

const CatalogueEntry* findEntry(std::string_view nameOrAlias) {
    const std::string wanted = folded(nameOrAlias);
    for (const auto& entry : kEntries) {
        const auto is = [&](std::string_view known) { return folded(known) == wanted; };
        if (is(entry.name) || is(entry.schlaefli) || std::any_of(entry.aliases.begin(), entry.aliases.end(), is)) {
            return &entry;
        }
    }
    return nullptr;
}

std::string_view nearestName(std::string_view text) {
    const std::string wanted = folded(text.substr(0, 64));
    std::string_view best = kEntries[0].name;
    // Of names equally near, one of the same length: a wrong letter is likelier than a missing one.
    std::pair<std::size_t, std::size_t> least(-1, -1);
    const auto consider = [&](std::string_view candidate, std::string_view result) {
        const std::string known = folded(candidate);
        const std::size_t longer = std::max(known.size(), wanted.size()) - std::min(known.size(), wanted.size());
        const std::pair distance(editDistance(wanted, known), longer);
        if (distance < least) {
            least = distance;
            best = result;
        }
    };
    for (const auto& entry : kEntries) {
        consider(entry.name, entry.name);
        for (const auto alias : entry.aliases) consider(alias, alias);
    }
    return best;
}

std::shared_ptr<const Polytope> polytopeOf(const CatalogueEntry& entry) {
    static std::mutex mutex;
    static std::array<std::shared_ptr<const Polytope>, kEntries.size()> built;
    const std::scoped_lock lock(mutex);
    auto& slot = built.at(static_cast<std::size_t>(&entry - kEntries.data()));
    if (!slot) slot = std::make_shared<const Polytope>(build(entry));
    return slot;
}

}  // namespace oval4d::geometry
