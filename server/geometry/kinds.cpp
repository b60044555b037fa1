#include "geometry/kinds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include <glm/geometric.hpp>

#include "geometry/polyhedra.hpp"

namespace oval4d::geometry {

namespace {

constexpr double kCongruent = 1.0 / 500;  // of the circumradius
constexpr double kRegular = 0.01;         // of lengths in one cell

// Distances in a cell.
struct Spread {
    double least = 1e300, most = 0, squares = 0;
    int count = 0;

    void add(double value) {
        least = std::min(least, value);
        most = std::max(most, value);
        squares += value * value;
        ++count;
    }
    double mean() const { return std::sqrt(squares / count); }
    bool even() const { return most - least <= kRegular * most; }
};

struct Measures {
    std::uint32_t vertices = 0;
    Spread edges, radii;

    std::array<double, 6> values() const {
        return {edges.least, edges.mean(), edges.most, radii.least, radii.mean(), radii.most};
    }
};

// Measures cells one after the other, without searching: a vertex is the cell's own where it was marked last.
class Ruler {
  public:
    explicit Ruler(const Polytope& polytope) : p_(polytope), markOf_(polytope.vertices.size(), 0) {}

    Measures measure(std::uint32_t cell) {
        ++mark_;
        own_.clear();
        Measures result;
        glm::dvec4 sum(0);
        for (const std::uint32_t face : p_.cells[cell]) {
            const auto loop = p_.faces[face];
            for (std::size_t i = 0; i < loop.size(); ++i) {
                const glm::dvec4& v = p_.vertices[loop[i]];
                result.edges.add(glm::distance(v, p_.vertices[loop[(i + 1) % loop.size()]]));
                if (markOf_[loop[i]] == mark_) continue;
                markOf_[loop[i]] = mark_;
                own_.push_back(loop[i]);
                sum += v;
            }
        }
        result.vertices = static_cast<std::uint32_t>(own_.size());
        for (const std::uint32_t v : own_) result.radii.add(glm::distance(p_.vertices[v], sum / double(own_.size())));
        return result;
    }

  private:
    const Polytope& p_;
    std::vector<std::uint64_t> markOf_;
    std::vector<std::uint32_t> own_;
    std::uint64_t mark_ = 0;
};

// The polygon of a loop, a star by how often it turns around.
Branch polygonOf(const Polytope& p, std::span<const std::uint32_t> loop) {
    const auto n = loop.size();
    if (p.convexFaces || n < 5) return {static_cast<int>(n), 1};
    double turning = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec4 a = p.vertices[loop[(i + 1) % n]] - p.vertices[loop[i]];
        const glm::dvec4 b = p.vertices[loop[(i + 2) % n]] - p.vertices[loop[(i + 1) % n]];
        turning += std::acos(std::clamp(glm::dot(a, b) / (glm::length(a) * glm::length(b)), -1.0, 1.0));
    }
    return {static_cast<int>(n), static_cast<int>(std::lround(turning / (2 * std::numbers::pi)))};
}

// Numbers in place of any values: equal ones are the same.
template <typename Key>
class Numbering {
  public:
    std::uint32_t of(const Key& key) {
        return known_.emplace(key, static_cast<std::uint32_t>(known_.size())).first->second;
    }
    std::size_t size() const { return known_.size(); }

  private:
    std::map<Key, std::uint32_t> known_;
};

}  // namespace

