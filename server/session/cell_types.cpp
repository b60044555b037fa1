#include "session/cell_types.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <utility>

#include "polytopes/construction/solids.hpp"
#include "text/message_text.hpp"
#include "text/words.hpp"

namespace oval4d::session {

namespace {

CellTypeList sortedUnique(CellTypeList list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
}

void removeCellTypes(CellTypeList& from, const CellTypeList& types) {
    std::erase_if(from, [&](std::uint32_t type) { return std::binary_search(types.begin(), types.end(), type); });
}

void addCellTypes(CellTypeList& to, const CellTypeList& types) {
    to.insert(to.end(), types.begin(), types.end());
    to = sortedUnique(std::move(to));
}

Result<std::monostate> checkCellTypes(const CellTypeList& types, const geometry::ObjectInfo& object) {
    for (const std::uint32_t type : types) {
        if (type < object.cellTypes.size()) continue;
        const std::string available = object.cellTypes.empty() ? "no cells"
                                      : object.cellTypes.size() == 1
                                          ? "one kind of cell, 0"
                                          : std::to_string(object.cellTypes.size()) + " kinds of cells, 0 to " +
                                                std::to_string(object.cellTypes.size() - 1);
        return Error{ErrorCode::out_of_range,
                     "the " + object.name + " has " + available + "; there is no " + std::to_string(type)};
    }
    return std::monostate{};
}

}  // namespace

Result<CellTypeList> parseCellTypes(std::string_view text) {
    constexpr std::string_view kSeparators = ", \t";
    CellTypeList types;
    if (text == "none") return types;
    for (;;) {
        text.remove_prefix(std::min(text.find_first_not_of(kSeparators), text.size()));
        if (text.empty()) break;
        const std::string_view word = text.substr(0, text.find_first_of(kSeparators));
        std::uint32_t type = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), type);
        if (error != std::errc{} || end != word.data() + word.size()) {
            return Error{ErrorCode::bad_expression,
                         text::inQuotes(word) + " is not the number of a kind of cell; write numbers such as 0,2"};
        }
        types.push_back(type);
        text.remove_prefix(word.size());
    }
    return sortedUnique(std::move(types));
}

Result<CellTypeList> findCellTypes(std::string_view text, const geometry::ObjectInfo& object) {
    if (object.cellTypes.empty()) return Error{ErrorCode::out_of_range, "the " + object.name + " has no cells"};
    CellTypeList named;
    for (std::uint32_t type = 0; type < object.cellTypes.size(); ++type) {
        if (object.cellTypes[type].name == text) named.push_back(type);
    }
    if (!named.empty()) return named;
    // `text` may be another name of the solid that `object` calls by its usual name: "7-gonal prism" for "heptagonal
    // prism".
    if (const auto words = text::lowerCaseWords(text); !words.empty()) {
        const auto solid = polytopes::solidNamed(words);
        if (solid && std::holds_alternative<polytopes::SolidDescription>(*solid)) {
            const std::string name = polytopes::nameOf(std::get<polytopes::SolidDescription>(*solid));
            if (name != text) {
                if (auto types = findCellTypes(name, object)) return types;
            }
        }
    }
    const auto numbers = parseCellTypes(text);
    if (!numbers || numbers->empty()) {
        std::vector<std::string_view> known;
        for (const geometry::CellType& type : object.cellTypes) known.emplace_back(type.name);
        known.erase(std::unique(known.begin(), known.end()), known.end());
        return Error{ErrorCode::bad_expression, "the number or the name of a kind of cell is expected" +
                                                    (text.empty() ? "" : ", not " + text::inQuotes(text)) +
                                                    "; the kinds of the " + object.name + ", from 0, are " +
                                                    text::commaSeparated(known)};
    }
    if (auto valid = checkCellTypes(*numbers, object); !valid) return valid.error();
    return *numbers;
}

scene::CellTypeFilter hideCellTypes(scene::CellTypeFilter filter, const CellTypeList& changed) {
    removeCellTypes(filter.faded, changed);
    addCellTypes(filter.hidden, changed);
    return filter;
}

scene::CellTypeFilter fadeCellTypes(scene::CellTypeFilter filter, const CellTypeList& changed) {
    removeCellTypes(filter.hidden, changed);
    addCellTypes(filter.faded, changed);
    return filter;
}

scene::CellTypeFilter revealCellTypes(scene::CellTypeFilter filter, const CellTypeList& changed) {
    removeCellTypes(filter.hidden, changed);
    removeCellTypes(filter.faded, changed);
    return filter;
}

Result<std::monostate> applyCellTypeVisibility(State& state, const ChangeSettings& set) {
    for (const auto* list : {&set.hidden, &set.faded}) {
        if (!*list) continue;
        if (auto valid = checkCellTypes(**list, slicing::infoOf(state.object)); !valid) return valid;
    }
    scene::CellTypeFilter& filter = state.look.cellTypes;
    if (set.faded) {
        filter.faded.clear();
        filter = fadeCellTypes(std::move(filter), sortedUnique(*set.faded));
    }
    if (set.hidden) {
        filter.hidden.clear();
        filter = hideCellTypes(std::move(filter), sortedUnique(*set.hidden));
    }
    return std::monostate{};
}

}  // namespace oval4d::session
