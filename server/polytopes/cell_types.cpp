#include "polytopes/cell_types.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include <glm/geometric.hpp>

#include "polytopes/cell_shapes.hpp"
#include "polytopes/construction/polyhedra.hpp"

namespace oval4d::polytopes {

namespace {

// The tolerance when lengths in two cells are compared, in units of maxDistanceFromMean() of the polytope.
constexpr double kCongruenceTolerance = 1.0 / 500;
constexpr double kRegularityTolerance = 0.01;  // the tolerance when lengths in the same cell are compared, relative to
                                               // the greatest of these lengths

// The least, the root-mean-square and the greatest of the lengths that were added.
struct LengthStatistics {
    double least = 1e300, most = 0, squares = 0;
    int count = 0;

    void add(double value) {
        least = std::min(least, value);
        most = std::max(most, value);
        squares += value * value;
        ++count;
    }
    double rootMeanSquare() const { return std::sqrt(squares / count); }
    bool areEqual() const { return most - least <= kRegularityTolerance * most; }
};

// Measurements of a cell that do not depend on its position. The measurements are equal for congruent cells.
struct CellInvariants {
    std::uint32_t vertices = 0;
    LengthStatistics edges, radii;  // edges: their lengths; radii: the distances of the vertices from their mean

    std::array<double, 6> values() const {
        return {edges.least, edges.rootMeanSquare(), edges.most, radii.least, radii.rootMeanSquare(), radii.most};
    }
};

// Measures cells. Measuring all cells takes time linear in the size of the polytope: measure() marks each vertex that
// it visits with a number, which is different for each cell. So the mark of a vertex shows, without a search, whether
// the current cell has already visited the vertex.
class CellMeasurer {
  public:
    explicit CellMeasurer(const Polytope& polytope) : p_(polytope), markOf_(polytope.vertices.size(), 0) {}

