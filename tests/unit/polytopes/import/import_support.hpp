#pragma once
// Helpers shared by the tests of the import of polytopes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <glm/vec4.hpp>

#include "polytopes/import/import.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::support {

using namespace polytopes;

using Result = std::variant<ImportedPolytope, FileError>;

inline Result importPoints(std::string_view text, std::size_t maxHullCells = 100'000) {
    return importPolytope(PolytopeFileFormat::points, text, "p", {.maxHullCells = maxHullCells});
}

inline Result importOff4(std::string_view text, std::size_t maxVertices = 100'000) {
    return importPolytope(PolytopeFileFormat::off4, text, "p", {.maxVertices = maxVertices});
}

/// Returns the imported polytope. Throws std::runtime_error if the file was not accepted.
inline ImportedPolytope sound(Result result) {
    if (const auto* error = std::get_if<FileError>(&result)) {
        throw std::runtime_error("line " + std::to_string(error->line) + ": " + error->reason);
    }
    return std::move(std::get<ImportedPolytope>(result));
}

inline std::string reasonOf(const Result& result) {
    const auto* error = std::get_if<FileError>(&result);
    return error ? error->reason : "not refused";
}

/// Returns the warnings joined by "; ".
inline std::string warningsOf(const ImportedPolytope& imported) {
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

/// Returns the points as text, one on each line. `format` is a printf format with a precision argument, such as "%.*f".
inline std::string formatted(const std::vector<glm::dvec4>& points, const char* format, int digits) {
    std::string text;
    for (const auto& p : points) {
        for (int i = 0; i < 4; ++i) {
            char number[64];
            std::snprintf(number, sizeof number, format, digits, p[i]);
            text += std::string(number) + (i == 3 ? '\n' : ' ');
        }
    }
    return text;
}

/// Returns the vertices of a polytope after a random rotation.
inline std::vector<glm::dvec4> turned(const Polytope& p, std::mt19937& random) {
    const geometry::Rotation rotation = randomRotation(random);
    std::vector<glm::dvec4> points;
    for (const auto& v : p.vertices) points.push_back(rotation(v));
    return points;
}

/// The names of the convex regular polytopes.
inline constexpr std::array kRegular{"5-cell", "8-cell", "16-cell", "24-cell", "120-cell", "600-cell"};

/// Returns the vertices of a regular polytope of circumradius 1 after a random rotation.
inline std::vector<glm::dvec4> turnedToSize1(const char* name, std::mt19937& random) {
    std::vector<glm::dvec4> points = turned(named(name), random);
    for (auto& p : points) p /= named(name).circumradius;
    return points;
}

/// The vertices, 2-faces and cells of a 4OFF file, as lists that tests may make invalid.
struct Lines {
    std::vector<glm::dvec4> vertices;
    std::vector<std::vector<std::uint32_t>> faces, cells;

    explicit Lines(const Polytope& p) : vertices(p.vertices) {
        for (std::size_t f = 0; f < p.faces.size(); ++f) faces.emplace_back(p.faces[f].begin(), p.faces[f].end());
        for (std::size_t c = 0; c < p.cells.size(); ++c) cells.emplace_back(p.cells[c].begin(), p.cells[c].end());
    }

    /// Adds the elements of another polytope, translated by `by`.
    void add(const Lines& other, const glm::dvec4& by = {}) {
        const auto v0 = static_cast<std::uint32_t>(vertices.size());
        const auto f0 = static_cast<std::uint32_t>(faces.size());
        for (const auto& v : other.vertices) vertices.push_back(v + by);
        for (auto face : other.faces) {
            for (auto& v : face) v += v0;
            faces.push_back(face);
        }
        for (auto cell : other.cells) {
            for (auto& f : cell) f += f0;
            cells.push_back(cell);
        }
    }

    std::string text(int edges = 0) const {
        std::ostringstream out;
        out << "4OFF\n" << vertices.size() << ' ' << faces.size() << ' ' << edges << ' ' << cells.size() << '\n';
        out << asPoints(vertices);
        for (const auto* lists : {&faces, &cells}) {
            for (const auto& list : *lists) {
                out << list.size();
                for (const auto item : list) out << ' ' << item;
                out << '\n';
            }
        }
        return out.str();
    }
};

}  // namespace oval4d::support
