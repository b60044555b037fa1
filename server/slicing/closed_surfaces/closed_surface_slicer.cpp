#include "slicing/closed_surfaces/closed_surface_slicer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

namespace oval4d::slicing {

namespace {

// Returns a bit mask in which bit i is set if values[i] fulfills `condition`.
template <typename Values, typename Condition>
unsigned bitmaskWhere(const Values& values, Condition condition) {
    unsigned bits = 0;
    for (std::size_t i = 0; i < values.size(); ++i) bits |= static_cast<unsigned>(condition(values[i])) << i;
    return bits;
}

// Even permutations of the four corners of a tetrahedron. kWithFirst[i] begins with corner i. kWithFirstTwo contains,
// for each unordered pair of corners, a permutation that begins with this pair.
using CornerPermutation = std::array<std::uint8_t, 4>;
constexpr std::array<CornerPermutation, 4> kWithFirst{{{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 0, 1, 3}, {3, 0, 2, 1}}};
constexpr std::array<CornerPermutation, 6> kWithFirstTwo{
    {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};

}  // namespace

Result<std::monostate> ClosedSurfaceSlicer::slice(double w, const IsosurfaceOptions& options, ClosedSurface& out) {
    out.clear();
    out_ = &out;
    options_ = options;
    sign_ = options.inside == fields::BodySide::below ? 1 : -1;
    level_ = sign_ * options.level;
    status_ = ExtractionStatus::working;
    numbers_.clear();
    caps_.clear();
    w = movedIntoDomain(w);
    for (std::size_t axis = 0; axis < 4; ++axis) {
        heights_[axis].clear();
        for (int i = 0; i < lattice_.pointCounts()[static_cast<int>(axis)]; ++i)
            heights_[axis].push_back(lattice_.positionTerm(axis, i).w - (axis == 0 ? w : 0));
    }
    cutRange({glm::ivec4(0), lattice_.pointCounts() - 1});
    if (status_ == ExtractionStatus::stopped) return Error{ErrorCode::too_large, "the exact slice was stopped"};
    if (status_ == ExtractionStatus::too_large) {
        return Error{ErrorCode::too_large, "the surface of an exact slice has more than the allowed " +
                                               std::to_string(options.maxTriangles) + " triangles"};
    }
    out.firstCap = out.triangles.size();
    out.triangles.insert(out.triangles.end(), caps_.begin(), caps_.end());
    if (options.pointData) out.gradients.resize(out.points.size(), glm::dvec4(0));
    return std::monostate{};
}

// Returns `w` or, if the hyperplane at `w` contains a facet of the domain, a value just inside the domain. A hyperplane
// through the lower facet would have no lattice points below it, because points in the hyperplane count as above it. A
// hyperplane through the upper facet might have no lattice points in or above it, because w is rounded.
double ClosedSurfaceSlicer::movedIntoDomain(double w) const {
    constexpr double kNear = 1e-9, kParallel = 1e-12;  // tolerances, relative to the extent of the domain along w
    double least = 0, greatest = 0;
    std::array<double, 4> extents{};  // per side of the domain: its extent along w
    for (std::size_t axis = 0; axis < 4; ++axis) {
        const int last = lattice_.pointCounts()[static_cast<int>(axis)] - 1;
        const auto [low, high] = std::minmax({lattice_.positionTerm(axis, 0).w, lattice_.positionTerm(axis, last).w});
        least += low;
        greatest += high;
        extents[axis] = high - low;
    }
    const double extent = greatest - least, nearby = kNear * extent;
    const auto tilted = std::ranges::count_if(extents, [&](double each) { return each > kParallel * extent; });
    if (tilted > 1) return w;  // the hyperplane contains no facet
    if (std::abs(w - least) <= nearby) return least + nearby;
    return std::abs(w - greatest) <= nearby ? greatest - nearby : w;
}

// Cuts the lattice cells of `range`, unless the surface cannot meet the range. Divides the range in two again and
// again, until each part has at most kBrick cells along each axis.
void ClosedSurfaceSlicer::cutRange(const LatticeCellBox& range) {
    if (status_ != ExtractionStatus::working || !meetsHyperplane(range)) return;
    constexpr std::size_t kVisitsPerQuestion = 16;
    if (++visits_ % kVisitsPerQuestion == 0 && options_.mustStop && options_.mustStop()) {
        status_ = ExtractionStatus::stopped;
        return;
    }
    const fields::ValueBounds bounds = lattice_.valueBounds(range.first, range.end);
    if (bounds.min > bounds.max) return;  // the function has no value in the range
    if (!bounds.mayCross(sign_ * level_)) {
        const bool inside = sign_ > 0 ? bounds.max < level_ : -bounds.min < level_;
        if (!inside || !touchesBoundary(range)) return;
    }
    const glm::ivec4 size = range.end - range.first;
    int axis = 0;
    for (int other = 1; other < 4; ++other) axis = size[other] > size[axis] ? other : axis;
    if (size[axis] <= kBrick) return cutBrick(range);
    const int middle = range.first[axis] + (size[axis] / 2 + kBrick - 1) / kBrick * kBrick;
    LatticeCellBox lower = range, upper = range;
    lower.end[axis] = upper.first[axis] = middle;
    cutRange(lower);
    cutRange(upper);
}

// Returns whether the range has at least one lattice point below the hyperplane, and at least one in or above it. The
// height of a lattice point above the hyperplane is the sum of four terms, one for each axis. So the least height is
// the sum of the four least terms in the range, and the greatest height is the sum of the four greatest terms. All sums
// add their terms in the same order. So they bound all heights in the range even after rounding, because a rounded sum
// is monotone in each term.
bool ClosedSurfaceSlicer::meetsHyperplane(const LatticeCellBox& range) const {
    std::array<double, 4> low{}, high{};
    for (std::size_t axis = 0; axis < 4; ++axis) {
        const double first = heights_[axis][static_cast<std::size_t>(range.first[static_cast<int>(axis)])];
        const double last = heights_[axis][static_cast<std::size_t>(range.end[static_cast<int>(axis)])];
        std::tie(low[axis], high[axis]) = std::minmax(first, last);
    }
    return (low[0] + low[1]) + (low[2] + low[3]) < 0 && (high[0] + high[1]) + (high[2] + high[3]) >= 0;
}

bool ClosedSurfaceSlicer::touchesBoundary(const LatticeCellBox& range) const {
    return glm::any(glm::equal(range.first, glm::ivec4(0))) ||
           glm::any(glm::equal(range.end, lattice_.pointCounts() - 1));
}

double ClosedSurfaceSlicer::signedValueOrNan(float sample) const {
    return std::isfinite(sample) ? sign_ * static_cast<double>(sample) : std::numeric_limits<double>::quiet_NaN();
}

void ClosedSurfaceSlicer::cutBrick(const LatticeCellBox& range) {
    std::array<float, kBrickPoints> samples{};
    const glm::ivec4 size = range.end - range.first, points = size + 1;
    const glm::u64vec4 n(points);
    lattice_.sample(range.first, range.end, std::span(samples).first(n.x * n.y * n.z * n.w));
    glm::ivec4 c;  // a cell of the brick
    for (c.w = 0; c.w < size.w; ++c.w) {
        for (c.z = 0; c.z < size.z; ++c.z) {
            for (c.y = 0; c.y < size.y; ++c.y) {
                for (c.x = 0; c.x < size.x; ++c.x) {
                    const glm::ivec4 cell = range.first + c;
                    if (status_ != ExtractionStatus::working || !meetsHyperplane({cell, cell + 1})) continue;
                    std::array<double, 16> heights{}, values{};
                    for (unsigned corner = 0; corner < 16; ++corner) {
                        const glm::ivec4 step(corner & 1U, corner >> 1U & 1U, corner >> 2U & 1U, corner >> 3U);
                        const glm::ivec4 p = c + step, at = cell + step;
                        const auto height = [&](std::size_t axis) {
                            return heights_[axis][static_cast<std::size_t>(at[static_cast<int>(axis)])];
                        };
                        heights[corner] = (height(0) + height(1)) + (height(2) + height(3));
                        const int index = p.x + points.x * (p.y + points.y * (p.z + points.z * p.w));
                        values[corner] = signedValueOrNan(samples[static_cast<std::size_t>(index)]);
                    }
                    cutCell(cell, heights, values);
                }
            }
        }
    }
}

void ClosedSurfaceSlicer::cutCell(glm::ivec4 cell, const std::array<double, 16>& heights,
                                  const std::array<double, 16>& values) {
    const unsigned inside = bitmaskWhere(values, [&](double value) { return value < level_; });
    if (inside == 0) return;
    const bool atBoundary = touchesBoundary({cell, cell + 1});
    if (inside == 0xffffU && !atBoundary) return;
    const glm::ivec4 last = lattice_.pointCounts() - 2;
    CutPentatope cut{};
    cut.cell = cell;
    for (const Pentatope& shape : kuhnPentatopes()) {
        for (std::size_t i = 0; i < 5; ++i) {
            cut.heights[i] = heights[shape.corners[i]];
            cut.values[i] = values[shape.corners[i]];
        }
        const unsigned above = bitmaskWhere(cut.heights, [](double height) { return height >= 0; });
        if (above == 0 || above == 31U) continue;
        cut.shape = &shape;
        cut.positive = shape.positive == lattice_.isPositivelyOriented();
        const unsigned holes = bitmaskWhere(cut.values, [](double value) { return std::isnan(value); });
        if (holes != 0) {
            if (std::has_single_bit(holes)) {
                findCrossings(cut, above);
                addCapAtNanCorner(cut, above, static_cast<std::size_t>(std::countr_zero(holes)));
            }
            continue;
        }
        // `upper` and `lower` mark the facets of the pentatope on the boundary of the domain: bit i stands for the
        // facet opposite to corner i. Only two facets can lie on the boundary: the facet opposite to corner 0, at the
        // upper end of the cell along one axis, and the facet opposite to corner 4, at its lower end along another
        // axis. The other facets cross the interior of the cell.
        const unsigned upper = cell[shape.axisToNextCorner(0)] == last[shape.axisToNextCorner(0)] ? 1U : 0U;
        const unsigned lower = cell[shape.axisToNextCorner(3)] == 0 ? 1U << 4U : 0U;
        const unsigned within = bitmaskWhere(cut.values, [&](double value) { return value < level_; });
        if (within == 0 || (within == 31U && (upper | lower) == 0)) continue;
        findCrossings(cut, above);
        cutPentatope(cut, above, upper | lower);
    }
    if (out_->triangles.size() + caps_.size() > options_.maxTriangles) status_ = ExtractionStatus::too_large;
}

// Sets `cut.crossings`: the points where the hyperplane crosses the edges of the pentatope. Pentatopes that share an
// edge compute its crossing from the same numbers. The value at the crossing is clamped to the range between the values
// at the ends of the edge. Therefore, in spite of rounding, no crossing is inside the body if both ends are outside,
// and no crossing is outside if both ends are inside.
void ClosedSurfaceSlicer::findCrossings(CutPentatope& cut, unsigned above) const {
    for (std::size_t i = 0; i < 5; ++i) {
        for (std::size_t j = i + 1; j < 5; ++j) {
            if ((above >> i & 1U) == (above >> j & 1U)) continue;
            PentatopeEdgeCrossing& crossing = cut.crossings[i][j];
            crossing.t = cut.heights[i] / (cut.heights[i] - cut.heights[j]);
            const double a = cut.values[i], b = cut.values[j];
            const double value = a + (b - a) * crossing.t;
            crossing.value = std::clamp(value, std::min(a, b), std::max(a, b));
            crossing.inside = crossing.value < level_;
        }
    }
}

// Adds the level set and the caps in a pentatope. Bit i of `above` is set if corner i lies in or above the hyperplane.
// Bit i of `boundaryFacets` is set if the facet opposite to corner i lies on the boundary of the domain.
void ClosedSurfaceSlicer::cutPentatope(const CutPentatope& cut, unsigned above, unsigned boundaryFacets) {
    const std::size_t first = out_->triangles.size();
    for (const SectionTetrahedron& tetrahedron : pentatopeSection(above, cut.positive)) {
        const unsigned inside = bitmaskWhere(
            tetrahedron.edges, [&](const PentatopeEdge& edge) { return cut.crossings[edge[0]][edge[1]].inside; });
        if (inside == 0) continue;
        addLevelSet(cut, tetrahedron, inside);
        for (std::size_t face = 0; face < 4; ++face) {
            const std::uint8_t facet = tetrahedron.facets[face];
            if (facet != SectionTetrahedron::kInner && (boundaryFacets >> facet & 1U) != 0)
                addCap(cut, tetrahedron, face, false);
        }
    }
    if (options_.pointData && first < out_->triangles.size()) addGradients(cut, first);
}

// Adds a cap in one facet of a pentatope (4-simplex) of which only corner `hole` has no value: the facet opposite to
// this corner. The pentatope is a hole. The cap closes the body in the neighboring pentatope that shares the facet.
// Adds nothing if that pentatope is outside the domain or also has a corner without a value. Bit i of `above` is set if
// corner i lies in or above the hyperplane.
void ClosedSurfaceSlicer::addCapAtNanCorner(const CutPentatope& cut, unsigned above, std::size_t hole) {
    const glm::ivec4 other = cut.cell + cut.shape->cornerAcrossFacet(hole);
    if (glm::any(glm::lessThan(other, glm::ivec4(0))) || glm::any(glm::greaterThanEqual(other, lattice_.pointCounts())))
        return;
    if (std::isnan(signedValueOrNan(lattice_.sample(other)))) return;
    for (const SectionTetrahedron& tetrahedron : pentatopeSection(above, cut.positive)) {
        for (std::size_t face = 0; face < 4; ++face) {
            if (tetrahedron.facets[face] == hole) addCap(cut, tetrahedron, face, true);
        }
    }
}

// Adds the level set in a tetrahedron. Bit i of `inside` is set if corner i of the tetrahedron is inside the body. If
// one or three of the four corners are inside the body, the level set is a triangle. If two corners are inside, it is a
// quadrilateral. If all corners or none are inside, the level set is empty.
void ClosedSurfaceSlicer::addLevelSet(const CutPentatope& cut, const SectionTetrahedron& tetrahedron, unsigned inside) {
    const auto& edges = tetrahedron.edges;
    const auto between = [&](std::uint8_t a, std::uint8_t b) { return findOrAddPointBetween(cut, edges[a], edges[b]); };
    const int count = std::popcount(inside);
    if (count == 1) {
        const auto [i, j, k, l] = kWithFirst[static_cast<std::size_t>(std::countr_zero(inside))];
        out_->triangles.push_back({between(i, j), between(i, k), between(i, l)});
    } else if (count == 3) {
        const auto [o, j, k, l] = kWithFirst[static_cast<std::size_t>(std::countr_zero(~inside))];
        out_->triangles.push_back({between(j, o), between(l, o), between(k, o)});
    } else if (count == 2) {
        const auto order = std::ranges::find_if(
            kWithFirstTwo, [&](const CornerPermutation& o) { return inside == (1U << o[0] | 1U << o[1]); });
        const auto [i, j, k, l] = *order;
        const std::array<std::uint32_t, 4> loop{between(i, k), between(i, l), between(j, l), between(j, k)};
        out_->triangles.push_back({loop[0], loop[1], loop[2]});
        out_->triangles.push_back({loop[0], loop[2], loop[3]});
    }
}

// Adds the gradient of the interpolated function, which is constant in a pentatope, to out_->gradients. The triangles
// of the level set in this pentatope are those with the indices `first`, first + 1, …. Each of them adds the gradient
// at its three corners, multiplied by its area or, if the area is less than kLeastWeight, by kLeastWeight. So the sum
// is not 0 even at a point whose triangles all have the area 0.
void ClosedSurfaceSlicer::addGradients(const CutPentatope& cut, std::size_t first) {
    constexpr double kLeastWeight = 1e-100;
    std::array<double, 4> rises{};  // per axis of the lattice: how much the value rises per cell
    for (std::size_t i = 0; i < 4; ++i) {
        rises[static_cast<std::size_t>(cut.shape->axisToNextCorner(i))] = sign_ * (cut.values[i + 1] - cut.values[i]);
    }
    const glm::dvec4 gradient = lattice_.gradientOf(rises);
    out_->gradients.resize(out_->points.size(), glm::dvec4(0));
    for (std::size_t t = first; t < out_->triangles.size(); ++t) {
        const auto& [a, b, c] = out_->triangles[t];
        const glm::dvec3& from = out_->points[a];
        const double area = glm::length(glm::cross(out_->points[b] - from, out_->points[c] - from)) / 2;
        for (const std::uint32_t corner : out_->triangles[t])
            out_->gradients[corner] += std::max(area, kLeastWeight) * gradient;
    }
}

// Adds a cap: the part of a tetrahedron's face that is inside the body. The corners of the face are those of
// kTetrahedronFaces[face]. If `reversed` is true, the cap has the opposite orientation of the face.
void ClosedSurfaceSlicer::addCap(const CutPentatope& cut, const SectionTetrahedron& tetrahedron, std::size_t face,
                                 bool reversed) {
    std::array<std::uint8_t, 3> corners = kTetrahedronFaces[face];
    if (reversed) std::swap(corners[1], corners[2]);
    std::array<std::uint32_t, 4> loop{};
    std::size_t size = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const PentatopeEdge& from = tetrahedron.edges[corners[i]];
        const PentatopeEdge& to = tetrahedron.edges[corners[(i + 1) % 3]];
        const bool fromInside = cut.crossings[from[0]][from[1]].inside, toInside = cut.crossings[to[0]][to[1]].inside;
        if (fromInside) loop[size++] = findOrAddPointOn(cut, from);
        if (fromInside != toInside)
            loop[size++] = fromInside ? findOrAddPointBetween(cut, from, to) : findOrAddPointBetween(cut, to, from);
    }
    for (std::size_t i = 2; i < size; ++i) caps_.push_back({loop[0], loop[i - 1], loop[i]});
}

// Returns the index of the surface point where the hyperplane crosses an edge of the pentatope. Adds the point if it is
// new.
std::uint32_t ClosedSurfaceSlicer::findOrAddPointOn(const CutPentatope& cut, const PentatopeEdge& edge) {
    const auto [number, isNew] = numbers_.findOrAdd(simplexKeyOf(cut, 1U << edge[0] | 1U << edge[1]));
    if (isNew) {
        out_->points.push_back(crossingPosition(cut, edge));
        if (options_.pointData)
            out_->values.push_back(static_cast<float>(sign_ * cut.crossings[edge[0]][edge[1]].value));
    }
    return number;
}

// Returns the index of the surface point where the level set crosses the line segment between two points of the
// hyperplane: its crossing with the edge `inner`, which must be inside the body, and its crossing with the edge
// `outer`, which must be outside. Adds the surface point if it is new.
std::uint32_t ClosedSurfaceSlicer::findOrAddPointBetween(const CutPentatope& cut, const PentatopeEdge& inner,
                                                         const PentatopeEdge& outer) {
    const unsigned corners = 1U << inner[0] | 1U << inner[1] | 1U << outer[0] | 1U << outer[1];
    const auto [number, isNew] = numbers_.findOrAdd(simplexKeyOf(cut, corners));
    if (isNew) {
        const double from = cut.crossings[inner[0]][inner[1]].value, to = cut.crossings[outer[0]][outer[1]].value;
        out_->points.push_back(glm::mix(crossingPosition(cut, inner), crossingPosition(cut, outer),
                                        std::clamp((level_ - from) / (to - from), 0.0, 1.0)));
        if (options_.pointData) out_->values.push_back(static_cast<float>(options_.level));
    }
    return number;
}

glm::dvec3 ClosedSurfaceSlicer::crossingPosition(const CutPentatope& cut, const PentatopeEdge& edge) const {
    const auto corner = [&](std::size_t i) {
        const unsigned bits = cut.shape->corners[i];
        return glm::dvec3(
            lattice_.position(cut.cell + glm::ivec4(bits & 1U, bits >> 1U & 1U, bits >> 2U & 1U, bits >> 3U)));
    };
    return glm::mix(corner(edge[0]), corner(edge[1]), cut.crossings[edge[0]][edge[1]].t);
}

// Returns a key that identifies a simplex of the lattice: the one whose corners are the corners i of the pentatope for
// which bit i of `corners` is set. The key contains the lattice index of the simplex's first corner. For each other
// corner, it contains the axes along which this corner lies above the first.
std::uint64_t ClosedSurfaceSlicer::simplexKeyOf(const CutPentatope& cut, unsigned corners) const {
    const auto& chain = cut.shape->corners;
    const unsigned first = chain[static_cast<std::size_t>(std::countr_zero(corners))];
    std::uint64_t key =
        lattice_.index(cut.cell + glm::ivec4(first & 1U, first >> 1U & 1U, first >> 2U & 1U, first >> 3U));
    for (unsigned rest = corners & (corners - 1); rest != 0; rest &= rest - 1)
        key = key << 4U | (chain[static_cast<std::size_t>(std::countr_zero(rest))] ^ first);
    // A simplex has two to four corners. The shift makes the keys of simplices with different numbers of corners
    // differ.
    return key << (4 * static_cast<unsigned>(4 - std::popcount(corners)));
}

}  // namespace oval4d::slicing
