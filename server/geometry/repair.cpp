#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "geometry/draft.hpp"

namespace oval4d::geometry {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

std::string counted(std::size_t count, const char* one, const char* many) {
    return std::to_string(count) + ' ' + (count == 1 ? one : many);
}

// The first point of each group of points closer than `same`, found along the axis on which they are spread.
std::vector<std::uint32_t> firstAtPlace(const std::vector<glm::dvec4>& points, double same) {
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0U);
    // A direction in general position tells apart what one coordinate does not.
    const glm::dvec4 along(0.5477, 0.4472, 0.5099, 0.4899);
    std::vector<double> place;
    for (const auto& p : points) place.push_back(glm::dot(p, along));
    std::sort(order.begin(), order.end(),
              [&](auto a, auto b) { return std::pair(place[a], a) < std::pair(place[b], b); });
    std::vector<std::uint32_t> first(points.size());
    std::iota(first.begin(), first.end(), 0U);
    for (std::size_t i = 0; i < order.size(); ++i) {
        for (std::size_t j = i + 1; j < order.size() && place[order[j]] - place[order[i]] <= same; ++j) {
            const auto [a, b] = std::minmax(order[i], order[j]);
            if (glm::distance(points[a], points[b]) <= same) first[b] = std::min(first[b], first[a]);
        }
    }
    return first;
}

// A closed walk along vertices as loops that pass no vertex twice; what runs there and back leaves nothing.
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

class Repairer {
  public:
    Repairer(Draft& draft, std::vector<std::string>& warnings) : draft_(draft), warnings_(warnings) {}

    void mergePoints(double same) {
        const auto first = firstAtPlace(draft_.vertices, same);
        std::size_t doubled = 0;
        for (std::uint32_t v = 0; v < first.size(); ++v) doubled += first[v] != v ? 1 : 0;
        if (doubled == 0) return;
        for (std::uint32_t& v : draft_.faces.items) v = first[v];
        warn(counted(doubled, "vertex stands", "vertices stand") + " where another does: taken as one");
        doubled_ = doubled;
    }

    // 2-faces become simple loops; one that comes to nothing vanishes.
    void simplifyFaces() {
        Lists faces;
        std::vector<Draft::Origin> origins;
        std::vector<std::vector<std::uint32_t>> becomes(draft_.faces.size());
        std::size_t vanished = 0, compound = 0;
        for (std::size_t f = 0; f < draft_.faces.size(); ++f) {
            auto loops = simpleLoops(draft_.faces[f]);
            vanished += loops.empty() ? 1 : 0;
            compound += loops.size() > 1 ? 1 : 0;
            for (std::size_t i = 0; i < loops.size(); ++i) {
                // The same loop walked twice is one.
                const auto same = [&](const auto& other) { return sorted(other) == sorted(loops[i]); };
                if (std::any_of(loops.begin(), loops.begin() + static_cast<std::ptrdiff_t>(i), same)) continue;
                becomes[f].push_back(static_cast<std::uint32_t>(faces.size()));
                faces.add(loops[i]);
                origins.push_back(draft_.faceOrigins[f]);
            }
        }
        if (vanished > 0) warn(counted(vanished, "2-face has", "2-faces have") + " no area: left out");
        if (compound > 0)
            warn(counted(compound, "2-face passes", "2-faces pass") + " a vertex twice: taken apart there");
        if (vanished + compound == 0 && faces.items.size() == draft_.faces.items.size()) return;
        draft_.faces = std::move(faces);
        draft_.faceOrigins = std::move(origins);
        renumberFaces(becomes);
    }

    // Where each of two cells has its own copy of the 2-face between them, the copies are one.
    void joinCopies() {
        std::vector<std::uint32_t> uses(draft_.faces.size(), 0);
        for (const std::uint32_t f : draft_.cells.items) ++uses[f];
        std::map<std::vector<std::uint32_t>, std::vector<std::uint32_t>> copies;
        for (std::uint32_t f = 0; f < draft_.faces.size(); ++f) {
            if (uses[f] == 1) copies[sorted(draft_.faces[f])].push_back(f);
        }
        std::vector<std::vector<std::uint32_t>> becomes(draft_.faces.size());
        for (std::uint32_t f = 0; f < draft_.faces.size(); ++f) becomes[f] = {f};
        for (const auto& [corners, faces] : copies) {
            if (faces.size() != 2) continue;
            becomes[faces[1]] = {faces[0]};
            ++joined_;
        }
        if (joined_ == 0) return;
        renumberFaces(becomes);
        warn(counted(joined_, "2-face is", "2-faces are") + " given once for each cell: taken as one");
    }

