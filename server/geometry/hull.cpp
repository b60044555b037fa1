#include "geometry/hull.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numeric>
#include <random>
#include <string>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include <glm/geometric.hpp>

#include "geometry/file_text.hpp"

namespace oval4d::geometry {

namespace {

constexpr int kDimensions = 4;
constexpr std::size_t kFirstStage = 1024;  // points
constexpr double kLeastRounding = 1e-10;   // of the size

// One run of Qhull over the first `count` points.
class QhullRun {
  public:
    QhullRun(std::vector<double>& coordinates, std::size_t count, double rounding) {
        qh_zero(&state_, stderr);
        std::FILE* const sink = std::tmpfile();
        char command[64];
        std::snprintf(command, sizeof command, "qhull C-%.3g Pp", rounding);
        status_ = qh_new_qhull(&state_, kDimensions, static_cast<int>(count), coordinates.data(), False, command,
                               nullptr, sink);
        if (sink != nullptr) std::fclose(sink);
    }
    QhullRun(const QhullRun&) = delete;
    QhullRun& operator=(const QhullRun&) = delete;
    ~QhullRun() {
        int kept = 0, total = 0;
        qh_freeqhull(&state_, !qh_ALL);
        qh_memfreeshort(&state_, &kept, &total);
    }

    int status() const { return status_; }
    std::size_t cells() const { return static_cast<std::size_t>(state_.num_facets); }

    // The points of each cell, in ascending order, and for each cell the cells beside it.
    void read(std::vector<std::vector<std::uint32_t>>& points, std::vector<std::vector<std::uint32_t>>& beside) {
        qhT* const qh = &state_;
        facetT* facet = nullptr;
        facetT *neighbor = nullptr, **neighborp = nullptr;
        vertexT *vertex = nullptr, **vertexp = nullptr;
        std::vector<std::uint32_t> number(qh->facet_id, 0);
        std::uint32_t next = 0;
        FORALLfacets { number[facet->id] = next++; }
        FORALLfacets {
            auto& own = points.emplace_back();
            FOREACHvertex_(facet->vertices) own.push_back(static_cast<std::uint32_t>(qh_pointid(qh, vertex->point)));
            std::sort(own.begin(), own.end());
            auto& others = beside.emplace_back();
            FOREACHneighbor_(facet) others.push_back(number[neighbor->id]);
        }
    }

  private:
    qhT state_{};
    int status_ = 0;
};

// The corners of a convex polygon in the order of its boundary.
std::vector<std::uint32_t> aroundPolygon(const std::vector<std::uint32_t>& corners,
                                         std::span<const glm::dvec4> points) {
    glm::dvec4 centre(0);
    for (const auto i : corners) centre += points[i] / static_cast<double>(corners.size());
    const glm::dvec4 x = glm::normalize(points[corners[0]] - centre);
    glm::dvec4 y(0);
    for (const auto i : corners) {
        const glm::dvec4 d = points[i] - centre;
        const glm::dvec4 across = d - glm::dot(d, x) * x;
        if (glm::dot(across, across) > glm::dot(y, y)) y = across;
    }
    const auto angle = [&](std::uint32_t i) {
        return std::atan2(glm::dot(points[i] - centre, y), glm::dot(points[i] - centre, x));
    };
    y = glm::normalize(y);
    std::vector<std::uint32_t> loop(corners);
    std::sort(loop.begin(), loop.end(), [&](auto a, auto b) { return angle(a) < angle(b); });
    return loop;
}

double sizeOf(std::span<const glm::dvec4> points) {
    glm::dvec4 low = points[0], high = points[0];
    for (const auto& p : points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    return glm::length(high - low) / 2;
}

[[noreturn]] void refuseRun(int status) {
    if (status == qh_ERRsingular) refuse(0, "all points lie in one hyperplane");
    if (status == qh_ERRprec || status == qh_ERRwide || status == qh_ERRtopology)
        refuse(0, "the hull of these points cannot be told at their precision; give more decimals");
    refuse(0, "the hull of these points cannot be made (Qhull's status " + std::to_string(status) + ')');
}

}  // namespace

Hull convexHull(std::span<const glm::dvec4> points, double rounding, std::size_t maxCells) {
    if (points.size() <= kDimensions) {
        refuse(0, "a hull in four dimensions needs at least 5 points, not " + std::to_string(points.size()));
    }
    rounding = std::max(rounding, kLeastRounding * sizeOf(points));
    // In any order but the file's, so that the first points are a sample of all.
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    std::vector<double> coordinates;
    for (const auto i : order) {
        for (int k = 0; k < kDimensions; ++k) coordinates.push_back(points[i][k]);
    }
    std::vector<std::vector<std::uint32_t>> cells, beside;
    // A hull can have as many cells as the square of its points: ever larger samples tell before memory does.
    for (std::size_t count = std::min(kFirstStage, points.size());; count = std::min(2 * count, points.size())) {
        QhullRun run(coordinates, count, rounding);
        const bool all = count == points.size();
        // A sample may be flat where all points are not.
        if (run.status() != 0 && all) refuseRun(run.status());
        if (run.status() == 0 && run.cells() > maxCells) {
            throw ImportError{0, "the hull has more than " + std::to_string(maxCells) + " cells, the most allowed",
                              true};
        }
        if (!all) continue;
        run.read(cells, beside);
        break;
    }

    Hull hull;
    std::vector<std::vector<std::uint32_t>> facesOf(cells.size());
    std::vector<std::uint32_t> shared;
    for (std::uint32_t c = 0; c < cells.size(); ++c) {
        for (const std::uint32_t other : beside[c]) {
            if (other <= c) continue;
            shared.clear();
            std::set_intersection(cells[c].begin(), cells[c].end(), cells[other].begin(), cells[other].end(),
                                  std::back_inserter(shared));
            if (shared.size() < 3) continue;
            for (auto& i : shared) i = order[i];
            facesOf[c].push_back(static_cast<std::uint32_t>(hull.faces.size()));
            facesOf[other].push_back(static_cast<std::uint32_t>(hull.faces.size()));
            hull.faces.add(aroundPolygon(shared, points));
        }
    }
    for (const auto& faces : facesOf) hull.cells.add(faces);

    constexpr auto kNone = static_cast<std::uint32_t>(-1);
    std::vector<std::uint32_t> number(points.size(), kNone);
    for (const std::uint32_t v : hull.faces.items) number[v] = 0;
    for (std::size_t v = 0; v < points.size(); ++v) {
        if (number[v] == kNone) continue;
        number[v] = static_cast<std::uint32_t>(hull.vertices.size());
        hull.vertices.push_back(points[v]);
    }
    for (std::uint32_t& v : hull.faces.items) v = number[v];
    return hull;
}

}  // namespace oval4d::geometry
