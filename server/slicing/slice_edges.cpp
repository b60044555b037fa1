#include "slicing/slice_edges.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "geometry/point_cloud.hpp"
#include "polytopes/polytope.hpp"
#include "slicing/overloaded.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

namespace {

// The position of a vertex among parallel hyperplanes: `below` is the number of hyperplanes below the vertex, and
// `upTo` the number of hyperplanes below or through the vertex.
struct HyperplanesBelowVertex {
    std::size_t below, upTo;
};

// Counts the hyperplanes below a vertex with the coordinate `w`, and those below or through this vertex. `sorted` has
// the values of planes.listed in ascending order. A vertex at a distance of at most `tolerance` from a hyperplane lies
// in the hyperplane, as in CellComplexSlicer.
HyperplanesBelowVertex countHyperplanes(const geometry::Hyperplanes& planes, std::span<const double> sorted,
                                        double tolerance, double w) {
    if (!sorted.empty()) {
        return {static_cast<std::size_t>(std::ranges::lower_bound(sorted, w - tolerance) - sorted.begin()),
                static_cast<std::size_t>(std::ranges::upper_bound(sorted, w + tolerance) - sorted.begin())};
    }
    const auto count = static_cast<double>(planes.count);
    const auto levelOf = [&](double height) { return (height - planes.offset) / planes.spacing - planes.first; };
    return {static_cast<std::size_t>(std::clamp(std::ceil(levelOf(w - tolerance)), 0.0, count)),
            static_cast<std::size_t>(std::clamp(std::floor(levelOf(w + tolerance)) + 1, 0.0, count))};
}

std::size_t countSliceEdgesIn(const geometry::CellComplex& complex, const geometry::Rotation& orientation,
                              const geometry::Hyperplanes& planes) {
    std::vector<double> sorted = planes.listed;
    std::ranges::sort(sorted);
    const glm::dmat4 turned = orientation.matrix();
    std::vector<HyperplanesBelowVertex> counts;  // one entry per vertex of the complex
    counts.reserve(complex.vertices.size());
    const double tolerance = kOnPlaneTolerance * complex.circumradius;
    for (const glm::dvec4& vertex : complex.vertices)
        counts.push_back(countHyperplanes(planes, sorted, tolerance, (turned * vertex).w));
    // Counts how often sides of 2-faces cross or touch hyperplanes. A side that several 2-faces share is counted once
    // for each of them. So each slice edge accounts for at least two of these crossings, at its ends.
    std::size_t crossings = 0;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const auto loop = complex.faces[f];
        std::uint32_t previous = loop.back();
        for (const std::uint32_t v : loop) {
            const auto [low, high] = std::minmax(counts[previous], counts[v], [](const auto& a, const auto& b) {
                return std::pair(a.below, a.upTo) < std::pair(b.below, b.upTo);
            });
            crossings += high.upTo - low.below;
            previous = v;
        }
    }
    return (crossings + 1) / 2;
}

}  // namespace

TooManySliceEdges::TooManySliceEdges(std::size_t found, std::size_t allowed)
    : std::runtime_error("these slices have " + std::to_string(found) + " edges; at most " + std::to_string(allowed) +
                         " are allowed (--max-slice-edges). Show fewer slices, or a greater spacing") {}

std::size_t sliceEdgeBound(const Object& object, const geometry::Rotation& orientation,
                           const geometry::Hyperplanes& planes) {
    return visitElements(Overloaded{[&](const geometry::CellComplex& complex) {
                                        return countSliceEdgesIn(complex, orientation, planes);
                                    },
                                    [](const geometry::PointCloud& /*cloud*/) { return std::size_t{0}; }},
                         object);
}

void checkSliceEdges(const Object& object, const geometry::Rotation& orientation, const geometry::Hyperplanes& planes,
                     std::size_t allowed) {
    const std::size_t sides =
        visitElements(Overloaded{[](const geometry::CellComplex& complex) { return complex.faces.items.size(); },
                                 [](const geometry::PointCloud& /*cloud*/) { return std::size_t{0}; }},
                      object);
    // A hyperplane crosses each side of a 2-face at most once, and each slice edge joins two such crossings. So half
    // the number of sides, times the number of hyperplanes, is an upper bound.
    if (sides * static_cast<std::size_t>(planes.count) / 2 <= allowed) return;
    const std::size_t found = sliceEdgeBound(object, orientation, planes);
    if (found > allowed) throw TooManySliceEdges(found, allowed);
}

}  // namespace oval4d::slicing
