#include "polytopes/import/repair.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "geometry/index.hpp"

namespace oval4d::polytopes {

namespace {

using geometry::kNone;

std::string countWithNoun(std::size_t count, const char* one, const char* many) {
    return std::to_string(count) + ' ' + (count == 1 ? one : many);
}

// Groups points that coincide: two points are in one group if a chain of points joins them, and neighbors in the chain
// are at most `distance` apart. Returns, for each point, the point with the least index in its group. Sorts the points
// by their projections onto a line, so that only points with close projections are compared.
std::vector<std::uint32_t> clusterRepresentatives(const std::vector<glm::dvec4>& points, double distance) {
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0U);
    // The direction of this line. It is not parallel to a coordinate hyperplane or axis, so points that have some
    // coordinates in common usually have different projections.
    const glm::dvec4 along(0.5477, 0.4472, 0.5099, 0.4899);
    std::vector<double> place;
    for (const auto& p : points) place.push_back(glm::dot(p, along));
    std::sort(order.begin(), order.end(),
              [&](auto a, auto b) { return std::pair(place[a], a) < std::pair(place[b], b); });
    // A union–find structure: first[v] is the parent of v. When two groups are joined, the lesser root becomes the
    // parent, so the root of a group is the point with the least index in the group.
    std::vector<std::uint32_t> first(points.size());
    std::iota(first.begin(), first.end(), 0U);
    const auto rootOf = [&](std::uint32_t v) {
        while (first[v] != v) v = first[v] = first[first[v]];
        return v;
    };
    for (std::size_t i = 0; i < order.size(); ++i) {
        const glm::dvec4& point = points[order[i]];
        // If `point` is equal to the previous point in this order, that point has already been compared with all points
        // that follow.
        if (i > 0 && point == points[order[i - 1]]) continue;
        for (std::size_t j = i + 1; j < order.size() && place[order[j]] - place[order[i]] <= distance; ++j) {
            if (glm::distance(point, points[order[j]]) > distance) continue;
            const std::uint32_t a = rootOf(order[i]), b = rootOf(order[j]);
            first[std::max(a, b)] = std::min(a, b);
        }
    }
    for (std::uint32_t v = 0; v < first.size(); ++v) first[v] = rootOf(v);
    return first;
}

// Splits a closed walk into simple loops, which pass through no vertex twice. Loops of fewer than three vertices, such
// as an edge traversed back and forth, are dropped.
std::vector<std::vector<std::uint32_t>> simpleLoops(std::span<const std::uint32_t> walk) {
    std::vector<std::vector<std::uint32_t>> loops;
    std::vector<std::uint32_t> path;
    for (const std::uint32_t v : walk) {
        const auto before = std::find(path.begin(), path.end(), v);
        if (before != path.end()) {
            loops.emplace_back(before, path.end());
            path.erase(before, path.end());
        }
        path.push_back(v);
    }
    loops.push_back(std::move(path));
    std::erase_if(loops, [](const auto& loop) { return loop.size() < 3; });
    return loops;
}

std::vector<std::uint32_t> sorted(std::span<const std::uint32_t> list) {
    std::vector<std::uint32_t> result(list.begin(), list.end());
    std::sort(result.begin(), result.end());
    return result;
}

class PolygonSoupRepairer {
  public:
    PolygonSoupRepairer(PolygonSoup& soup, std::vector<std::string>& warnings) : soup_(soup), warnings_(warnings) {}

    // Merges vertices that are at most `distance` apart: in the 2-faces, replaces each vertex of a group by the first
    // vertex of the group (see clusterRepresentatives()).
    void mergeVertices(double distance) {
        const auto first = clusterRepresentatives(soup_.vertices, distance);
        std::size_t doubled = 0;
        for (std::uint32_t v = 0; v < first.size(); ++v) doubled += first[v] != v ? 1 : 0;
        if (doubled == 0) return;
        for (std::uint32_t& v : soup_.faces.items) v = first[v];
        warn(countWithNoun(doubled, "vertex coincides with another one and was merged with it",
                           "vertices coincide with others and were merged with them"));
        doubled_ = doubled;
    }

