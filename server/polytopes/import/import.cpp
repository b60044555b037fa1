#include "polytopes/import/import.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "polytopes/import/file_tokenizer.hpp"
#include "polytopes/import/hull.hpp"
#include "polytopes/import/polygon_soup.hpp"
#include "polytopes/import/repair.hpp"
#include "polytopes/import/written_precision.hpp"

namespace oval4d::polytopes {

namespace {

constexpr double kMergeDistance = 1e-7;  // relative to the size of the polytope: vertices that are closer are merged

// The lengths of the shortest records: "0 0 0 0\n", "3 0 1 2\n", "4 0 1 2 3\n".
constexpr std::size_t kVertexBytes = 8, kFaceBytes = 8, kCellBytes = 10;

void checkCount(std::size_t count, const char* what, std::size_t most, std::size_t line) {
    if (count <= most) return;
    throw ImportError{
        line, std::to_string(count) + ' ' + what + " are too many; at most " + std::to_string(most) + " are allowed",
        true};
}

struct Counts {
    std::uint32_t vertices = 0, faces = 0, edges = 0, cells = 0;
};

Counts readCounts(FileTokenizer& file) {
    if (const auto header = file.next(); header != "4OFF") {
        throwImportError(file.line(), "the file must begin with 4OFF" +
                                          (header.empty() ? std::string{} : ", not " + inQuotes(header)));
    }
    std::vector<std::string_view> words{file.next()};
    while (words.size() < 4) {
        const auto word = file.nextOnLine();
        if (word.empty()) break;
        words.push_back(word);
    }
    if (words.size() == 3) {
        throwImportError(
            file.line(),
            "the file has three counts, as in Geomview's 4OFF format without cells; four are needed: vertices, "
            "2-faces, edges and cells. Its points can be loaded as a list of points");
    }
    while (words.size() < 4) words.push_back(file.next());
    Counts counts;
    counts.vertices = parseCount(words[0], file.line(), "a number of vertices");
    counts.faces = parseCount(words[1], file.line(), "a number of 2-faces");
    counts.edges = parseCount(words[2], file.line(), "a number of edges");
    counts.cells = parseCount(words[3], file.line(), "a number of cells");
    return counts;
}

// The name of a type of elements, in the singular and the plural.
struct Noun {
    std::string one, many;
};

// Reads `records` records into `lists`, and their positions in the file into `positions`. A record is a number n ≥
// `least`, followed by n indices that are less than `below`.
void readLists(FileTokenizer& file, std::uint32_t records, std::size_t below, std::size_t least,
               const std::string& what, const Noun& member, geometry::JaggedArray& lists,
               std::vector<PolygonSoup::SourcePosition>& positions) {
    lists.begin.reserve(std::size_t{records} + 1);
    std::vector<std::uint32_t> list;
    for (std::uint32_t i = 0; i < records; ++i) {
        file.skipLine();
        const std::string owner = what + " " + std::to_string(i);
        const auto first = file.next();
        if (first.empty())
            throwImportError(file.line(), "the file ends before " + owner + " of " + std::to_string(records));
        const std::size_t line = file.line();
        const std::uint32_t size = parseCount(first, line, "the size of " + owner);
        // A loop may pass through a vertex more than once; repair() splits it there. The limit bounds memory.
        if (size < least || size > 2 * below) {
            throwImportError(line, owner + " has " + std::to_string(size) + " " + member.many + "; " +
                                       std::to_string(least) + " to " + std::to_string(2 * below) + " are allowed");
        }
        list.clear();
        for (std::uint32_t j = 0; j < size; ++j) {
            const auto word = file.next();
            const std::uint32_t index = parseCount(word, file.line(), "the number of a " + member.one);
            if (index >= below) {
                throwImportError(file.line(), owner + " refers to " + member.one + ' ' + std::to_string(index) +
                                                  ", but the last is " + member.one + ' ' + std::to_string(below - 1));
            }
            list.push_back(index);
        }
        lists.add(list);
        positions.push_back({line, i});
    }
}

void checkCells(const PolygonSoup& soup) {
    std::vector<std::uint32_t> list;
    for (std::size_t c = 0; c < soup.cells.size(); ++c) {
        list.assign(soup.cells[c].begin(), soup.cells[c].end());
        std::sort(list.begin(), list.end());
        if (std::adjacent_find(list.begin(), list.end()) != list.end()) {
            throwImportError(
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

Imported readOff4(std::string_view text, const std::string& name, const ImportLimits& limits) {
    FileTokenizer file(text);
    const Counts counts = readCounts(file);
    checkCount(counts.vertices, "vertices", limits.maxVertices, file.line());
    if (counts.vertices * kVertexBytes + counts.faces * kFaceBytes + counts.cells * kCellBytes > text.size() + 1) {
        throwImportError(file.line(), "the file is too short for its numbers of vertices, 2-faces and cells");
    }
    PolygonSoup soup;
    soup.vertices.resize(counts.vertices);
    for (glm::dvec4& v : soup.vertices) {
        file.skipLine();
        for (int i = 0; i < 4; ++i) {
            const auto word = file.next();
            v[i] = parseCoordinate(word, file.line());
        }
    }
    readLists(file, counts.faces, counts.vertices, 3, "2-face", {"vertex", "vertices"}, soup.faces,
              soup.faceSourcePositions);
    readLists(file, counts.cells, counts.faces, 4, "cell", {"2-face", "2-faces"}, soup.cells, soup.cellSourcePositions);
    file.skipLine();
    if (const auto rest = file.next(); !rest.empty())
        throwImportError(file.line(), inQuotes(rest) + " follows the last cell");
    checkCells(soup);

    Imported result = [&] {
        try {
            return repairAndBuild(soup, kMergeDistance * halfDiagonal(soup.vertices), name);
        } catch (const ImportError&) {
            // Coinciding vertices may belong to different components of a compound: try again without merging them.
            try {
                return repairAndBuild(soup, -1, name);
            } catch (const ImportError&) {
            }
            throw;
        }
    }();
    if (counts.edges != 0 && counts.edges != result.polytope.edges.size()) {
        result.warnings.push_back("the file states " + std::to_string(counts.edges) + " edges, but its 2-faces have " +
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
    } catch (const ImportError&) {
        return exact;
    }
    if (rounded.ambiguousRidges > 0 || rounded.cells.size() == exact.cells.size()) return exact;
    const bool round = 2 * rounded.cells.size() <= exact.cells.size();
    warnings.push_back(std::string("the coordinates are whole numbers and were treated as ") +
                       (round ? "rounded" : "exact") + ": the hull has " + std::to_string(rounded.cells.size()) +
                       " cells if they are rounded, " + std::to_string(exact.cells.size()) + " if they are exact");
    return round ? std::move(rounded) : std::move(exact);
}

Imported readPoints(std::string_view text, std::string name, const ImportLimits& limits) {
    FileTokenizer file(text, true);
    std::vector<glm::dvec4> points;
    WrittenPrecision precision;
    bool first = true;
    for (auto word = file.next(); !word.empty(); word = file.next(), first = false) {
        double value = 0;
        if (first && !tryParseCoordinate(word, value)) {  // a header with the names of the columns
            file.skipLine();
            continue;
        }
        glm::dvec4 point;
        for (int i = 0; i < 4; ++i, word = file.nextOnLine()) {
            if (word.empty())
                throwImportError(file.line(), "a point has " + std::to_string(i) + " coordinates; four are needed");
            point[i] = parseCoordinate(word, file.line());
            precision.add(word, i, point[i]);
        }
        if (!word.empty()) throwImportError(file.line(), inQuotes(word) + " follows a point's four coordinates");
        points.push_back(point);
        checkCount(points.size(), "points", limits.maxVertices, file.line());
    }
    Imported result;
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

std::variant<Imported, ImportError> importPolytope(FileFormat format, std::string_view text, std::string name,
                                                   const ImportLimits& limits) {
    try {
        return format == FileFormat::off4 ? readOff4(text, name, limits) : readPoints(text, std::move(name), limits);
    } catch (const ImportError& error) {
        return error;
    } catch (const std::invalid_argument& unsound) {
        return ImportError{0, unsound.what(), false};
    }
}

FileFormat detectFileFormat(std::string_view text) {
    return FileTokenizer(text).next().ends_with("OFF") ? FileFormat::off4 : FileFormat::points;
}

}  // namespace oval4d::polytopes
