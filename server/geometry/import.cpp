#include "geometry/import.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

namespace oval4d::geometry {

namespace {

constexpr double kMaxCoordinate = 1e9;
constexpr double kFlat = 5e-3;  // of the circumradius: what three decimals leave, with room
constexpr double kThin = 1e-6;  // of the size: no polytope has less extent in any direction
constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

// The least text that a record can take: "0 0 0 0\n", "3 0 1 2\n", "4 0 1 2 3\n".
constexpr std::size_t kVertexBytes = 8, kFaceBytes = 8, kCellBytes = 10;

[[noreturn]] void refuse(std::size_t line, std::string reason) { throw ImportError{line, std::move(reason)}; }

// The text as tokens between blanks; a comment runs from # to the end of its line.
class Tokens {
  public:
    explicit Tokens(std::string_view text) : text_(text) {
        constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
        if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
    }

    /// The line of the token read last.
    std::size_t line() const { return line_; }

    /// The next token, on whatever line; empty at the end.
    std::string_view next() {
        for (; at_ < text_.size(); ++at_) {
            if (text_[at_] == '#') {
                skipLine();
                if (at_ == text_.size()) break;
            }
            if (isBreak(text_[at_])) {
                ++line_;
            } else if (!isBlank(text_[at_])) {
                return word();
            }
        }
        return {};
    }

    /// The next token on the same line, or empty.
    std::string_view nextHere() {
        while (at_ < text_.size() && isBlank(text_[at_])) ++at_;
        if (at_ == text_.size() || isBreak(text_[at_]) || text_[at_] == '#') return {};
        return word();
    }

    void skipLine() {
        while (at_ < text_.size() && !isBreak(text_[at_])) ++at_;
    }

  private:
    // CR LF counts once: the CR is a blank. A lone CR, as old Macintosh files had it, is not a line end.
    static bool isBreak(char c) { return c == '\n'; }
    static bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

    std::string_view word() {
        const std::size_t start = at_;
        while (at_ < text_.size() && !isBreak(text_[at_]) && !isBlank(text_[at_]) && text_[at_] != '#') ++at_;
        return text_.substr(start, at_ - start);
    }