    CellInvariants measure(std::uint32_t cell) {
        ++mark_;
        own_.clear();
        CellInvariants result;
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

// Returns the regular polygon {n/d} for a loop of n vertices that makes d full turns. The caller must ensure that
// the loop is regular.
RegularPolygon regularPolygonOf(const Polytope& p, std::span<const std::uint32_t> loop) {
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

// Assigns consecutive numbers to distinct keys, in the order of their first appearance.
template <typename Key>
class DistinctKeyNumbering {
  public:
    std::uint32_t numberOf(const Key& key) {
        return known_.emplace(key, static_cast<std::uint32_t>(known_.size())).first->second;
    }
    std::size_t size() const { return known_.size(); }

  private:
    std::map<Key, std::uint32_t> known_;
};

}  // namespace

std::vector<std::uint32_t> cellTypesByShape(const Polytope& p) {
    // `polygons` numbers the combinations of a cell's vertex count and the side counts of its 2-faces; `seen` lists
    // the types found for each of these numbers. `sizes` numbers the combinations of a vertex count and a 2-face
    // count, for the coarser classification (see kMaxCellTypes).
    DistinctKeyNumbering<std::vector<std::uint32_t>> polygons;
    DistinctKeyNumbering<std::array<std::uint32_t, 2>> sizes;
    struct KnownCellType {
        std::uint32_t type;
        std::array<double, 6> values;
    };
    std::map<std::uint32_t, std::vector<KnownCellType>> seen;
    std::vector<std::uint32_t> types(p.cells.size());
    std::vector<std::uint32_t> bySize(p.cells.size());
    std::uint32_t count = 0;
    CellMeasurer measurer(p);
    const double tolerance = kCongruenceTolerance * maxDistanceFromMean(p);
    for (std::uint32_t c = 0; c < p.cells.size(); ++c) {
        const CellInvariants measures = measurer.measure(c);
        bySize[c] = sizes.numberOf({measures.vertices, static_cast<std::uint32_t>(p.cells[c].size())});
        if (count > kMaxCellTypes) continue;
        std::vector<std::uint32_t> sides{measures.vertices};
        for (const std::uint32_t f : p.cells[c]) sides.push_back(static_cast<std::uint32_t>(p.faces[f].size()));
        std::sort(sides.begin() + 1, sides.end());
        auto& alike = seen[polygons.numberOf(sides)];
        const auto values = measures.values();
        const auto same = std::find_if(alike.begin(), alike.end(), [&](const KnownCellType& s) {
            return std::equal(values.begin(), values.end(), s.values.begin(),
                              [&](double a, double b) { return std::abs(a - b) <= tolerance; });
        });
        types[c] = same == alike.end() ? count++ : same->type;
        if (same == alike.end()) alike.push_back({types[c], values});
    }
    if (count <= kMaxCellTypes) return types;
    if (sizes.size() <= kMaxCellTypes) return bySize;
    return std::vector<std::uint32_t>(p.cells.size(), 0);
}

std::vector<std::uint32_t> cellTypesByNeighbors(const Polytope& p, std::vector<std::uint32_t> types) {
    for (std::size_t count = 0;;) {
        DistinctKeyNumbering<std::vector<std::uint32_t>> surroundings;
        std::vector<std::uint32_t> finer(types.size());
        for (std::uint32_t c = 0; c < p.cells.size(); ++c) {
            std::vector<std::uint32_t> key{types[c]};
            for (const std::uint32_t f : p.cells[c]) {
                const auto& [a, b] = p.faceCells[f];
                key.push_back(types[a == c ? b : a]);
            }
            std::sort(key.begin() + 1, key.end());
            finer[c] = surroundings.numberOf(key);
        }
        if (surroundings.size() == count) return types;
        count = surroundings.size();
        types = std::move(finer);
    }
}

void numberCellTypes(Polytope& p, const std::vector<std::uint32_t>& labels) {
    struct CellTypeGroup {
        std::uint32_t first, cells, number;
    };
    std::map<std::uint32_t, CellTypeGroup> groups;
    for (std::uint32_t c = 0; c < labels.size(); ++c)
        ++groups.try_emplace(labels[c], CellTypeGroup{c, 0, 0}).first->second.cells;
    std::vector<CellTypeGroup*> order;
    for (auto& [ignored, group] : groups) order.push_back(&group);
    const auto rank = [&](const CellTypeGroup* group) {
        return std::tuple(group->cells, -static_cast<std::int64_t>(p.cells[group->first].size()), group->first);
    };
    std::sort(order.begin(), order.end(),
              [&](const CellTypeGroup* a, const CellTypeGroup* b) { return rank(a) < rank(b); });
    p.cellTypes.clear();
    for (CellTypeGroup* group : order) {
        group->number = static_cast<std::uint32_t>(p.cellTypes.size());
        p.cellTypes.push_back({nameOfCell(p, group->first), group->cells});
    }
    p.typeOfCell.resize(labels.size());
    for (std::uint32_t c = 0; c < labels.size(); ++c) p.typeOfCell[c] = groups.at(labels[c]).number;
}

std::string nameOfCell(const Polytope& p, std::uint32_t cell) {
    const CellInvariants measures = CellMeasurer(p).measure(cell);
    const auto faces = p.cells[cell];
    if (faces.size() == 4) return "tetrahedron";
    if (measures.edges.areEqual() && measures.radii.areEqual()) {
        PolyhedronSignature shape;
        shape.vertices = measures.vertices;
        shape.circumradius = 2 * measures.radii.rootMeanSquare() / measures.edges.rootMeanSquare();
        for (const std::uint32_t f : faces) ++shape.faces[regularPolygonOf(p, p.faces[f])];
        if (std::string name = nameOf(shape, kRegularityTolerance); !name.empty()) return name;
    }
    if (std::string name = nameOfIrregularCell(p, cell); !name.empty()) return name;
    return "cell of " + std::to_string(faces.size()) + " faces";
}

}  // namespace oval4d::polytopes