    // Splits 2-faces into simple loops (see simpleLoops()). Removes a 2-face if no loop of it remains.
    void simplifyFaces() {
        geometry::JaggedArray faces;
        std::vector<PolygonSoup::SourcePosition> positions;
        std::vector<std::vector<std::uint32_t>> becomes(soup_.faces.size());
        std::size_t vanished = 0, compound = 0;
        for (std::size_t f = 0; f < soup_.faces.size(); ++f) {
            auto loops = simpleLoops(soup_.faces[f]);
            vanished += loops.empty() ? 1 : 0;
            compound += loops.size() > 1 ? 1 : 0;
            for (std::size_t i = 0; i < loops.size(); ++i) {
                // A walk may traverse the same loop twice; keep the loop once.
                const auto same = [&](const auto& other) { return sorted(other) == sorted(loops[i]); };
                if (std::any_of(loops.begin(), loops.begin() + static_cast<std::ptrdiff_t>(i), same)) continue;
                becomes[f].push_back(static_cast<std::uint32_t>(faces.size()));
                faces.add(loops[i]);
                positions.push_back(soup_.faceSourcePositions[f]);
            }
        }
        if (vanished > 0)
            warn(countWithNoun(vanished, "2-face has no area and was left out",
                               "2-faces have no area and were left out"));
        if (compound > 0) {
            warn(countWithNoun(compound, "2-face passes through a vertex twice and was split there",
                               "2-faces pass through a vertex twice and were split there"));
        }
        if (vanished + compound == 0 && faces.items.size() == soup_.faces.items.size()) return;
        soup_.faces = std::move(faces);
        soup_.faceSourcePositions = std::move(positions);
        renumberFaces(becomes);
    }

    // Merges the two copies of a 2-face that the file lists twice, once for each of its cells.
    void mergeDuplicateFaces() {
        std::vector<std::uint32_t> uses(soup_.faces.size(), 0);
        for (const std::uint32_t f : soup_.cells.items) ++uses[f];
        std::map<std::vector<std::uint32_t>, std::vector<std::uint32_t>> copies;
        for (std::uint32_t f = 0; f < soup_.faces.size(); ++f) {
            if (uses[f] == 1) copies[sorted(soup_.faces[f])].push_back(f);
        }
        std::vector<std::vector<std::uint32_t>> becomes(soup_.faces.size());
        for (std::uint32_t f = 0; f < soup_.faces.size(); ++f) becomes[f] = {f};
        for (const auto& [corners, faces] : copies) {
            if (faces.size() != 2) continue;
            becomes[faces[1]] = {faces[0]};
            ++joined_;
        }
        if (joined_ == 0) return;
        renumberFaces(becomes);
        warn(countWithNoun(joined_, "2-face is", "2-faces are") +
             " given once for each of the two cells, and the copies were merged");
    }

    // Splits cells into their connected components.
    void splitCells() {
        geometry::JaggedArray cells;
        std::vector<PolygonSoup::SourcePosition> positions;
        std::size_t compound = 0;
        for (std::size_t c = 0; c < soup_.cells.size(); ++c) {
            const auto pieces = connectedComponentsOf(soup_.cells[c]);
            compound += pieces.size() > 1 ? 1 : 0;
            for (const auto& piece : pieces) {
                cells.add(piece);
                positions.push_back(soup_.cellSourcePositions[c]);
            }
        }
        if (compound == 0) return;
        soup_.cells = std::move(cells);
        soup_.cellSourcePositions = std::move(positions);
        warn(countWithNoun(compound, "cell consists of several pieces and was",
                           "cells consist of several pieces and were") +
             " split into one cell for each piece");
    }

    // Removes 2-faces in no cell and vertices on no 2-face.
    void dropUnusedFacesAndVertices() {
        std::vector<bool> used(soup_.faces.size(), false);
        for (const std::uint32_t f : soup_.cells.items) used[f] = true;
        const auto stray = static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
        if (stray > 0) {
            if (stray > joined_) {
                warn(countWithNoun(stray - joined_, "2-face lies in no cell and was left out",
                                   "2-faces lie in no cell and were left out"));
            }
            geometry::JaggedArray faces;
            std::vector<PolygonSoup::SourcePosition> positions;
            std::vector<std::vector<std::uint32_t>> becomes(soup_.faces.size());
            for (std::uint32_t f = 0; f < soup_.faces.size(); ++f) {
                if (!used[f]) continue;
                becomes[f] = {static_cast<std::uint32_t>(faces.size())};
                faces.add(soup_.faces[f]);
                positions.push_back(soup_.faceSourcePositions[f]);
            }
            soup_.faces = std::move(faces);
            soup_.faceSourcePositions = std::move(positions);
            renumberFaces(becomes);
        }
        dropUnusedVertices();
    }