    // A cell of pieces that share no edge is as many cells.
    void splitCells() {
        Lists cells;
        std::vector<Draft::Origin> origins;
        std::size_t compound = 0;
        for (std::size_t c = 0; c < draft_.cells.size(); ++c) {
            const auto pieces = piecesOf(draft_.cells[c]);
            compound += pieces.size() > 1 ? 1 : 0;
            for (const auto& piece : pieces) {
                cells.add(piece);
                origins.push_back(draft_.cellOrigins[c]);
            }
        }
        if (compound == 0) return;
        draft_.cells = std::move(cells);
        draft_.cellOrigins = std::move(origins);
        warn(counted(compound, "cell is", "cells are") + " of several pieces: taken as so many cells");
    }

    void dropUnused() {
        std::vector<bool> used(draft_.faces.size(), false);
        for (const std::uint32_t f : draft_.cells.items) used[f] = true;
        const auto stray = static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
        if (stray > 0) {
            if (stray > joined_) warn(counted(stray - joined_, "2-face lies", "2-faces lie") + " in no cell: left out");
            Lists faces;
            std::vector<Draft::Origin> origins;
            std::vector<std::vector<std::uint32_t>> becomes(draft_.faces.size());
            for (std::uint32_t f = 0; f < draft_.faces.size(); ++f) {
                if (!used[f]) continue;
                becomes[f] = {static_cast<std::uint32_t>(faces.size())};
                faces.add(draft_.faces[f]);
                origins.push_back(draft_.faceOrigins[f]);
            }
            draft_.faces = std::move(faces);
            draft_.faceOrigins = std::move(origins);
            renumberFaces(becomes);
        }
        dropUnusedVertices();
    }

  private:
    void warn(std::string text) { warnings_.push_back(std::move(text)); }

    void renumberFaces(const std::vector<std::vector<std::uint32_t>>& becomes) {
        Lists cells;
        std::vector<std::uint32_t> list;
        for (std::size_t c = 0; c < draft_.cells.size(); ++c) {
            list.clear();
            for (const std::uint32_t f : draft_.cells[c]) list.insert(list.end(), becomes[f].begin(), becomes[f].end());
            cells.add(list);
        }
        draft_.cells = std::move(cells);
    }

    std::vector<std::vector<std::uint32_t>> piecesOf(std::span<const std::uint32_t> faces) const {
        std::vector<std::uint32_t> piece(faces.size());
        std::iota(piece.begin(), piece.end(), 0U);
        const auto root = [&](std::uint32_t i) {
            while (piece[i] != i) i = piece[i] = piece[piece[i]];
            return i;
        };
        std::vector<std::pair<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>> sides;
        for (std::uint32_t i = 0; i < faces.size(); ++i) {
            const auto loop = draft_.faces[faces[i]];
            for (std::size_t k = 0; k < loop.size(); ++k)
                sides.emplace_back(std::minmax(loop[k], loop[(k + 1) % loop.size()]), i);
        }
        std::sort(sides.begin(), sides.end());
        // Where pieces share an edge, more than two 2-faces meet at it: it joins nothing.
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

    // Keeps the vertices that some 2-face uses, and renumbers.
    void dropUnusedVertices() {
        std::vector<std::uint32_t> number(draft_.vertices.size(), kNone);
        for (const std::uint32_t v : draft_.faces.items) number[v] = 0;
        std::uint32_t used = 0;
        for (std::size_t v = 0; v < draft_.vertices.size(); ++v) {
            if (number[v] == kNone) continue;
            draft_.vertices[used] = draft_.vertices[v];
            number[v] = used++;
        }
        const std::size_t unused = draft_.vertices.size() - used - doubled_;
        if (unused > 0) warn(counted(unused, "vertex lies", "vertices lie") + " on no 2-face: left out");
        draft_.vertices.resize(used);
        for (std::uint32_t& v : draft_.faces.items) v = number[v];
    }

    Draft& draft_;
    std::vector<std::string>& warnings_;
    std::size_t doubled_ = 0, joined_ = 0;
};

}  // namespace

void repair(Draft& draft, double same, std::vector<std::string>& warnings) {
    Repairer repairer(draft, warnings);
    if (same >= 0) repairer.mergePoints(same);
    repairer.simplifyFaces();
    repairer.joinCopies();
    repairer.splitCells();
    repairer.dropUnused();
}

}  // namespace oval4d::geometry
