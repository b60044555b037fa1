#include "polytopes/import/hull.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <new>
#include <numeric>
#include <random>
#include <string>
#include <utility>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include "geometry/point_index.hpp"
#include "polytopes/import/convex_distance.hpp"
#include "polytopes/import/coplanar_merge.hpp"
#include "polytopes/import/hull_frame.hpp"
#include "text_files/file_error.hpp"

namespace oval4d::polytopes {

using text_files::FileError;
using text_files::throwFileError;

namespace {

constexpr int kDimensions = 4;
constexpr std::size_t kFirstSample = 256;        // the number of points in the first sample of the input
constexpr double kPerturbation = 1e-11;          // the first amplitude of the perturbation, in the coordinates of
                                                 // HullFrame
constexpr std::size_t kMaxSimplicesPerCell = 4;  // the maximum number of simplices of a hull, as a multiple of maxCells
constexpr int kMaxRounds = 4;                // the maximum number of rounds; each removes points that are no vertices
constexpr std::size_t kMessageBytes = 4096;  // the size of the stream that takes and discards Qhull's messages

using Points = std::vector<glm::dvec4>;

// A run of Qhull on randomly perturbed ("joggled") points. The perturbation makes all facets of the hull simplices, so
// that Qhull need not merge facets: a four-dimensional hull for which Qhull merges facets may not be closed.
class QhullRun {
  public:
    /// Runs Qhull. `perturbation` is the initial amplitude. Qhull increases the amplitude if it is too small;
    /// perturbation() returns the final one.
    QhullRun(std::span<const glm::dvec4> points, double perturbation) {
        for (const glm::dvec4& p : points) {
            for (int k = 0; k < kDimensions; ++k) coordinates_.push_back(p[k]);
        }
        qh_zero(&state_, sink_);
        char command[64];
        std::snprintf(command, sizeof command, "qhull QJ%.3g Pp", perturbation);
        status_ = qh_new_qhull(&state_, kDimensions, static_cast<int>(points.size()), coordinates_.data(), False,
                               command, nullptr, sink_);
    }
    QhullRun(const QhullRun&) = delete;
    QhullRun& operator=(const QhullRun&) = delete;
    ~QhullRun() {
        int kept = 0, total = 0;
        qh_freeqhull(&state_, !qh_ALL);
        qh_memfreeshort(&state_, &kept, &total);
        if (sink_ != stderr) std::fclose(sink_);
    }

    int status() const { return status_; }
    std::size_t facetCount() const { return static_cast<std::size_t>(state_.num_facets); }
    double perturbation() const { return state_.JOGGLEmax; }

    /// Returns the facets of the hull, each with its vertices in ascending order.
    std::vector<SimplexFacet> simplices() {
        qhT* const qh = &state_;
        facetT* facet = nullptr;
        std::vector<std::uint32_t> number(qh->facet_id, 0);
        std::uint32_t next = 0;
        FORALLfacets { number[facet->id] = next++; }
        std::vector<SimplexFacet> all;
        FORALLfacets {
            // Neighbor i of a simplicial facet lies opposite its vertex i.
            std::array<std::pair<std::uint32_t, std::uint32_t>, kDimensions> corners;
            for (int i = 0; i < kDimensions; ++i) {
                const auto* vertex = SETelemt_(facet->vertices, i, vertexT);
                const auto* neighbor = SETelemt_(facet->neighbors, i, facetT);
                corners.at(i) = {static_cast<std::uint32_t>(qh_pointid(qh, vertex->point)), number[neighbor->id]};
            }
            std::sort(corners.begin(), corners.end());
            SimplexFacet& simplex = all.emplace_back();
            for (int i = 0; i < kDimensions; ++i)
                std::tie(simplex.vertices.at(i), simplex.neighbors.at(i)) = corners.at(i);
        }
        return all;
    }

  private:
    static std::FILE* openMessageSink() {
        std::FILE* const memory = fmemopen(nullptr, kMessageBytes, "w");
        return memory != nullptr ? memory : stderr;
    }

