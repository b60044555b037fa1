#include "export/mesh/measure.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace oval4d::exports {

namespace {

// A volume up to this number times e³, or an area up to this number times e², counts as 0, because it may be a rounding
// error. Here, e is the greatest distance of a vertex of the slice from the mean of the vertices.
constexpr double kRoundingError = 1e-12;

struct WeightedMean {
    glm::dvec3 sum{0};
    double weight = 0;
    void add(const glm::dvec3& at, double by) {
        sum += by * at;
        weight += by;
    }
};

}  // namespace

SliceMeasurements measureSlice(const slicing::SliceSet& slices, int i) {
    SliceMeasurements out;
    const std::size_t count = slices.vertexCount(i);
    if (count == 0) return out;
    const glm::dvec3* points = slices.vertices.data() + slices.vertexBegin[i];
    WeightedMean ofPoints;
    for (std::size_t v = 0; v < count; ++v) ofPoints.add(points[v], 1);
    // The sums below use coordinates relative to the mean of the points, to keep rounding errors small.
    const glm::dvec3 base = ofPoints.sum / ofPoints.weight;
    double extent = 0;
    for (std::size_t v = 0; v < count; ++v) extent = std::max(extent, glm::distance(points[v], base));

    WeightedMean ofVolume;
    WeightedMean ofArea;
    for (std::uint32_t f = slices.faceBegin[i]; f < slices.faceBegin[i + 1];) {
        const std::uint32_t cell = slices.faceSource[f];
        glm::dvec3 area(0);
        // The sum of (signed area · centroid) over the triangles of all loops of the face.
        glm::dvec3 moment(0);
        double signedArea = 0;
        for (; f < slices.faceBegin[i + 1] && slices.faceSource[f] == cell; ++f) {
            const auto at = [&](std::uint32_t corner) { return points[slices.corners[corner]] - base; };
            const std::uint32_t first = slices.cornerBegin[f];
            for (std::uint32_t c = first + 1; c + 1 < slices.cornerBegin[f + 1]; ++c) {
                const glm::dvec3 p = at(first);
                const glm::dvec3 q = at(c);
                const glm::dvec3 r = at(c + 1);
                const glm::dvec3 part = glm::cross(q - p, r - p) / 2.0;
                ofVolume.add((p + q + r) / 4.0, glm::dot(p, glm::cross(q, r)) / 6);
                // The area vectors of triangles of a planar face are parallel. A triangle whose vector is opposite to
                // the sum so far counts as negative.
                const double size = std::copysign(glm::length(part), glm::dot(part, area) < 0 ? -1.0 : 1.0);
                area += part;
                moment += size * (p + q + r) / 3.0;
                signedArea += size;
            }
        }
        ++out.faces;
        const double size = glm::length(area);
        out.area += size;
        if (signedArea != 0) ofArea.add(moment / signedArea, size);
    }
    WeightedMean ofEdges;
    for (std::uint32_t e = slices.edgeBegin[i]; e < slices.edgeBegin[i + 1]; ++e) {
        const auto [a, b] = slices.edges[e];
        ofEdges.add((points[a] + points[b]) / 2.0 - base, glm::distance(points[a], points[b]));
    }
    out.hasCentroid = true;
    out.volume = ofVolume.weight;
    if (std::abs(out.volume) <= kRoundingError * extent * extent * extent) out.volume = 0;
    const WeightedMean& mean = out.volume != 0                                    ? ofVolume
                               : ofArea.weight > kRoundingError * extent * extent ? ofArea
                                                                                  : ofEdges;
    out.centroid = mean.weight != 0 ? base + mean.sum / mean.weight : base;
    return out;
}

}  // namespace oval4d::exports