std::vector<std::uint32_t> kindsByShape(const Polytope& p) {
    // What a number must agree in, and then one list of the measures seen for each.
    Numbering<std::vector<std::uint32_t>> polygons;
    Numbering<std::array<std::uint32_t, 2>> sizes;
    struct Seen {
        std::uint32_t kind;
        std::array<double, 6> values;
    };
    std::map<std::uint32_t, std::vector<Seen>> seen;
    std::vector<std::uint32_t> kinds(p.cells.size());
    std::vector<std::uint32_t> bySize(p.cells.size());
    std::uint32_t count = 0;
    Ruler ruler(p);
    for (std::uint32_t c = 0; c < p.cells.size(); ++c) {
        const Measures measures = ruler.measure(c);
        bySize[c] = sizes.of({measures.vertices, static_cast<std::uint32_t>(p.cells[c].size())});
        if (count > kMaxKinds) continue;
        std::vector<std::uint32_t> sides{measures.vertices};
        for (const std::uint32_t f : p.cells[c]) sides.push_back(static_cast<std::uint32_t>(p.faces[f].size()));
        std::sort(sides.begin() + 1, sides.end());
        auto& alike = seen[polygons.of(sides)];
        const auto values = measures.values();
        const auto same = std::find_if(alike.begin(), alike.end(), [&](const Seen& s) {
            return std::equal(values.begin(), values.end(), s.values.begin(),
                              [&](double a, double b) { return std::abs(a - b) <= kCongruent * p.circumradius; });
        });
        kinds[c] = same == alike.end() ? count++ : same->kind;
        if (same == alike.end()) alike.push_back({kinds[c], values});
    }
    if (count <= kMaxKinds) return kinds;
    if (sizes.size() <= kMaxKinds) return bySize;
    return std::vector<std::uint32_t>(p.cells.size(), 0);
}

std::vector<std::uint32_t> kindsByNeighbours(const Polytope& p, std::vector<std::uint32_t> kinds) {
    for (std::size_t told = 0;;) {
        Numbering<std::vector<std::uint32_t>> surroundings;
        std::vector<std::uint32_t> finer(kinds.size());
        for (std::uint32_t c = 0; c < p.cells.size(); ++c) {
            std::vector<std::uint32_t> key{kinds[c]};
            for (const std::uint32_t f : p.cells[c]) {
                const auto& [a, b] = p.faceCells[f];
                key.push_back(kinds[a == c ? b : a]);
            }
            std::sort(key.begin() + 1, key.end());
            finer[c] = surroundings.of(key);
        }
        if (surroundings.size() == told) return kinds;
        told = surroundings.size();
        kinds = std::move(finer);
    }
}

void numberKinds(Polytope& p, const std::vector<std::uint32_t>& kinds) {
    struct Kind {
        std::uint32_t first, cells, number;
    };
    std::map<std::uint32_t, Kind> found;
    for (std::uint32_t c = 0; c < kinds.size(); ++c) ++found.try_emplace(kinds[c], Kind{c, 0, 0}).first->second.cells;
    std::vector<Kind*> order;
    for (auto& [ignored, kind] : found) order.push_back(&kind);
    const auto rank = [&](const Kind* kind) {
        return std::tuple(kind->cells, -static_cast<std::int64_t>(p.cells[kind->first].size()), kind->first);
    };
    std::sort(order.begin(), order.end(), [&](const Kind* a, const Kind* b) { return rank(a) < rank(b); });
    p.kinds.clear();
    for (Kind* kind : order) {
        kind->number = static_cast<std::uint32_t>(p.kinds.size());
        p.kinds.push_back({nameOfCell(p, kind->first), kind->cells});
    }
    p.cellKinds.resize(kinds.size());
    for (std::uint32_t c = 0; c < kinds.size(); ++c) p.cellKinds[c] = found.at(kinds[c]).number;
}

std::string nameOfCell(const Polytope& p, std::uint32_t cell) {
    const Measures measures = Ruler(p).measure(cell);
    const auto faces = p.cells[cell];
    if (faces.size() == 4) return "tetrahedron";
    if (measures.edges.even() && measures.radii.even()) {
        Shape shape;
        shape.vertices = measures.vertices;
        shape.circumradius = 2 * measures.radii.mean() / measures.edges.mean();
        for (const std::uint32_t f : faces) ++shape.faces[polygonOf(p, p.faces[f])];
        if (std::string name = nameOf(shape, kRegular); !name.empty()) return name;
    }
    return "cell of " + std::to_string(faces.size()) + " faces";
}

}  // namespace oval4d::geometry
