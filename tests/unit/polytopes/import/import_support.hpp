#pragma once
// Helpers shared by the tests of the import of polytopes.

#include <array>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "polytopes/import/import.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::support {

using namespace polytopes;

using Result = std::variant<Imported, FileError>;

inline Result importPoints(std::string_view text, std::size_t maxHullCells = 100'000) {
    return importPolytope(FileFormat::points, text, "p", {.maxHullCells = maxHullCells});
}

/// Returns the imported polytope. Throws std::runtime_error if the file was refused.
inline Imported sound(Result result) {
    if (const auto* error = std::get_if<FileError>(&result)) {
        throw std::runtime_error("line " + std::to_string(error->line) + ": " + error->reason);
    }
    return std::move(std::get<Imported>(result));
}

inline std::string reasonOf(const Result& result) {
    const auto* error = std::get_if<FileError>(&result);
    return error ? error->reason : "not refused";
}

/// Returns the warnings joined by "; ".
inline std::string warningsOf(const Imported& imported) {
    std::string all;
    for (const auto& warning : imported.warnings) all += (all.empty() ? "" : "; ") + warning;
    return all;
}

inline std::array<std::size_t, 4> countsOf(const Polytope& p) {
    return {p.vertices.size(), p.edges.size(), p.faces.size(), p.cellCount()};
}

/// Returns the points as text, one on each line.
inline std::string asPoints(const std::vector<glm::dvec4>& points, int digits = 17, const char* between = " ") {
    std::ostringstream out;
    out.precision(digits);
    for (const auto& v : points) out << v.x << between << v.y << between << v.z << between << v.w << '\n';
    return out.str();
}

/// Returns the vertices of a polytope in random orientation.
inline std::vector<glm::dvec4> turned(const Polytope& p, std::mt19937& random) {
    const geometry::Rotation rotation = randomRotation(random);
    std::vector<glm::dvec4> points;
    for (const auto& v : p.vertices) points.push_back(rotation(v));
    return points;
}

}  // namespace oval4d::support
