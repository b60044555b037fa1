#include "geometry/import.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/draft.hpp"
#include "geometry/file_text.hpp"
#include "geometry/hull.hpp"

namespace oval4d::geometry {

namespace {

constexpr double kSame = 1e-7;  // of the size: points closer than this are one

// The least text that a record can take: "0 0 0 0\n", "3 0 1 2\n", "4 0 1 2 3\n".
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

Counts readCounts(FileText& file) {
    if (const auto header = file.next(); header != "4OFF") {
        refuse(file.line(),
               "the file must begin with 4OFF" + (header.empty() ? std::string{} : ", not " + shown(header)));
    }
    std::vector<std::string_view> words{file.next()};
    while (words.size() < 4) {
        const auto word = file.nextHere();
        if (word.empty()) break;
        words.push_back(word);
    }
    if (words.size() == 3) {
        refuse(file.line(),
               "three counts: this is Geomview's 4OFF, which has no cells; four are needed (vertices, 2-faces, edges, "
               "cells). Its points alone can be loaded as a list of points");
    }
    while (words.size() < 4) words.push_back(file.next());
    Counts counts;
    counts.vertices = countFrom(words[0], file.line(), "a number of vertices");
    counts.faces = countFrom(words[1], file.line(), "a number of 2-faces");
    counts.edges = countFrom(words[2], file.line(), "a number of edges");
    counts.cells = countFrom(words[3], file.line(), "a number of cells");
    return counts;
}

// Records "n i …": n indices below `below`, at least `least` of them.
void readLists(FileText& file, std::uint32_t records, std::size_t below, std::size_t least, const std::string& what,
               const std::string& of, Lists& lists, std::vector<Draft::Origin>& origins) {
    lists.begin.reserve(std::size_t{records} + 1);
    std::vector<std::uint32_t> list;
    for (std::uint32_t i = 0; i < records; ++i) {
        file.skipLine();
        const std::string owner = what + " " + std::to_string(i);
        const auto first = file.next();
        if (first.empty()) refuse(file.line(), "the file ends before " + owner + " of " + std::to_string(records));
        const std::size_t line = file.line();
        const std::uint32_t size = countFrom(first, line, "the size of " + owner);
        // A walk may pass a vertex more than once, but not without end.
        if (size < least || size > 2 * below) {
            refuse(line, owner + " has " + std::to_string(size) + " " + of + "; allowed are " + std::to_string(least) +
                             " to " + std::to_string(2 * below));
        }
        list.clear();
        for (std::uint32_t j = 0; j < size; ++j) {
            const auto word = file.next();
            const std::uint32_t index = countFrom(word, file.line(), "a number of " + of);
            if (index >= below) {
                refuse(file.line(), owner + " names number " + std::to_string(index) + " of the " + of +
                                        ", but the last is " + std::to_string(below - 1));
            }
            list.push_back(index);
        }
        lists.add(list);
        origins.push_back({line, i});
    }
}

void checkCells(const Draft& draft) {
    std::vector<std::uint32_t> list;
    for (std::size_t c = 0; c < draft.cells.size(); ++c) {
        list.assign(draft.cells[c].begin(), draft.cells[c].end());
        std::sort(list.begin(), list.end());
        if (std::adjacent_find(list.begin(), list.end()) != list.end()) {
            refuse(draft.cellOrigins[c].line,
                   "cell " + std::to_string(draft.cellOrigins[c].number) + " names one of its 2-faces twice");
        }
    }
}

Imported finish(const Draft& draft, double same, const std::string& name) {
    Imported result;
    Draft repaired = draft;
    repair(repaired, same, result.warnings);
    checkFlat(repaired);
    result.polytope = build(std::move(repaired), name);
    return result;
}

Imported readOff4(std::string_view text, const std::string& name, const ImportLimits& limits) {
    FileText file(text);
    const Counts counts = readCounts(file);
    checkCount(counts.vertices, "vertices", limits.maxVertices, file.line());
    if (counts.vertices * kVertexBytes + counts.faces * kFaceBytes + counts.cells * kCellBytes > text.size() + 1) {
        refuse(file.line(), "the counts promise more than the file holds");
    }
    Draft draft;
    draft.vertices.resize(counts.vertices);
    for (glm::dvec4& v : draft.vertices) {
        file.skipLine();
        for (int i = 0; i < 4; ++i) {
            const auto word = file.next();
            v[i] = coordinateFrom(word, file.line());
        }
    }
    readLists(file, counts.faces, counts.vertices, 3, "2-face", "vertices", draft.faces, draft.faceOrigins);
    readLists(file, counts.cells, counts.faces, 4, "cell", "2-faces", draft.cells, draft.cellOrigins);
    file.skipLine();
    if (const auto rest = file.next(); !rest.empty()) refuse(file.line(), shown(rest) + " stands after the last cell");
    checkCells(draft);

    Imported result = [&] {
        try {
            return finish(draft, kSame * sizeOf(draft), name);
        } catch (const ImportError&) {
            // Compounds may have points in one place that belong to different parts.
            try {
                return finish(draft, -1, name);
            } catch (const ImportError&) {
            }
            throw;
        }
    }();
    if (counts.edges != 0 && counts.edges != result.polytope.edges.size()) {
        result.warnings.push_back("the file says " + std::to_string(counts.edges) + " edges; its 2-faces have " +
                                  std::to_string(result.polytope.edges.size()));
    }
    return result;
}

// Digits of a number from the first that is not 0 on.
int significantDigits(std::string_view word) {
    int digits = 0;
    for (const char c : word.substr(0, word.find_first_of("eE"))) {
        if (c >= (digits == 0 ? '1' : '0') && c <= '9') ++digits;
    }
    return digits;
}

// How far rounding to so many digits may have moved a point. Few digits are taken for exact ones: 0.5, 12.
double roundingOf(double largest, int digits) {
    constexpr int kExact = 2;
    constexpr double kTilt = 4;  // four coordinates rounded each for itself, and a hyperplane tilted by that
    if (digits <= kExact || !(largest > 0)) return 0;
    return kTilt * std::pow(10.0, std::ceil(std::log10(largest)) - digits);
}

Imported readPoints(std::string_view text, std::string name, const ImportLimits& limits) {
    FileText file(text, true);
    std::vector<glm::dvec4> points;
    int digits = 0;
    double largest = 0;
    bool first = true;
    for (auto word = file.next(); !word.empty(); word = file.next(), first = false) {
        double value = 0;
        if (first && !readCoordinate(word, value)) {  // the columns' names
            file.skipLine();
            continue;
        }
        glm::dvec4 point;
        for (int i = 0; i < 4; ++i, word = file.nextHere()) {
            if (word.empty()) refuse(file.line(), "a point has " + std::to_string(i) + " coordinates; four are needed");
            point[i] = coordinateFrom(word, file.line());
            digits = std::max(digits, significantDigits(word));
            largest = std::max(largest, std::abs(point[i]));
        }
        if (!word.empty()) refuse(file.line(), shown(word) + " stands after a point's four coordinates");
        points.push_back(point);
        checkCount(points.size(), "points", limits.maxVertices, file.line());
    }
    Hull hull = convexHull(points, roundingOf(largest, digits), limits.maxHullCells);
    Imported result;
    if (const std::size_t inside = points.size() - hull.vertices.size(); inside > 0) {
        result.warnings.push_back(std::to_string(inside) + " of " + std::to_string(points.size()) +
                                  " points are no vertices of the hull: left out");
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

FileFormat formatOf(std::string_view text) {
    return FileText(text).next().ends_with("OFF") ? FileFormat::off4 : FileFormat::points;
}

}  // namespace oval4d::geometry
