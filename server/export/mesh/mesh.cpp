#include "export/mesh/mesh.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace oval4d::exports {

RoundingGrid::RoundingGrid(double size, double extent) {
    // A 32-bit float has 24 significant bits. So it represents all multiples of the step from −extent to extent
    // exactly, if the step is a power of two ≥ extent / 2^23. If also step ≥ size / 2^17 (0.46 µm for 60 mm), the
    // object spans at most 2^17 steps along each axis, which convexHullOfGridPoints() can process.
    const double needed = std::max(size / 131'072, extent / 8'388'608);
    step_ = std::exp2(std::ceil(std::log2(needed)));
}

RoundingGrid RoundingGrid::forDoublePrecision(double size, double extent) {
    // A double has 53 significant bits. With steps of at least extent / 2^50, the sum of two positions on the grid is
    // exact.
    RoundingGrid grid(size, extent);
    grid.step_ = std::exp2(std::ceil(std::log2(std::max(size * 0x1p-40, extent * 0x1p-50))));
    return grid;
}

glm::dvec3 RoundingGrid::snap(const glm::dvec3& point) const {
    // The addition of 0 turns −0 into 0, so that equal coordinates have equal texts and bytes in files.
    return glm::round(point / step_) * step_ + 0.0;
}

bool isClosedManifold(const Mesh& mesh) {
    // `fans` has an entry for each triangle at each point p: the next and the previous corner in the triangle, seen
    // from p. Triangles are neighbors in the ring around p if the previous corner of one is the next corner of the
    // other. The entries of p begin at begin[p].
    std::vector<std::uint32_t> begin(mesh.points.size() + 1, 0);
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t corner : triangle) ++begin[corner + 1];
    }
    for (std::size_t i = 0; i < mesh.points.size(); ++i) begin[i + 1] += begin[i];
    // The next and the previous corner of each entry.
    std::vector<std::array<std::uint32_t, 2>> fans(3 * mesh.triangles.size());
    std::vector<std::uint32_t> cursor(begin.begin(), begin.end() - 1);
    for (const auto& t : mesh.triangles) {
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return false;
        for (int i = 0; i < 3; ++i) fans[cursor[t[i]]++] = {t[(i + 1) % 3], t[(i + 2) % 3]};
    }
    for (std::size_t p = 0; p < mesh.points.size(); ++p) {
        const auto first = fans.begin() + begin[p];
        const auto last = fans.begin() + begin[p + 1];
        if (first == last) continue;
        std::sort(first, last);
        std::ptrdiff_t steps = 0;
        for (auto at = first; steps == 0 || at != first; ++steps) {
            if (steps == last - first) return false;
            const auto next = std::lower_bound(first, last, std::array<std::uint32_t, 2>{(*at)[1], 0});
            if (next == last || (*next)[0] != (*at)[1] || (next + 1 != last && (*(next + 1))[0] == (*at)[1]))
                return false;
            at = next;
        }
        if (steps != last - first) return false;
    }
    return true;
}

double volumeOf(const Mesh& mesh) {
    if (mesh.points.empty()) return 0;
    double six = 0;
    const glm::dvec3 base = mesh.points.front();
    for (const auto& t : mesh.triangles) {
        six += glm::dot(mesh.points[t[0]] - base, glm::cross(mesh.points[t[1]] - base, mesh.points[t[2]] - base));
    }
    return six / 6;
}

bool isThickEnough(const Mesh& mesh, const RoundingGrid& grid) {
    double twiceArea = 0;
    for (const auto& triangle : mesh.triangles) twiceArea += glm::length(doubleAreaNormalOf(mesh, triangle));
    constexpr double kLeastThickness = 4;
    return volumeOf(mesh) > kLeastThickness * grid.step() * twiceArea / 4;
}

glm::dvec3 doubleAreaNormalOf(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
    return glm::cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]);
}

std::vector<std::array<glm::dvec3, 3>> smoothNormals(const Mesh& mesh) {
    // The cosine of 40°: a triangle counts for a corner of another triangle if their normals differ by at most 40°.
    constexpr double kLeastCosine = 0.766;
    const std::size_t count = mesh.triangles.size();
    std::vector<glm::dvec3> across;
    std::vector<std::uint32_t> begin(mesh.points.size() + 1, 0);
    for (const auto& triangle : mesh.triangles) {
        across.push_back(doubleAreaNormalOf(mesh, triangle));
        for (const std::uint32_t corner : triangle) ++begin[corner + 1];
    }
    for (std::size_t p = 0; p < mesh.points.size(); ++p) begin[p + 1] += begin[p];
    std::vector<std::uint32_t> around(3 * count);  // triangles around each point
    std::vector<std::uint32_t> cursor(begin.begin(), begin.end() - 1);
    for (std::uint32_t t = 0; t < count; ++t) {
        for (const std::uint32_t corner : mesh.triangles[t]) around[cursor[corner]++] = t;
    }
    std::vector<std::array<glm::dvec3, 3>> normals(count);
    for (std::size_t t = 0; t < count; ++t) {
        const double length = glm::length(across[t]);
        for (std::size_t i = 0; i < 3 && length > 0; ++i) {
            const std::uint32_t corner = mesh.triangles[t][i];
            glm::dvec3 sum(0);
            for (std::uint32_t at = begin[corner]; at < begin[corner + 1]; ++at) {
                const glm::dvec3& other = across[around[at]];
                if (glm::dot(other, across[t]) >= kLeastCosine * glm::length(other) * length) sum += other;
            }
            normals[t][i] = glm::normalize(sum);
        }
    }
    return normals;
}

void BoundingBox::include(const glm::dvec3& point) {
    min = glm::min(min, point);
    max = glm::max(max, point);
}

BoundingBox boundingBoxOf(const Mesh& mesh) {
    BoundingBox box;
    for (const glm::dvec3& point : mesh.points) box.include(point);
    return box;
}

}  // namespace oval4d::exports
