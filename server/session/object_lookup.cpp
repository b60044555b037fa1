#include "session/object_lookup.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "polytopes/catalogue/catalogue.hpp"
#include "session/example_fields.hpp"
#include "text/message_text.hpp"
#include "text/words.hpp"

namespace oval4d::session {

namespace {

// Returns "; did you mean …?" with the most similar names in the catalogue. Prefers an example field or a loaded object
// whose name is at least as similar. Returns an empty string if no name is similar.
std::string suggestion(std::string_view name, const LoadedObjects& loaded) {
    name = name.substr(0, polytopes::kMaxNameBytes);
    std::vector<std::string_view> near = polytopes::equallyNearestNames(name);
    std::size_t least =
        near.empty() ? text::normalizedName(name).size() / 3 : polytopes::editDistanceOfNames(name, near.front());
    const auto consider = [&](std::string_view own) {
        if (polytopes::editDistanceOfNames(name, own) > least) return;
        least = polytopes::editDistanceOfNames(name, own);
        near = {own};
    };
    for (const ExampleField& example : exampleFields()) {
        consider(example.name);
        for (const std::string& alias : example.aliases) consider(alias);
    }
    for (const auto& [own, ignored] : loaded) consider(own);
    std::string text;
    for (std::size_t i = 0; i < near.size(); ++i) {
        text += i == 0 ? "; did you mean " : i + 1 < near.size() ? ", " : " or ";
        text += text::inQuotes(near[i]);
    }
    return near.empty() ? "" : text + "?";
}

}  // namespace

std::optional<slicing::Object> findLoadedOrExample(std::string_view name, const LoadedObjects& loaded) {
    if (const auto own = loaded.find(name); own != loaded.end()) return own->second;
    if (const ExampleField* example = exampleNamed(name)) return slicing::Object(example->field);
    return {};
}

Result<slicing::Object> findObject(std::string_view name, const LoadedObjects& loaded, const Limits& limits,
                                   ObjectLoader& loader) {
    if (const auto present = findLoadedOrExample(name, loaded)) return *present;
    auto named = polytopes::designNamed(name, limits.maxVertices);
    if (const auto* design = std::get_if<polytopes::PolytopeDesign>(&named)) {
        auto built = loader.polytopeOf(*design);
        if (built || built.error().code != ErrorCode::unknown_polytope) return built;
        named = polytopes::PolytopeNameError{polytopes::PolytopeNameError::Reason::impossible, built.error().message};
    }
    const auto& error = std::get<polytopes::PolytopeNameError>(named);
    if (error.reason == polytopes::PolytopeNameError::Reason::too_large)
        return Error{ErrorCode::too_large, error.message};
    return Error{ErrorCode::unknown_polytope,
                 "no polytope is called " + text::inQuotes(name) +
                     (error.message.empty() ? suggestion(name, loaded) : ": " + error.message)};
}

Result<slicing::Object> neighborInObjectList(const slicing::Object& object, int by, const LoadedObjects& loaded,
                                             ObjectLoader& loader) {
    std::vector<slicing::Object> own;
    for (const ExampleField& example : exampleFields()) {
        if (!loaded.contains(example.name)) own.emplace_back(example.field);
    }
    const int examples = static_cast<int>(own.size());
    for (const auto& [name, each] : loaded) own.push_back(each);
    const auto entries = polytopes::catalogue();
    const int named = static_cast<int>(entries.size());
    const int all = named + static_cast<int>(own.size());
    const auto at = std::ranges::find(own, object);
    const auto entry = std::ranges::find(entries, slicing::infoOf(object).name, &polytopes::CatalogueEntry::name);
    int i = by > 0 ? -1 : named + examples;
    if (at != own.end()) {
        i = named + static_cast<int>(at - own.begin());
    } else if (entry != entries.end()) {
        i = static_cast<int>(entry - entries.begin());
    }
    i = (i + by + all) % all;
    return i < named ? loader.polytopeOf(entries[i].design) : Result<slicing::Object>(own[i - named]);
}

}  // namespace oval4d::session
