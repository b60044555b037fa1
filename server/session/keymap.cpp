#include "session/keymap.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol_data/embedded_files.hpp"
#include "text/message_text.hpp"

namespace oval4d::session {

namespace {

bool isUpper(const std::string& key) { return key.size() == 1 && key[0] >= 'A' && key[0] <= 'Z'; }
bool isLower(const std::string& key) { return key.size() == 1 && key[0] >= 'a' && key[0] <= 'z'; }
bool isDigit(const std::string& key) { return key.size() == 1 && key[0] >= '0' && key[0] <= '9'; }

// Normalizes a key. An uppercase letter becomes the lowercase letter with Shift. Keys other than letters and digits
// lose Shift, because the character of such a key already depends on Shift.
KeyPress normalized(KeyPress key) {
    if (key.key == "Space" || key.key == "Spacebar") key.key = " ";
    if (isUpper(key.key)) {
        key.key[0] = static_cast<char>(key.key[0] - 'A' + 'a');
        key.shift = true;
    } else if (!isLower(key.key) && !isDigit(key.key)) {
        key.shift = false;
    }
    return key;
}

// A row of the key table in protocol/keymap.json.
struct KeyTableRow {
    KeyPress key;
    std::string first;  // the first key of a sequence of two keys, where `key` is the second; else empty
    KeyBinding binding{};
    bool client = false;  // whether only the client handles this key
};

std::vector<KeyTableRow> readKeyTable() {
    std::vector<KeyTableRow> table;
    const nlohmann::json keymap = nlohmann::json::parse(protocol_data::embeddedFile("keymap.json"));
    for (const nlohmann::json& row : keymap.at("keys")) {
        KeyTableRow entry;
        std::string keys = row.at("key");
        if (keys.size() == 2) {
            entry.first = keys.substr(0, 1);
            keys.erase(0, 1);
        }
        entry.key = normalized({keys, false, row.value("ctrl", false)});
        entry.client = row.value("client", false);
        if (entry.client) {
            table.push_back(entry);
            continue;
        }
        const std::string action = row.at("action");
        const auto actions = keyActions();
        const auto at = std::ranges::find(actions, action, &KeyAction::name);
        if (at == actions.end()) throw std::logic_error("keymap.json: no action is called " + action);
        entry.binding.action = &*at;
        if (row.contains("planes")) {
            entry.binding.plane = geometry::planeNamed(row.at("planes").at(0).get<std::string>()).value();
            entry.binding.isDoubleRotation = row.at("planes").size() == 2;
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

const std::vector<KeyTableRow>& keyTable() {
    static const std::vector<KeyTableRow> entries = readKeyTable();
    return entries;
}

}  // namespace

Result<std::optional<KeyBinding>> bindingOf(const KeyPress& key, std::string& pending) {
    const KeyPress wanted = normalized(key);
    bool begins = false;
    for (const KeyTableRow& entry : keyTable()) {
        const bool same =
            entry.key.key == wanted.key && entry.key.shift == wanted.shift && entry.key.ctrl == wanted.ctrl;
        if (same && entry.first == pending) {
            if (entry.client) {
                return Error{ErrorCode::unknown_key,
                             "the key " + text::inQuotes(key.key) +
                                 " is handled by the client; send command lines as a command message"};
            }
            pending.clear();
            return std::optional(entry.binding);
        }
        begins = begins || (entry.first == wanted.key && !wanted.shift && !wanted.ctrl);
    }
    // The key does not continue the sequence, so handle the key as if no sequence had begun.
    if (!pending.empty()) {
        std::string alone;
        auto binding = bindingOf(key, alone);
        if (binding) pending = std::move(alone);
        return binding;
    }
    if (begins) {
        pending = wanted.key;
        return std::optional<KeyBinding>{};
    }
    return Error{ErrorCode::unknown_key, "the key " + text::inQuotes((key.ctrl ? "Ctrl-" : "") + key.key) +
                                             " has no meaning; the key table lists all keys (get keymap)"};
}

}  // namespace oval4d::session
