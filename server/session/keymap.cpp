#include "session/keymap.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/cpp/embedded.hpp"
#include "protocol/cpp/suggest.hpp"

namespace oval4d::session {

namespace {

using protocol::Error;
using protocol::ErrorCode;
using protocol::Key;
using protocol::Result;

constexpr auto kActionNames = std::to_array<std::string_view>(
    {"rotate",         "alpha_up",     "alpha_down",  "beta_up",       "beta_down",
     "focus_right",    "focus_left",   "focus_zero",  "focus_first",   "focus_last",
     "undo",           "redo",         "repeat",      "turn",          "spacing_smaller",
     "spacing_larger", "slices_fewer", "slices_more", "polytope_next", "polytope_previous",
     "view",           "coordinates",  "faces",       "bars",          "balls"});
static_assert(kActionNames.size() == static_cast<std::size_t>(Action::balls) + 1);

bool isUpper(const std::string& key) { return key.size() == 1 && key[0] >= 'A' && key[0] <= 'Z'; }
bool isLower(const std::string& key) { return key.size() == 1 && key[0] >= 'a' && key[0] <= 'z'; }
bool isDigit(const std::string& key) { return key.size() == 1 && key[0] >= '0' && key[0] <= '9'; }

// An upper-case letter is Shift and the letter; Shift means nothing with other characters, which it has already made.
Key normal(Key key) {
    if (key.key == "Space" || key.key == "Spacebar") key.key = " ";
    if (isUpper(key.key)) {
        key.key[0] = static_cast<char>(key.key[0] - 'A' + 'a');
        key.shift = true;
    } else if (!isLower(key.key) && !isDigit(key.key)) {
        key.shift = false;
    }
    return key;
}

struct Entry {
    Key key;
    std::string first;  // of a sequence of two keys, the first
    Binding binding{};
    bool client = false;
};

std::vector<Entry> readTable() {
    std::vector<Entry> table;
    const nlohmann::json keymap = nlohmann::json::parse(protocol::embedded("keymap.json"));
    for (const nlohmann::json& row : keymap.at("keys")) {
        Entry entry;
        std::string keys = row.at("key");
        if (keys.size() == 2) {
            entry.first = keys.substr(0, 1);
            keys.erase(0, 1);
        }
        entry.key = normal({keys, false, row.value("ctrl", false)});
        entry.client = row.value("client", false);
        if (entry.client) {
            table.push_back(entry);
            continue;
        }
        const std::string action = row.at("action");
        const auto at = std::find(kActionNames.begin(), kActionNames.end(), action);
        if (at == kActionNames.end()) throw std::logic_error("keymap.json: no action is called " + action);
        entry.binding.action = static_cast<Action>(at - kActionNames.begin());
        if (row.contains("planes")) {
            entry.binding.plane = geometry::planeNamed(row.at("planes").at(0).get<std::string>()).value();
            entry.binding.doubled = row.at("planes").size() == 2;
        }
        table.push_back(entry);
        if (row.contains("shift")) {
            entry.key.shift = true;
            entry.binding.inverse = true;
            table.push_back(entry);
        }
    }
    return table;
}

const std::vector<Entry>& table() {
    static const std::vector<Entry> entries = readTable();
    return entries;
}

}  // namespace

Result<std::optional<Binding>> bindingOf(const Key& key, std::string& pending) {
    const Key wanted = normal(key);
    bool begins = false;
    for (const Entry& entry : table()) {
        const bool same =
            entry.key.key == wanted.key && entry.key.shift == wanted.shift && entry.key.ctrl == wanted.ctrl;
        if (same && entry.first == pending) {
            if (entry.client) {
                return Error{ErrorCode::unknown_key, "the key " + protocol::inQuotes(key.key) +
                                                         " is for the client alone; lines go in a command message"};
            }
            pending.clear();
            return std::optional(entry.binding);
        }
        begins = begins || (entry.first == wanted.key && !wanted.shift && !wanted.ctrl);
    }
    if (!pending.empty()) {  // not the sequence that had begun: the key stands alone
        std::string alone;
        auto binding = bindingOf(key, alone);
        if (binding) pending = std::move(alone);
        return binding;
    }
    if (begins) {
        pending = wanted.key;
        return std::optional<Binding>{};
    }
    return Error{ErrorCode::unknown_key, "the key " + protocol::inQuotes((key.ctrl ? "Ctrl-" : "") + key.key) +
                                             " has no meaning; the key table lists all (get keymap)"};
}

}  // namespace oval4d::session
