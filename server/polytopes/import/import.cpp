#include "polytopes/import/import.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "polytopes/import/hull.hpp"
#include "polytopes/import/off4.hpp"
#include "polytopes/import/polygon_soup.hpp"
#include "polytopes/import/repair.hpp"
#include "polytopes/import/written_precision.hpp"
#include "text_files/plain_text.hpp"
#include "text_files/point_table.hpp"

namespace oval4d::polytopes {

using text_files::throwFileError;

namespace {

constexpr double kMergeDistance = 1e-7;  // relative to the size of the polytope: vertices that are closer are merged

void checkCells(const PolygonSoup& soup) {
    std::vector<std::uint32_t> list;
    for (std::size_t c = 0; c < soup.cells.size(); ++c) {
        list.assign(soup.cells[c].begin(), soup.cells[c].end());
        std::sort(list.begin(), list.end());
        if (std::adjacent_find(list.begin(), list.end()) != list.end()) {
            throwFileError(
                soup.cellSourcePositions[c].line,
                "cell " + std::to_string(soup.cellSourcePositions[c].number) + " lists one of its 2-faces twice");
        }
    }
}

Imported repairAndBuild(const PolygonSoup& soup, double mergeDistance, const std::string& name) {
    Imported result;
    PolygonSoup repaired = soup;
    repair(repaired, mergeDistance, result.warnings);
    checkFlat(repaired);
    result.polytope = build(std::move(repaired), name);
    return result;
}

Imported importOff4(std::string_view text, const std::string& name, const ImportLimits& limits) {
    const auto [soup, edges] = readOff4(text, limits.maxVertices);
    checkCells(soup);

    Imported result = [&soup = soup, &name] {
        try {
            return repairAndBuild(soup, kMergeDistance * halfDiagonal(soup.vertices), name);
        } catch (const FileError&) {
            // Coinciding vertices may belong to different components of a compound: try again without merging them.
            try {
                return repairAndBuild(soup, -1, name);
            } catch (const FileError&) {
            }
            throw;
        }
    }();
    if (edges != 0 && edges != result.polytope.edges.size()) {
        result.warnings.push_back("the file states " + std::to_string(edges) + " edges, but its 2-faces have " +
                                  std::to_string(result.polytope.edges.size()));
    }
    return result;
}

// Returns the convex hull of points, to the precision with which their coordinates are written. Whole numbers are
// treated as exact, unless treating them as rounded gives a hull without ambiguous ridges that has at most half as many
// cells, as for a polytope that was scaled and then rounded to whole numbers.
Hull hullOf(std::span<const glm::dvec4> points, const WrittenPrecision& precision, std::size_t maxCells,
            std::vector<std::string>& warnings) {
    const glm::dvec4 rounding = precision.maxRoundingError(halfDiagonal(points));
    if (!precision.whole() || rounding == glm::dvec4(0)) return convexHull(points, rounding, maxCells);
    Hull exact = convexHull(points, glm::dvec4(0), maxCells), rounded;
    try {
        rounded = convexHull(points, rounding, maxCells);
    } catch (const FileError&) {
        return exact;
    }
    if (rounded.ambiguousRidges > 0 || rounded.cells.size() == exact.cells.size()) return exact;
    const bool round = 2 * rounded.cells.size() <= exact.cells.size();
    warnings.push_back(std::string("the coordinates are whole numbers and were treated as ") +
                       (round ? "rounded" : "exact") + ": the hull has " + std::to_string(rounded.cells.size()) +
                       " cells if they are rounded, " + std::to_string(exact.cells.size()) + " if they are exact");
    return round ? std::move(rounded) : std::move(exact);
}

Imported importPoints(std::string_view text, std::string name, const ImportLimits& limits) {
    std::vector<glm::dvec4> points;
    WrittenPrecision precision;
    Imported result;
    const auto add = [&](const text_files::PointRow& row) {
        for (int axis = 0; axis < 4; ++axis)
            precision.add(row.numbers[static_cast<std::size_t>(axis)], axis, row.point[axis]);
        points.push_back(row.point);
    };
    result.warnings = text_files::readPoints(text, {.maxPoints = limits.maxVertices}, add);
    Hull hull = hullOf(points, precision, limits.maxHullCells, result.warnings);
    if (const std::size_t inside = points.size() - hull.vertices.size(); inside > 0) {
        const bool one = inside == 1;
        result.warnings.push_back(
            std::to_string(inside) + " of " + std::to_string(points.size()) + " points " +
            (one ? "is not a hull vertex and was left out" : "are not hull vertices and were left out"));
    }
    if (hull.ambiguousRidges > 0) {
        result.warnings.push_back("at " + std::to_string(hull.ambiguousRidges) + " of the hull's " +
                                  std::to_string(hull.faces.size()) +
                                  " 2-faces, the coordinates are too imprecise to tell whether the two cells lie in "
                                  "one hyperplane");
    }
    result.polytope =
        makePolytope(std::move(name), std::move(hull.vertices), std::move(hull.faces), std::move(hull.cells));
    return result;
}

}  // namespace

std::variant<Imported, FileError> importPolytope(FileFormat format, std::string_view text, std::string name,
                                                 const ImportLimits& limits) {
    try {
        const std::string plain = text_files::plainText(text);
        return format == FileFormat::off4 ? importOff4(plain, name, limits)
                                          : importPoints(plain, std::move(name), limits);
    } catch (const FileError& error) {
        return error;
    } catch (const std::invalid_argument& unsound) {
        return FileError{0, unsound.what(), false};
    }
}

FileFormat detectFileFormat(std::string_view text) { return isOff(text) ? FileFormat::off4 : FileFormat::points; }

}  // namespace oval4d::polytopes
