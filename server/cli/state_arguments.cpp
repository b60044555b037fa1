#include "cli/state_arguments.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "fields/readers/field_reader.hpp"
#include "fields/readers/zarr.hpp"
#include "session/load.hpp"
#include "session/object_loader.hpp"
#include "session/settings.hpp"
#include "text/message_text.hpp"
#include "wire/parse.hpp"

namespace oval4d {

session::QueryParameters queryFromArguments(const std::vector<std::string>& words) {
    session::QueryParameters query;
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

namespace {

/// Removes the parameter `name` from the query and returns its value. Returns an empty optional if the query lacks the
/// parameter. Throws std::runtime_error if the query contains it more than once.
std::optional<std::string> takeParameter(session::QueryParameters& query, std::string_view name) {
    const auto found = std::ranges::find(query, name, &session::QueryParameters::value_type::first);
    if (found == query.end()) return {};
    std::string value = std::move(found->second);
    query.erase(found);
    if (std::ranges::find(query, name, &session::QueryParameters::value_type::first) != query.end())
        throw std::runtime_error("--" + std::string(name) + " is given twice");
    return value;
}

bool isArrayFile(const fields::FileContents& file) {
    return fields::formatOfFile(file.bytes.first(std::min(file.bytes.size(), fields::kRecognizedBytes))) != nullptr;
}

bool isZarrFolder(const std::filesystem::path& folder) {
    return std::ranges::any_of(fields::kZarrFiles,
                               [&](std::string_view file) { return std::filesystem::exists(folder / file); });
}

/// Reads the object in a file, a Zarr folder, or a folder with a series of files. Maps array files into memory, because
/// they may be larger than the main memory. Removes from `query` the options that say how to read an object of this
/// kind, for example "axes" for an array or "center" for a polytope.
Result<session::ObjectWithWarnings> readObjectTakingOptions(const std::string& path, session::QueryParameters& query) {
    const std::string fileName = std::filesystem::path(path).filename().string();
    const std::string name = session::objectNameFor(fileName, session::Limits{});
    if (name != fileName)
        std::cerr << "oval4d: " << path << ": the object is called " << text::inQuotes(name)
                  << " in pictures and files\n";
    const bool isFolder = std::filesystem::is_directory(path);
    const auto mapped = fields::FileContents::map(std::filesystem::path(path));
    if (isFolder || (mapped && isArrayFile(*mapped))) {
        fields::FieldReadOptions options{
            takeParameter(query, "axes").value_or(""), {}, takeParameter(query, "variable").value_or("")};
        if (const auto text = takeParameter(query, "box")) options.box = valueOrThrow(session::parseBox(*text));
        if (const auto text = takeParameter(query, "region"))
            options.region = valueOrThrow(session::parseBox(*text, "region"));
        const session::SecondFunctionSource second{takeParameter(query, "values").value_or(""),
                                                   takeParameter(query, "values_variable").value_or("")};
        if (!second.formula.empty() && !second.variable.empty())
            throw std::runtime_error("give either --values or --values_variable, not both");
        if (!isFolder) return session::readArray(*mapped, name, options, second);
        if (!isZarrFolder(path)) {
            const auto series = fields::seriesFiles(path);
            if (!series) return series.error();
            std::vector<fields::FileContents> files;
            for (const std::filesystem::path& each : *series) {
                auto file = fields::FileContents::map(each);
                if (!file) return file.error();
                files.push_back(std::move(*file));
            }
            session::LoadObject load{name, {}, {}};
            load.secondFormula = second.formula;
            load.secondVariable = second.variable;
            if (!files.empty()) return session::readSeries(files, load, options);
        }
        const auto open = [&](const std::string& inside,
                              const fields::FilePart& part) -> Result<std::optional<fields::FileContents>> {
            if (!std::filesystem::exists(path + '/' + inside)) return std::optional<fields::FileContents>();
            const auto file = fields::FileContents::map(std::filesystem::path(path) / inside);
            if (!file) return file.error();
            return std::optional(file->partialContents(part));
        };
        return session::readZarr(open, name, options, second);
    }
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    if (!file) throw std::runtime_error("cannot read " + path);
    session::LoadObject load{name, std::string(session::detectTextFormat(text)), text};
    if (const auto center = takeParameter(query, "center"))
        load.center = valueOrThrow(session::parseCentering(*center));
    return session::readObject(load, session::Limits{});
}

/// Returns the state in a picture made by oval4d, or in a JSON file with a `state` message. Returns an empty optional
/// for any other file. Throws std::runtime_error if the state is invalid.
std::optional<session::State> readStateIfPresent(const std::string& path, session::ObjectLoader& loader) {
    if (std::filesystem::is_directory(path)) return {};
    const auto file = fields::FileContents::map(std::filesystem::path(path));
    if (!file) return {};
    const std::string_view bytes(reinterpret_cast<const char*>(file->bytes.data()), file->bytes.size());
    if (!wire::mayContainState(bytes)) return {};
    const auto fault = [&](const Error& error) { return std::runtime_error(path + ": " + error.message); };
    const auto set = wire::setCommandFromFile(bytes);
    if (!set) throw fault(set.error());
    session::Session session;
    if (const auto done = session::apply(session, *set, session::Limits{}, loader); !done) throw fault(done.error());
    return session.current;
}

/// Returns the state in a file. If the file contains an object, returns the initial state with this object, and prints
/// warnings about the object to standard error. On failure, throws std::runtime_error with a message for the user.
session::State stateShowingFile(const std::string& path, session::QueryParameters& query,
                                session::ObjectLoader& loader) {
    if (const auto state = readStateIfPresent(path, loader)) return *state;
    if (std::ranges::find(query, session::kFormula, &session::QueryParameters::value_type::first) != query.end())
        throw std::runtime_error("a formula and another object cannot be shown at the same time");
    const auto reading = readObjectTakingOptions(path, query);
    if (!reading) throw std::runtime_error(path + ": " + reading.error().message);
    for (const std::string& warning : reading->warnings) std::cerr << "oval4d: " << path << ": " << warning << '\n';
    session::State state = session::initialState();
    valueOrThrow(session::replaceObject(state, reading->object, loader));
    return state;
}

/// An option that says how to read files of one kind; `files` is the name of this kind in error messages. The options
/// "box" and "values" are not in kReadingOptions, because they also apply to formulas.
struct OptionForOneFileKind {
    std::string_view name;
    std::string_view files;
};
constexpr auto kReadingOptions = std::to_array<OptionForOneFileKind>({
    {"axes", "arrays"},
    {"region", "arrays"},
    {"variable", "arrays"},
    {"values_variable", "arrays"},
    {"center", "polytopes, surfaces and points"},
});

/// Throws std::runtime_error if the query still contains an option that says how to read a file.
/// readObjectTakingOptions() has removed the options for the kind of file that was read, so the option is for another
/// kind.
void checkNoReadingOptionIsLeft(const session::QueryParameters& query) {
    for (const OptionForOneFileKind& option : kReadingOptions) {
        if (std::ranges::find(query, option.name, &session::QueryParameters::value_type::first) == query.end())
            continue;
        throw std::runtime_error("--" + std::string(option.name) + " is only for " + std::string(option.files) +
                                 " that --load opens");
    }
}

}  // namespace

session::State loadState(session::QueryParameters query, std::span<const std::string_view> others) {
    std::vector<std::string_view> known(others.begin(), others.end());
    known.emplace_back("load");
    for (const OptionForOneFileKind& option : kReadingOptions) known.push_back(option.name);
    polytopes::PolytopeCache cache;
    session::ObjectLoader loader(session::Limits{}, cache);
    session::State state = session::initialState();
    if (const auto path = takeParameter(query, "load")) state = stateShowingFile(*path, query, loader);
    checkNoReadingOptionIsLeft(query);
    return valueOrThrow(session::stateFromQuery(query, session::Limits{}, loader, std::move(state), known));
}

std::string stateOptionsHelp() {
    return "All other options describe the state, as for :set and the query of frame.png:\n"
           "  --polytope 24-cell --rotate xw,yz:pi/8,pi/sqrt(3)-pi/8 --slices 31 --view single --background white\n"
           "--load FILE shows a polytope or a surface from a 4OFF file, the points of a file whose first word is "
           "CLOUD,\n"
           "a field from an array (" +
           text::commaSeparated(session::arrayFormatNames()) +
           ", a Zarr folder, or a folder with one such file for each\n"
           "moment; with --axes tzyx --box X0,X1,Y0,Y1,Z0,Z1,W0,W1 --variable NAME), or the convex hull of any\n"
           "other list of points. --region, with numbers as --box, reads a part of a Zarr folder.\n"
           "--values FORMULA, or for arrays --values_variable NAME, is a second function whose values color the "
           "surfaces.\n"
           "--center object|origin|X,Y,Z,W is the point about which a polytope, a surface or points turn.\n"
           "A picture that oval4d has made, or a state as JSON, is shown again; other options change it.\n"
           "--rotate may be repeated; the rotations are applied in the order given.";
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