    std::vector<double> coordinates_;
    std::FILE* const sink_ = openMessageSink();
    qhT state_{};
    int status_ = 0;
};

[[noreturn]] void throwQhullFailure(int status) {
    if (status == qh_ERRsingular) throwFileError(0, "all points lie in one hyperplane");
    if (status == qh_ERRprec || status == qh_ERRwide || status == qh_ERRtopology)
        throwFileError(0, "the convex hull cannot be determined at the precision of the points; give more decimals");
    throwFileError(0, "the convex hull of the points cannot be computed (Qhull status " + std::to_string(status) + ')');
}

[[noreturn]] void throwHullTooLarge(std::size_t maxCells) {
    throw FileError{0, "the hull has more than " + std::to_string(maxCells) + " cells, the maximum allowed", true};
}

// Returns the simplices of the hull of the points, and passes the amplitude of Qhull's perturbation to
// frame.allowForPerturbation(). First computes the hulls of samples of increasing size, because the number of simplices
// can grow with the square of the number of points. If the hull of a sample is too large, throws a FileError before
// memory is exhausted.
std::vector<SimplexFacet> simplicialHull(const Points& points, HullFrame& frame, std::size_t maxCells) {
    double perturbation = kPerturbation;
    for (std::size_t count = std::min(kFirstSample, points.size());; count = std::min(2 * count, points.size())) {
        QhullRun run(std::span<const glm::dvec4>(points).first(count), perturbation);
        const bool all = count == points.size();
        if (run.status() == qh_ERRmem) throw std::bad_alloc();
        // Ignore a failed run on a sample, because the sample may be flat although the set of all points is not.
        if (run.status() != 0 && all) throwQhullFailure(run.status());
        if (run.status() != 0) continue;
        perturbation = run.perturbation();
        if (run.facetCount() > kMaxSimplicesPerCell * maxCells) {
            throw FileError{0,
                            "the hull has more than " + std::to_string(kMaxSimplicesPerCell * maxCells) +
                                " simplices, the maximum allowed before those in one hyperplane are merged into cells",
                            true};
        }
        if (!all && run.facetCount() <= maxCells) continue;
        frame.allowForPerturbation(perturbation);
        auto simplices = run.simplices();
        if (all) return simplices;
        if (mergeCoplanar(simplices, points, frame).cells.size() > maxCells) throwHullTooLarge(maxCells);
    }
}

// Returns, for each point, its neighbors: the points that share an edge of a simplex with it. The list of a point that
// is not on the hull is empty.
std::vector<std::vector<std::uint32_t>> neighborsByPoint(std::span<const SimplexFacet> simplices, std::size_t points) {
    std::vector<std::vector<std::uint32_t>> links(points);
    for (const SimplexFacet& simplex : simplices) {
        for (const std::uint32_t v : simplex.vertices) {
            for (const std::uint32_t w : simplex.vertices) {
                if (v != w) links[v].push_back(w);
            }
        }
    }
    for (auto& link : links) {
        std::sort(link.begin(), link.end());
        link.erase(std::unique(link.begin(), link.end()), link.end());
    }
    return links;
}

Points selectPoints(std::span<const std::uint32_t> which, const Points& points) {
    Points places;
    places.reserve(which.size());
    for (const std::uint32_t v : which) places.push_back(points[v]);
    return places;
}

// Returns, for each point, whether it is a vertex of the hull, that is, whether it lies outside the hull of the other
// points by more than the error bounds. Points inside an edge, a 2-face or a cell are not vertices of the hull, even if
// rounding or the perturbation made them vertices of simplices.
std::vector<bool> vertexFlags(std::span<const SimplexFacet> simplices, const Points& points, const HullFrame& frame) {
    const auto links = neighborsByPoint(simplices, points.size());
    std::vector<bool> vertex(points.size(), false), doubtful(points.size(), false), reached(points.size(), false);
    for (std::uint32_t v = 0; v < points.size(); ++v) {
        if (links[v].empty()) continue;
        vertex[v] = !liesInHull(points[v], selectPoints(links[v], points), frame);
        doubtful[v] = !vertex[v];
    }
    // A point is doubtful if it lies in the hull of its neighbors, within the error bounds. Some of these neighbors may
    // be doubtful, too, and may turn out to be no vertices. Therefore each point of a connected component of doubtful
    // points is tested against the hull of the vertices around the component.
    for (std::uint32_t first = 0; first < points.size(); ++first) {
        if (!doubtful[first] || reached[first]) continue;
        std::vector<std::uint32_t> together{first}, around;
        reached[first] = true;
        for (std::size_t at = 0; at < together.size(); ++at) {
            for (const std::uint32_t v : links[together[at]]) {
                if (!doubtful[v]) around.push_back(v);
                if (!doubtful[v] || reached[v]) continue;
                reached[v] = true;
                together.push_back(v);
            }
        }
        std::sort(around.begin(), around.end());
        around.erase(std::unique(around.begin(), around.end()), around.end());
        const Points places = selectPoints(around, points);
        for (const std::uint32_t v : together) vertex[v] = !liesInHull(points[v], places, frame);
    }
    return vertex;
}

}  // namespace

ConvexHull convexHull(std::span<const glm::dvec4> points, const glm::dvec4& rounding, std::size_t maxCells) {
    if (points.size() <= kDimensions) {
        throwFileError(
            0, "a convex hull in four dimensions needs at least 5 points, not " + std::to_string(points.size()));
    }
    HullFrame frame(points, rounding);
    frame.allowForPerturbation(kPerturbation);
    // Shuffle the points, so that the first points are a random sample.
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    // Merge points that differ only within the error bounds. `places` holds one point of each merged group, in the
    // coordinates of `frame`.
    Points places;
    std::vector<std::uint32_t> numbers;  // the index in `points` of each element of `places`
    geometry::EqualPointFinder index(4 * 2 * frame.largestErrorBound());
    for (const std::uint32_t i : order) {
        if (index.findOrAdd(frame(points[i]), places).second) numbers.push_back(i);
    }
    if (places.size() <= kDimensions) {
        throwFileError(0, "a convex hull in four dimensions needs at least 5 different points, not " +
                              std::to_string(places.size()));
    }

    std::vector<SimplexFacet> simplices = simplicialHull(places, frame, maxCells);
    for (int round = 0; round < kMaxRounds; ++round) {
        const std::vector<bool> vertex = vertexFlags(simplices, places, frame);
        std::vector<bool> onHull(places.size(), false);
        for (const SimplexFacet& simplex : simplices) {
            for (const std::uint32_t v : simplex.vertices) onHull[v] = true;
        }
        if (vertex == onHull) break;
        std::size_t kept = 0;
        for (std::size_t v = 0; v < places.size(); ++v) {
            if (!vertex[v]) continue;
            places[kept] = places[v];
            numbers[kept++] = numbers[v];
        }
        places.resize(kept);
        numbers.resize(kept);
        frame.allowForPerturbation(kPerturbation);
        simplices = simplicialHull(places, frame, maxCells);
    }

    MergedHull merged = mergeCoplanar(simplices, places, frame);
    if (merged.cells.size() > maxCells) throwHullTooLarge(maxCells);
    ConvexHull hull{{}, std::move(merged.faces), std::move(merged.cells), merged.ambiguousCellPairs, rounding};
    std::vector<std::uint32_t> used;
    for (const std::uint32_t v : hull.faces.items) used.push_back(v);
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    // Sort the vertices by their order in `points`.
    std::sort(used.begin(), used.end(), [&](auto a, auto b) { return numbers[a] < numbers[b]; });
    std::vector<std::uint32_t> number(places.size(), 0);
    for (const std::uint32_t v : used) {
        number[v] = static_cast<std::uint32_t>(hull.vertices.size());
        hull.vertices.push_back(points[numbers[v]]);
    }
    for (std::uint32_t& v : hull.faces.items) v = number[v];
    return hull;
}

}  // namespace oval4d::polytopes