    std::string_view text_;
    std::size_t at_ = 0, line_ = 1;
};

std::string shown(std::string_view token) {
    constexpr std::size_t kLongest = 24;
    std::string text = "'";
    for (const char c : token.substr(0, kLongest)) text += c > ' ' && c < 0x7F ? c : '?';
    return text + (token.size() > kLongest ? "…'" : "'");
}

std::uint32_t countFrom(std::string_view token, std::size_t line, const std::string& what) {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (token.empty()) refuse(line, "the file ends where " + what + " is expected");
    if (error != std::errc{} || end != token.data() + token.size()) {
        refuse(line, shown(token) + " is not " + what);
    }
    return value;
}

double coordinateFrom(std::string_view token, std::size_t line) {
    if (token.empty()) refuse(line, "the file ends where a coordinate is expected");
    std::string_view digits = token;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool tiny = error == std::errc::result_out_of_range && digits.find("e-") != std::string_view::npos;
    if (tiny) return 0;
    if (error != std::errc{} || end != digits.data() + digits.size() || !(std::abs(value) <= kMaxCoordinate)) {
        refuse(line, shown(token) + " is not a coordinate (a number within ±1e9)");
    }
    return value;
}

struct Counts {
    std::uint32_t vertices = 0, faces = 0, cells = 0;
};

Counts readCounts(Tokens& tokens) {
    if (const auto header = tokens.next(); header != "4OFF") {
        refuse(tokens.line(),
               "the file must begin with 4OFF" + (header.empty() ? std::string{} : ", not " + shown(header)));
    }
    std::vector<std::string_view> words{tokens.next()};
    while (words.size() < 4) {
        const auto word = tokens.nextHere();
        if (word.empty()) break;
        words.push_back(word);
    }
    if (words.size() == 3) {
        refuse(tokens.line(),
               "three counts: this is Geomview's 4OFF, which has no cells; four are needed (vertices, 2-faces, edges, "
               "cells)");
    }
    while (words.size() < 4) words.push_back(tokens.next());
    Counts counts;
    counts.vertices = countFrom(words[0], tokens.line(), "a number of vertices");
    counts.faces = countFrom(words[1], tokens.line(), "a number of 2-faces");
    countFrom(words[2], tokens.line(), "a number of edges");
    counts.cells = countFrom(words[3], tokens.line(), "a number of cells");
    return counts;
}

// Records "n i …": n indices below `below`, at least `least` of them.
Lists readLists(Tokens& tokens, std::uint32_t records, std::size_t below, std::size_t least, const std::string& what,
                const std::string& of) {
    Lists lists;
    lists.begin.reserve(std::size_t{records} + 1);
    std::vector<std::uint32_t> list;
    for (std::uint32_t i = 0; i < records; ++i) {
        tokens.skipLine();
        const std::string owner = what + " " + std::to_string(i);
        const auto first = tokens.next();
        if (first.empty()) refuse(tokens.line(), "the file ends before " + owner + " of " + std::to_string(records));
        const std::uint32_t size = countFrom(first, tokens.line(), "the size of " + owner);
        if (size < least || size > below) {
            refuse(tokens.line(), owner + " has " + std::to_string(size) + " " + of + "; allowed are " +
                                      std::to_string(least) + " to " + std::to_string(below));
        }
        list.clear();
        for (std::uint32_t j = 0; j < size; ++j) {
            const auto word = tokens.next();
            const std::uint32_t index = countFrom(word, tokens.line(), "a number of " + of);
            if (index >= below) {
                refuse(tokens.line(), owner + " names number " + std::to_string(index) + " of the " + of +
                                          ", but the last is " + std::to_string(below - 1));
            }
            list.push_back(index);
        }
        lists.add(list);
        std::sort(list.begin(), list.end());
        if (std::adjacent_find(list.begin(), list.end()) != list.end()) {
            refuse(tokens.line(), owner + " names one of its " + of + " twice");
        }
    }
    return lists;
}

// How far the points are from lying in one affine subspace of this dimension (2 or 3): the largest distance from the
// one through the points that are farthest from each other.
double deviation(std::vector<glm::dvec4> points, int dimension) {
    const glm::dvec4 origin = points.front();
    for (auto& p : points) p -= origin;
    const auto shorter = [](const glm::dvec4& a, const glm::dvec4& b) { return glm::dot(a, a) < glm::dot(b, b); };
    for (int i = 0; i < dimension; ++i) {
        const glm::dvec4 longest = *std::max_element(points.begin(), points.end(), shorter);
        const double length = glm::length(longest);
        if (!(length > 0)) return 0;
        for (auto& p : points) p -= longest / length * glm::dot(p, longest / length);
    }
    return glm::length(*std::max_element(points.begin(), points.end(), shorter));
}

void checkFlat(const std::vector<glm::dvec4>& vertices, const Lists& faces, const Lists& cells) {
    glm::dvec4 low(std::numeric_limits<double>::infinity());
    glm::dvec4 high = -low;
    for (const auto& v : vertices) {
        low = glm::min(low, v);
        high = glm::max(high, v);
    }
    const double size = glm::length(high - low) / 2;
    if (faces.size() > 0 && deviation(vertices, 3) <= kThin * size) refuse(0, "all vertices lie in one hyperplane");
    std::vector<glm::dvec4> points;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        points.clear();
        for (const std::uint32_t v : faces[f]) points.push_back(vertices[v]);
        if (deviation(points, 2) > kFlat * size) refuse(0, "2-face " + std::to_string(f) + " is not flat");
    }
    for (std::size_t c = 0; c < cells.size(); ++c) {
        points.clear();
        for (const std::uint32_t f : cells[c]) {
            for (const std::uint32_t v : faces[f]) points.push_back(vertices[v]);
        }
        if (deviation(points, 3) > kFlat * size)
            refuse(0, "cell " + std::to_string(c) + " does not lie in a hyperplane");
    }
}

// Keeps the vertices that some 2-face uses, and renumbers.
void dropUnused(std::vector<glm::dvec4>& vertices, Lists& faces) {
    std::vector<std::uint32_t> number(vertices.size(), kUnused);
    for (const std::uint32_t v : faces.items) number[v] = 0;
    std::uint32_t used = 0;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        if (number[v] == kUnused) continue;
        vertices[used] = vertices[v];
        number[v] = used++;
    }
    vertices.resize(used);
    for (std::uint32_t& v : faces.items) v = number[v];
}

Polytope read(std::string_view text, std::string name, std::size_t maxVertices) {
    Tokens tokens(text);
    const Counts counts = readCounts(tokens);
    if (counts.vertices > maxVertices) {
        throw ImportError{tokens.line(),
                          std::to_string(counts.vertices) + " vertices are too many; at most " +
                              std::to_string(maxVertices) + " are allowed",
                          true};
    }
    if (counts.vertices * kVertexBytes + counts.faces * kFaceBytes + counts.cells * kCellBytes > text.size() + 1) {
        refuse(tokens.line(), "the counts promise more than the file holds");
    }
    std::vector<glm::dvec4> vertices(counts.vertices);
    for (glm::dvec4& v : vertices) {
        tokens.skipLine();
        for (int i = 0; i < 4; ++i) {
            const auto word = tokens.next();
            v[i] = coordinateFrom(word, tokens.line());
        }
    }
    Lists faces = readLists(tokens, counts.faces, vertices.size(), 3, "2-face", "vertices");
    Lists cells = readLists(tokens, counts.cells, faces.size(), 4, "cell", "2-faces");
    tokens.skipLine();
    if (const auto rest = tokens.next(); !rest.empty())
        refuse(tokens.line(), shown(rest) + " stands after the last cell");

    dropUnused(vertices, faces);
    checkFlat(vertices, faces, cells);
    return makePolytope(std::move(name), std::move(vertices), std::move(faces), std::move(cells));
}

}  // namespace

std::variant<Polytope, ImportError> importOff4(std::string_view text, std::string name, std::size_t maxVertices) {
    try {
        return read(text, std::move(name), maxVertices);
    } catch (const ImportError& error) {
        return error;
    } catch (const std::invalid_argument& unsound) {
        return ImportError{0, unsound.what(), false};
    }
}

}  // namespace oval4d::geometry
