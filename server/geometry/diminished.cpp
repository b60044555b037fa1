#include "geometry/diminished.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "geometry/coxeter.hpp"
#include "geometry/kinds.hpp"

namespace oval4d::geometry {

namespace {

constexpr std::uint32_t kGone = 0xffffffffU;

Polytope sixHundredCell() {
    const Diagram diagram = Diagram::linear({3, 1}, {3, 1}, {5, 1}, {true, false, false, false});
    return wythoff("600-cell", diagram, mirrorsOf(diagram));
}

// Orders edges that close a loop, as the loop's vertices.
std::vector<std::uint32_t> loopOf(const std::vector<std::array<std::uint32_t, 2>>& edges) {
    std::map<std::uint32_t, std::vector<std::uint32_t>> beside;
    for (const auto& [a, b] : edges) {
        beside[a].push_back(b);
        beside[b].push_back(a);
    }
    std::vector<std::uint32_t> loop{edges[0][0]};
    std::uint32_t next = edges[0][1];
    while (next != loop[0]) {
        const auto& both = beside.at(next);
        const std::uint32_t on = both[both[0] == loop.back() ? 1 : 0];
        loop.push_back(next);
        next = on;
    }
    return loop;
}

// The polytope of triangles and tetrahedra without some vertices, each cut off flat: a cell on its neighbours stands in
// its place, and between the cells of two that were neighbours a polygon on what they had in common.
Polytope diminished(std::string name, const Polytope& whole, const std::vector<bool>& gone) {
    std::vector<glm::dvec4> vertices;
    std::vector<std::uint32_t> newVertex(whole.vertices.size(), kGone);
    for (std::size_t v = 0; v < whole.vertices.size(); ++v) {
        if (gone[v]) continue;
        newVertex[v] = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(whole.vertices[v]);
    }
    // A triangle or tetrahedron with one vertex cut off leaves an edge or a triangle to the cell in that one's place;
    // with two, an edge to the polygon between.
    const auto rest = [&](const std::set<std::uint32_t>& corners) {
        std::pair<std::vector<std::uint32_t>, std::vector<std::uint32_t>> lostAndKept;
        for (const std::uint32_t v : corners) (gone[v] ? lostAndKept.first : lostAndKept.second).push_back(v);
        return lostAndKept;
    };
    Lists faces;
    std::vector<std::uint32_t> newFace(whole.faces.size(), kGone);
    for (std::size_t f = 0; f < whole.faces.size(); ++f) {
        std::vector<std::uint32_t> loop;
        for (const std::uint32_t v : whole.faces[f]) loop.push_back(newVertex[v]);
        if (std::count(loop.begin(), loop.end(), kGone) != 0) continue;
        newFace[f] = static_cast<std::uint32_t>(faces.size());
        faces.add(loop);
    }
    Lists cells;
    std::map<std::uint32_t, std::vector<std::uint32_t>> cellOfLost;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::array<std::uint32_t, 2>>> between;
    for (std::size_t c = 0; c < whole.cells.size(); ++c) {
        std::set<std::uint32_t> corners;
        std::vector<std::uint32_t> kept;
        for (const std::uint32_t f : whole.cells[c]) {
            corners.insert(whole.faces[f].begin(), whole.faces[f].end());
            if (newFace[f] != kGone) kept.push_back(newFace[f]);
        }
        const auto [lost, stay] = rest(corners);
        if (lost.empty()) cells.add(kept);
        if (lost.size() == 1) cellOfLost[lost[0]].push_back(kept.at(0));
        if (lost.size() == 2) between[{lost[0], lost[1]}].push_back({newVertex[stay[0]], newVertex[stay[1]]});
    }
    for (const auto& [pair, edges] : between) {
        const auto number = static_cast<std::uint32_t>(faces.size());
        faces.add(loopOf(edges));
        cellOfLost[pair.first].push_back(number);
        cellOfLost[pair.second].push_back(number);
    }
    for (const auto& [ignored, own] : cellOfLost) cells.add(own);
    Polytope p = makePolytope(std::move(name), std::move(vertices), std::move(faces), std::move(cells));
    numberKinds(p, kindsByNeighbours(p, p.cellKinds));
    return p;
}

}  // namespace

Polytope snub24Cell(std::string name) {
    // In the usual coordinates the permutations of (±2, 0, 0, 0) and all (±1, ±1, ±1, ±1) are a 24-cell's: those that
    // have no irrational coordinate.
    const Polytope whole = sixHundredCell();
    const double unit = whole.circumradius / 2;
    std::vector<bool> gone;
    for (const glm::dvec4& v : whole.vertices) {
        bool rational = true;
        for (int i = 0; i < 4; ++i) rational = rational && std::abs(v[i] / unit - std::round(v[i] / unit)) < 1e-6;
        gone.push_back(rational);
    }
    return diminished(std::move(name), whole, gone);
}

Polytope grandAntiprism(std::string name) {
    // Two neighbouring vertices span the plane of a decagon of edges; the other plane is perpendicular to both.
    const Polytope whole = sixHundredCell();
    const glm::dvec4 u = glm::normalize(whole.vertices[whole.edges[0][0]]);
    glm::dvec4 v = whole.vertices[whole.edges[0][1]];
    v = glm::normalize(v - u * glm::dot(u, v));
    std::vector<bool> gone;
    for (const glm::dvec4& x : whole.vertices) {
        const double part = std::hypot(glm::dot(x, u), glm::dot(x, v)) / whole.circumradius;
        gone.push_back(part < 1e-6 || part > 1 - 1e-6);
    }
    return diminished(std::move(name), whole, gone);
}

Polytope prismOver(std::string name, const SnubPolyhedron& base) {
    const auto n = static_cast<std::uint32_t>(base.vertices.size());
    const auto m = static_cast<std::uint32_t>(base.faces.size());
    std::vector<glm::dvec4> vertices;
    for (const double w : {-1.0, 1.0}) {
        for (const glm::dvec3& v : base.vertices) vertices.emplace_back(v, w);
    }
    Lists faces;  // the base's twice, then a square for each of its edges
    for (const std::uint32_t shift : {0U, n}) {
        for (std::size_t f = 0; f < m; ++f) {
            std::vector<std::uint32_t> loop(base.faces[f].begin(), base.faces[f].end());
            for (std::uint32_t& v : loop) v += shift;
            faces.add(loop);
        }
    }
    Lists cells;
    std::vector<std::uint32_t> bottom(m);
    std::vector<std::uint32_t> kinds;
    for (const std::uint32_t shift : {0U, m}) {
        for (std::uint32_t f = 0; f < m; ++f) bottom[f] = f + shift;
        cells.add(bottom);
        kinds.push_back(0);
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> squares;
    for (std::uint32_t f = 0; f < m; ++f) {
        const auto loop = base.faces[f];
        std::vector<std::uint32_t> own{f, f + m};
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const auto [a, b] = std::minmax(loop[i], loop[(i + 1) % loop.size()]);
            const auto [square, fresh] = squares.try_emplace({a, b}, static_cast<std::uint32_t>(faces.size()));
            if (fresh) faces.add(std::array{a, b, b + n, a + n});
            own.push_back(square->second);
        }
        cells.add(own);
        kinds.push_back(1 + base.orbits[f]);
    }
    return makePolytope(std::move(name), std::move(vertices), std::move(faces), std::move(cells), std::move(kinds));
}

}  // namespace oval4d::geometry