  private:
    void warn(std::string text) { warnings_.push_back(std::move(text)); }

    // Replaces each 2-face f in the cells by the 2-faces becomes[f], which may be none, one or several.
    void renumberFaces(const std::vector<std::vector<std::uint32_t>>& becomes) {
        geometry::JaggedArray cells;
        std::vector<std::uint32_t> list;
        for (std::size_t c = 0; c < soup_.cells.size(); ++c) {
            list.clear();
            for (const std::uint32_t f : soup_.cells[c]) list.insert(list.end(), becomes[f].begin(), becomes[f].end());
            cells.add(list);
        }
        soup_.cells = std::move(cells);
    }

    // Returns the connected components of a cell, each as a list of 2-faces.
    std::vector<std::vector<std::uint32_t>> connectedComponentsOf(std::span<const std::uint32_t> faces) const {
        std::vector<std::uint32_t> piece(faces.size());
        std::iota(piece.begin(), piece.end(), 0U);
        const auto root = [&](std::uint32_t i) {
            while (piece[i] != i) i = piece[i] = piece[piece[i]];
            return i;
        };
        std::vector<std::pair<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>> sides;
        for (std::uint32_t i = 0; i < faces.size(); ++i) {
            const auto loop = soup_.faces[faces[i]];
            for (std::size_t k = 0; k < loop.size(); ++k)
                sides.emplace_back(std::minmax(loop[k], loop[(k + 1) % loop.size()]), i);
        }
        std::sort(sides.begin(), sides.end());
        // Two 2-faces that meet at an edge belong to the same piece. But if more than two 2-faces meet at an edge,
        // several pieces meet there, and the edge does not show which of its 2-faces belong together; such an edge is
        // skipped.
        for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
            while (end < sides.size() && sides[end].first == sides[i].first) ++end;
            if (end - i == 2) piece[root(sides[i].second)] = root(sides[i + 1].second);
        }
        std::map<std::uint32_t, std::vector<std::uint32_t>> pieces;
        for (std::uint32_t i = 0; i < faces.size(); ++i) pieces[root(i)].push_back(faces[i]);
        std::vector<std::vector<std::uint32_t>> result;
        for (auto& [ignored, list] : pieces) result.push_back(std::move(list));
        return result;
    }

    // Removes vertices on no 2-face and renumbers the others.
    void dropUnusedVertices() {
        std::vector<std::uint32_t> number(soup_.vertices.size(), kNone);
        for (const std::uint32_t v : soup_.faces.items) number[v] = 0;
        std::uint32_t used = 0;
        for (std::size_t v = 0; v < soup_.vertices.size(); ++v) {
            if (number[v] == kNone) continue;
            soup_.vertices[used] = soup_.vertices[v];
            number[v] = used++;
        }
        const std::size_t unused = soup_.vertices.size() - used - doubled_;
        if (unused > 0) {
            warn(countWithNoun(unused, "vertex lies on no 2-face and was left out",
                               "vertices lie on no 2-face and were left out"));
        }
        soup_.vertices.resize(used);
        for (std::uint32_t& v : soup_.faces.items) v = number[v];
    }

    PolygonSoup& soup_;
    std::vector<std::string>& warnings_;
    // The numbers of vertices (doubled_) and of 2-faces (joined_) that were merged into others.
    // dropUnusedFacesAndVertices() removes the merged elements, but does not count them in the warnings about unused
    // elements.
    std::size_t doubled_ = 0, joined_ = 0;
};

}  // namespace

void repair(PolygonSoup& soup, double mergeDistance, std::vector<std::string>& warnings) {
    PolygonSoupRepairer repairer(soup, warnings);
    if (mergeDistance >= 0) repairer.mergeVertices(mergeDistance);
    repairer.simplifyFaces();
    repairer.mergeDuplicateFaces();
    repairer.splitCells();
    repairer.dropUnusedFacesAndVertices();
}

}  // namespace oval4d::polytopes
