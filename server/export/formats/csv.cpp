#include "export/formats/csv.hpp"

#include <algorithm>
#include <vector>

#include "export/formats/text.hpp"
#include "export/mesh/measure.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::exports {

namespace {

void appendSlice(std::string& out, const slicing::SliceSet& slices, int i) {
    const SliceMeasurements m = measureSlice(slices, i);
    out += std::to_string(slices.planes.first + i) + ',';
    append(out, slices.planes.w(i));
    for (const std::size_t count : {slices.vertexCount(i), slices.edgeCount(i), m.faces})
        out += ',' + std::to_string(count);
    for (const double number : {m.volume, m.area}) {
        out += ',';
        append(out, number);
    }
    for (int axis = 0; axis < 3; ++axis) {
        out += ',';
        if (m.hasCentroid) append(out, m.centroid[axis]);
    }
    out += "\n";
}

}  // namespace

std::string measurementsCsv(const SceneInput& source) {
    const slicing::SliceSet& slices = *source.scene.slices;
    std::string out = "n,w,vertices,edges,faces,volume,area,centroid_x,centroid_y,centroid_z\n";
    for (int i = 0; i < slices.planes.count; ++i) appendSlice(out, slices, i);

    out += "\ncritical_w,vertices\n";
    std::vector<double> levels;
    for (const glm::dvec4& v : slices.rotatedVertices) levels.push_back(v.w);
    std::ranges::sort(levels);
    const double same = slicing::kOnPlane * source.scene.circumradius;
    for (auto first = levels.begin(); first != levels.end();) {
        auto last = first + 1;
        while (last != levels.end() && *last - *(last - 1) <= same) ++last;
        double sum = 0;
        for (auto at = first; at != last; ++at) sum += *at;
        append(out, sum / static_cast<double>(last - first));
        out += ',' + std::to_string(last - first) + '\n';
        first = last;
    }
    return out;
}

}  // namespace oval4d::exports
