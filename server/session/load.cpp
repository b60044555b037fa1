#include "session/load.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <utility>
#include <variant>

#include "geometry/point_cloud.hpp"
#include "polytopes/catalogue/catalogue.hpp"
#include "polytopes/import/file_tokenizer.hpp"
#include "polytopes/import/import.hpp"
#include "text/message_text.hpp"

namespace oval4d::session {

namespace {

constexpr std::size_t kMaxName = 64;  // characters

bool isControl(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

bool isCloudKeyword(std::string_view word) { return text::folded(word) == "cloud"; }

Result<LoadedObject> readPolytope(polytopes::FileFormat format, std::string_view text, const std::string& name,
                                  const Limits& limits) {
    auto imported = polytopes::importPolytope(format, text, name, {limits.maxVertices, limits.maxHullCells});
    if (auto* error = std::get_if<polytopes::ImportError>(&imported)) {
        const std::string where = error->line > 0 ? "line " + std::to_string(error->line) + ": " : "";
        return Error{error->tooLarge ? ErrorCode::too_large : ErrorCode::bad_polytope, where + error->reason};
    }
    auto& [polytope, warnings] = std::get<polytopes::Imported>(imported);
    return LoadedObject{std::make_shared<const polytopes::Polytope>(std::move(polytope)), std::move(warnings)};
}

template <polytopes::FileFormat format>
Result<LoadedObject> readPolytope(std::string_view text, const std::string& name, const Limits& limits) {
    return readPolytope(format, text, name, limits);
}

// Reads a point cloud: an optional keyword CLOUD, then one point x y z w [radius] per line.
Result<LoadedObject> readCloud(std::string_view text, const std::string& name, const Limits& limits) {
    polytopes::FileTokenizer file(text, true);
    std::vector<glm::dvec4> points;
    std::vector<double> radii;
    try {
        auto word = file.next();
        if (isCloudKeyword(word)) word = file.next();
        for (; !word.empty(); word = file.next()) {
            glm::dvec4 point;
            for (int i = 0; i < 4; ++i, word = file.nextOnLine()) {
                if (word.empty())
                    polytopes::throwImportError(file.line(),
                                                "a point has " + std::to_string(i) + " coordinates; four are needed");
                point[i] = polytopes::parseCoordinate(word, file.line());
            }
            radii.push_back(word.empty() ? 0 : polytopes::parseCoordinate(word, file.line()));
            if (radii.back() < 0) polytopes::throwImportError(file.line(), "a radius is negative");
            if (!word.empty() && !(word = file.nextOnLine()).empty())
                polytopes::throwImportError(file.line(), polytopes::inQuotes(word) + " follows a point's radius");
            points.push_back(point);
            if (points.size() > limits.maxVertices)
                return Error{ErrorCode::too_large,
                             "there are more than " + std::to_string(limits.maxVertices) + " points, the most allowed"};
        }
        auto cloud = geometry::makePointCloud(name, std::move(points), std::move(radii));
        return LoadedObject{std::make_shared<const geometry::PointCloud>(std::move(cloud)), {}};
    } catch (const polytopes::ImportError& error) {
        return Error{ErrorCode::bad_polytope, "line " + std::to_string(error.line) + ": " + error.reason};
    } catch (const std::invalid_argument& invalid) {
        return Error{ErrorCode::bad_polytope, invalid.what()};
    }
}

/// A file format that `load` messages can name, and its reader.
struct FormatRow {
    std::string_view name, title;  ///< the name in messages, and the name in the texts of errors
    Result<LoadedObject> (*read)(std::string_view text, const std::string& name, const Limits& limits);
    bool buildsHull;
};
constexpr auto kFormats = std::to_array<FormatRow>({
    {"off", "off (4OFF)", readPolytope<polytopes::FileFormat::off4>, false},
    {"points", "points", readPolytope<polytopes::FileFormat::points>, true},
    {"cloud", "cloud", readCloud, false},
});

const FormatRow* formatNamed(std::string_view name) {
    const auto row = std::ranges::find(kFormats, name, &FormatRow::name);
    return row == kFormats.end() ? nullptr : &*row;
}

Error unsupported(std::string_view format) {
    std::string allowed;
    for (const FormatRow& row : kFormats) {
        if (!allowed.empty()) allowed += ", ";
        allowed += row.title;
    }
    return {ErrorCode::unsupported_format,
            "the format " + text::inQuotes(format) + " cannot be read; allowed formats: " + allowed};
}

}  // namespace

Result<LoadedObject> readObject(std::string_view format, std::string_view text, const std::string& name,
                                const Limits& limits) {
    const FormatRow* row = formatNamed(format);
    return row == nullptr ? Result<LoadedObject>(unsupported(format)) : row->read(text, name, limits);
}

std::string_view detectFormat(std::string_view text) {
    if (polytopes::detectFileFormat(text) == polytopes::FileFormat::off4) return "off";
    return isCloudKeyword(polytopes::FileTokenizer(text).next()) ? "cloud" : "points";
}

std::optional<Error> checkLoad(const Load& load, const Limits& limits) {
    if (load.name.empty() || load.name.size() > 4 * kMaxName || std::ranges::any_of(load.name, isControl))
        return Error{ErrorCode::bad_message, "a polytope's name must have 1 to 64 printable characters"};
    if (std::holds_alternative<polytopes::Design>(polytopes::designNamed(load.name, limits.maxVertices))) {
        return Error{ErrorCode::bad_polytope,
                     text::inQuotes(load.name) + " is a name of the catalogue; choose another"};
    }
    if (formatNamed(load.format) == nullptr) return unsupported(load.format);
    return {};
}

bool buildsHull(std::string_view format) {
    const FormatRow* row = formatNamed(format);
    return row != nullptr && row->buildsHull;
}

}  // namespace oval4d::session
