#include "polytopes/import/import.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "polytopes/import/flatten.hpp"
#include "polytopes/import/hull.hpp"
#include "polytopes/import/off4.hpp"
#include "polytopes/import/polygon_soup.hpp"
#include "polytopes/import/repair.hpp"
#include "polytopes/import/rounding_estimator.hpp"
#include "text/message_text.hpp"
#include "text_files/plain_text.hpp"
#include "text_files/point_table.hpp"

namespace oval4d::polytopes {

using text_files::throwFileError;

namespace {

constexpr double kMergeDistance = 1e-7;  // vertices closer than this are merged; relative to halfDiagonal()

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

// Throws a FileError if a 2-face in the file has fewer than three different vertices. Called only if no valid polytope
// could be built: the probable reason is then that repair() has left out such a 2-face.
void checkCorners(const PolygonSoup& soup) {
    std::vector<std::uint32_t> list;
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        list.assign(soup.faces[f].begin(), soup.faces[f].end());
        std::sort(list.begin(), list.end());
        const auto different = std::unique(list.begin(), list.end()) - list.begin();
        if (different < 3) {
            throwFileError(soup.faceSourcePositions[f].line,
                           "2-face " + std::to_string(soup.faceSourcePositions[f].number) + " has only " +
                               std::to_string(different) + " different " + (different == 1 ? "vertex" : "vertices"));
        }
    }
}

// Moves the points so that the point that `centering` chooses becomes the origin, and returns this point.
glm::dvec4 moveOrigin(std::vector<glm::dvec4>& points, const geometry::Centering& centering) {
    const glm::dvec4 center = geometry::newOriginFor(centering, points);
    for (glm::dvec4& p : points) p -= center;
    return center;
}

// Makes the cells and 2-faces flat by flattenOrSplit(), and appends a warning for each kind of change. Does not warn of
// moves by at most `rounding`, or by at most 10⁻¹² of halfDiagonal(). Returns whether cells or 2-faces were divided.
bool flattenFacesAndCells(PolygonSoup& soup, double rounding, std::vector<std::string>& warnings) {
    constexpr double kTiny = 1e-12;
    const double size = halfDiagonal(soup.vertices);
    const std::size_t faces = soup.faces.size();
    const FlatteningReport done =
        flattenOrSplit(soup, size, kFlatnessTolerance * size, std::max(rounding, kTiny * size));
    if (done.moved > 0) {
        const bool one = done.moved == 1;
        warnings.push_back(
            std::to_string(done.moved) + (one ? " vertex was moved by " : " vertices were moved by up to ") +
            text::roundedDecimal(done.distance) + ", so that the vertices of each cell lie in one hyperplane");
    }
    if (soup.faces.size() == faces) return false;
    std::string divided = std::to_string(done.split) + " cells were divided into tetrahedra";
    if (done.split == 1) divided = "it was divided into tetrahedra";
    if (done.split == 0) divided = "2-faces were divided into triangles";
    warnings.push_back("cell " + std::to_string(done.leastFlatCell) + " deviates from a flat one by " +
                       text::roundedDecimal(done.deviation) +
                       ", and small moves of the vertices do not make it flat: " + divided);
    return true;
}

// A polytope, and whether some of its cells or 2-faces were divided, so that its elements are not those in the file.
struct PossiblyDividedPolytope {
    ImportedPolytope imported;
    bool divided = false;
};

PossiblyDividedPolytope repairAndBuild(const PolygonSoup& soup, double mergeDistance, const std::string& name,
                                       const geometry::Centering& centering) {
    PossiblyDividedPolytope result;
    PolygonSoup repaired = soup;
    repair(repaired, mergeDistance, result.imported.warnings);
    const double rounding = doublePrecisionErrorBound(repaired.vertices);
    const glm::dvec4 center = moveOrigin(repaired.vertices, centering);
    checkFlatnessAndDimension(repaired);
    result.divided = flattenFacesAndCells(repaired, rounding, result.imported.warnings);
    result.imported.polytope = build(std::move(repaired), name);
    result.imported.polytope.originInFile = center;
    return result;
}

PossiblyDividedPolytope buildOff4(const PolygonSoup& soup, const std::string& name,
                                  const geometry::Centering& centering) {
    checkCells(soup);
    try {
        return repairAndBuild(soup, kMergeDistance * halfDiagonal(soup.vertices), name, centering);
    } catch (const FileError&) {
        // Coinciding vertices may belong to different components of a compound: try again without merging vertices.
        try {
            return repairAndBuild(soup, -1, name, centering);
        } catch (const FileError&) {
        }
        checkCorners(soup);
        throw;
    }
}

ImportedPolytope importOff4(std::string_view text, const std::string& name, const ImportLimits& limits,
                            const geometry::Centering& centering) {
    const auto [soup, edges, shortRecord] = readOff4(text, limits.maxVertices);
    if (soup.cells.size() == 0)
        throwFileError(0, "the file lists no cells; its points can be loaded as a list of points");
    auto [result, divided] = [&soup = soup, &shortRecord = shortRecord, &name, &centering] {
        try {
            return buildOff4(soup, name, centering);
        } catch (const FileError&) {
            if (shortRecord) throw FileError(*shortRecord);
            throw;
        }
    }();
    if (edges != 0 && edges != result.polytope.edges.size() && !divided) {
        result.warnings.push_back("the file states " + std::to_string(edges) + " edges, but its 2-faces have " +
                                  std::to_string(result.polytope.edges.size()));
    }
    return std::move(result);
}

// Returns the convex hull of points, to the precision with which their coordinates are written. Coordinates that are
// all whole numbers, or have few decimals, are normally treated as exact. They are treated as rounded only if the hull
// that allows for rounding errors meets two conditions. It has no ambiguous cell pairs (see MergedHull), and it has at
// most half as many cells as the hull of the exact points. A polytope that was scaled and then rounded to whole numbers
// meets both conditions.
ConvexHull hullOf(std::span<const glm::dvec4> points, const RoundingEstimator& precision, std::size_t maxCells,
                  std::vector<std::string>& warnings) {
    // If `size` is less than kMinUnits units of the last digit, rounding by half a unit moves a vertex farther than
    // flattenFacesAndCells() could. Cells might therefore remain uneven, so the coordinates count as exact.
    constexpr double kMinUnits = 0.5 / kFlatnessTolerance;
    const double size = halfDiagonal(points);
    const glm::dvec4 rounding = precision.maxRoundingError(size), rounded = precision.roundingErrorIfRounded();
    if (!precision.hasOnlyIntegers() && rounding != glm::dvec4(0)) return convexHull(points, rounding, maxCells);
    ConvexHull exact = convexHull(points, glm::dvec4(0), maxCells), coarse;
    if (size < kMinUnits * 2 * std::max({rounded.x, rounded.y, rounded.z, rounded.w})) return exact;
    try {
        coarse = convexHull(points, rounded, maxCells);
    } catch (const FileError&) {
        return exact;
    }
    if (coarse.ambiguousCellPairs > 0 || coarse.cells.size() == exact.cells.size()) return exact;
    const bool round = 2 * coarse.cells.size() <= exact.cells.size();
    warnings.push_back(std::string("the coordinates ") +
                       (precision.hasOnlyIntegers() ? "are whole numbers" : "have few decimals") +
                       " and were treated as " + (round ? "rounded" : "exact") + ": the hull has " +
                       std::to_string(coarse.cells.size()) + " cells if they are rounded, " +
                       std::to_string(exact.cells.size()) + " if they are exact");
    return round ? std::move(coarse) : std::move(exact);
}

ImportedPolytope importPoints(std::string_view text, std::string name, const ImportLimits& limits,
                              const geometry::Centering& centering) {
    std::vector<glm::dvec4> points;
    RoundingEstimator precision;
    ImportedPolytope result;
    const auto add = [&](const text_files::PointRow& row) {
        for (int axis = 0; axis < 4; ++axis)
            precision.add(row.numbers[static_cast<std::size_t>(axis)], axis, row.point[axis]);
        points.push_back(row.point);
    };
    result.warnings = text_files::readPoints(text, {.maxPoints = limits.maxVertices}, add);
    ConvexHull hull = hullOf(points, precision, limits.maxHullCells, result.warnings);
    if (const std::size_t inside = points.size() - hull.vertices.size(); inside > 0) {
        const bool one = inside == 1;
        result.warnings.push_back(
            std::to_string(inside) + " of " + std::to_string(points.size()) + " points " +
            (one ? "is not a hull vertex and was left out" : "are not hull vertices and were left out"));
    }
    if (hull.ambiguousCellPairs > 0) {
        result.warnings.push_back("at " + std::to_string(hull.ambiguousCellPairs) + " of the hull's " +
                                  std::to_string(hull.faces.size()) +
                                  " 2-faces, the coordinates are too imprecise to tell whether the two cells lie in "
                                  "one hyperplane");
    }
    // The errors of the hull's vertices are a multiple of the rounding errors: a cell extends beyond the few points
    // that determine its hyperplane, and the errors of its vertices grow with the distance from these points.
    constexpr double kAmplification = 32, kHullError = 1e-10;
    PolygonSoup soup{std::move(hull.vertices), std::move(hull.faces), std::move(hull.cells), {}, {}};
    const double rounding = kAmplification * glm::length(hull.rounding) + kHullError * halfDiagonal(soup.vertices) +
                            doublePrecisionErrorBound(soup.vertices);
    const glm::dvec4 center = moveOrigin(soup.vertices, centering);
    flattenFacesAndCells(soup, rounding, result.warnings);
    result.polytope =
        makePolytope(std::move(name), std::move(soup.vertices), std::move(soup.faces), std::move(soup.cells));
    result.polytope.originInFile = center;
    return result;
}

}  // namespace

std::variant<ImportedPolytope, FileError> importPolytope(PolytopeFileFormat format, std::string_view text,
                                                         std::string name, const ImportLimits& limits,
                                                         const geometry::Centering& centering) {
    try {
        return importPlainText(format, text_files::decodePlainText(text), std::move(name), limits, centering);
    } catch (const FileError& error) {
        return error;
    }
}

std::variant<ImportedPolytope, FileError> importPlainText(PolytopeFileFormat format, std::string_view text,
                                                          std::string name, const ImportLimits& limits,
                                                          const geometry::Centering& centering) {
    try {
        return format == PolytopeFileFormat::off4 ? importOff4(text, name, limits, centering)
                                                  : importPoints(text, std::move(name), limits, centering);
    } catch (const FileError& error) {
        return error;
    } catch (const std::invalid_argument& unsound) {
        return FileError{0, unsound.what(), false};
    }
}

PolytopeFileFormat detectFileFormat(std::string_view text) {
    return isOffFormat(text) ? PolytopeFileFormat::off4 : PolytopeFileFormat::points;
}

}  // namespace oval4d::polytopes
