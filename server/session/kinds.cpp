#include "session/kinds.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <utility>

#include "protocol/cpp/suggest.hpp"

namespace oval4d::session {

namespace {

using protocol::Error;
using protocol::ErrorCode;
using protocol::inQuotes;
using protocol::Result;

// In order, each once.
KindList tidied(KindList list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
}

void remove(KindList& from, const KindList& kinds) {
    std::erase_if(from, [&](std::uint32_t kind) { return std::binary_search(kinds.begin(), kinds.end(), kind); });
}

void add(KindList& to, const KindList& kinds) {
    to.insert(to.end(), kinds.begin(), kinds.end());
    to = tidied(std::move(to));
}

Result<std::monostate> check(const KindList& kinds, const geometry::Polytope& polytope) {
    for (const std::uint32_t kind : kinds) {
        if (kind < polytope.kinds.size()) continue;
        const std::string which = polytope.kinds.size() == 1
                                      ? "one kind of cell, 0"
                                      : std::to_string(polytope.kinds.size()) + " kinds of cells, 0 to " +
                                            std::to_string(polytope.kinds.size() - 1);
        return Error{ErrorCode::out_of_range,
                     "the " + polytope.name + " has " + which + "; there is no " + std::to_string(kind)};
    }
    return std::monostate{};
}

}  // namespace

Result<KindList> readKinds(std::string_view text) {
    constexpr std::string_view kBetween = ", \t";
    KindList kinds;
    if (text == "none") return kinds;
    for (;;) {
        text.remove_prefix(std::min(text.find_first_not_of(kBetween), text.size()));
        if (text.empty()) break;
        const std::string_view word = text.substr(0, text.find_first_of(kBetween));
        std::uint32_t kind = 0;
        const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), kind);
        if (fault != std::errc{} || end != word.data() + word.size()) {
            return Error{ErrorCode::bad_expression,
                         inQuotes(word) + " is not the number of a kind of cell; write numbers such as 0,2"};
        }
        kinds.push_back(kind);
        text.remove_prefix(word.size());
    }
    return tidied(std::move(kinds));
}

Result<KindList> findKinds(std::string_view text, const geometry::Polytope& polytope) {
    KindList named;
    for (std::uint32_t kind = 0; kind < polytope.kinds.size(); ++kind) {
        if (polytope.kinds[kind].name == text) named.push_back(kind);
    }
    if (!named.empty()) return named;
    const auto numbers = readKinds(text);
    if (!numbers || numbers->empty()) {
        std::vector<std::string_view> known;
        for (const geometry::CellKind& kind : polytope.kinds) known.emplace_back(kind.name);
        known.erase(std::unique(known.begin(), known.end()), known.end());
        return Error{ErrorCode::bad_expression, "the number or the name of a kind of cell is expected" +
                                                    (text.empty() ? "" : ", not " + inQuotes(text)) +
                                                    "; the kinds of the " + polytope.name + ", from 0, are " +
                                                    protocol::listed(known)};
    }
    if (auto sound = check(*numbers, polytope); !sound) return sound.error();
    return *numbers;
}

scene::Kinds hide(scene::Kinds kinds, const KindList& changed) {
    remove(kinds.faded, changed);
    add(kinds.hidden, changed);
    return kinds;
}

scene::Kinds fade(scene::Kinds kinds, const KindList& changed) {
    remove(kinds.hidden, changed);
    add(kinds.faded, changed);
    return kinds;
}

scene::Kinds reveal(scene::Kinds kinds, const KindList& changed) {
    remove(kinds.hidden, changed);
    remove(kinds.faded, changed);
    return kinds;
}

Result<std::monostate> setKinds(State& state, const protocol::Set& set) {
    for (const auto* list : {&set.hidden, &set.faded}) {
        if (!*list) continue;
        if (auto sound = check(**list, *state.polytope); !sound) return sound;
    }
    scene::Kinds& kinds = state.look.kinds;
    if (set.faded) {
        kinds.faded.clear();
        kinds = fade(std::move(kinds), tidied(*set.faded));
    }
    if (set.hidden) {
        kinds.hidden.clear();
        kinds = hide(std::move(kinds), tidied(*set.hidden));
    }
    return std::monostate{};
}

}  // namespace oval4d::session
