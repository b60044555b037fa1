#include "cli/state_arguments.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>

#include "session/load.hpp"
#include "session/object_loader.hpp"

namespace oval4d {

session::Query queryOf(const std::vector<std::string>& words) {
    session::Query query;
    for (auto word = words.begin(); word != words.end(); ++word) {
        if (!word->starts_with("--"))
            throw std::runtime_error("'" + *word + "' is not an option; options begin with --");
        const std::size_t equals = word->find('=');
        const std::string name = word->substr(2, equals == std::string::npos ? equals : equals - 2);
        if (equals != std::string::npos) {
            query.emplace_back(name, word->substr(equals + 1));
        } else if (++word != words.end()) {
            query.emplace_back(name, *word);
        } else {
            throw std::runtime_error("--" + name + " needs a value");
        }
    }
    return query;
}

session::State stateOf(session::Query query) {
    std::optional<slicing::Object> object;
    const auto load = std::find_if(query.begin(), query.end(), [](const auto& pair) { return pair.first == "load"; });
    if (load != query.end()) {
        const std::string path = load->second;
        query.erase(load);
        std::ifstream file(path, std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        if (!file) throw std::runtime_error("cannot read " + path);
        const auto reading = session::readObject(session::detectFormat(text), text,
                                                 std::filesystem::path(path).filename().string(), session::Limits{});
        if (!reading) throw std::runtime_error(path + ": " + reading.error().message);
        for (const std::string& warning : reading->warnings) std::cerr << "oval4d: " << path << ": " << warning << '\n';
        object = reading->object;
    }
    polytopes::PolytopeCache cache;
    session::ObjectLoader loader(session::Limits{}, cache);
    return valueOrThrow(session::stateFromQuery(query, session::Limits{}, loader, std::move(object)));
}

void writeOutput(const std::string& path, std::string_view bytes) {
    std::ofstream file;
    if (path != "-") file.open(path, std::ios::binary);
    std::ostream& out = path == "-" ? std::cout : file;
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.flush();
    if (!out) throw std::runtime_error("cannot write to " + path);
}

}  // namespace oval4d
