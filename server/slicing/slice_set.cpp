#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

void SliceSet::resize(SliceElementCounts size) {
    vertexBegin.resize(planes.count + 1);
    edgeBegin.resize(planes.count + 1);
    faceBegin.resize(planes.count + 1);
    vertices.resize(size.vertices);
    vertexSource.resize(size.vertices);
    edges.resize(size.edges);
    edgeSource.resize(size.edges);
    faceSource.resize(size.faces);
    cornerBegin.resize(size.faces + 1);
    corners.resize(size.corners);
    cornerEdges.resize(size.corners);
}

void SliceSet::finishSlices(SliceElementCounts at) {
    setSliceBegin(planes.count, at);
    if (vertices.size() != at.vertices || edges.size() != at.edges || faceSource.size() != at.faces ||
        corners.size() != at.corners)
        resize(at);
    cornerBegin.back() = at.corners;
}

void SliceSet::clearSlices() {
    for (auto* begins : {&vertexBegin, &edgeBegin, &faceBegin, &cornerBegin}) begins->assign(1, 0);
    for (auto* numbers : {&vertexSource, &edgeSource, &corners, &cornerEdges, &faceSource}) numbers->clear();
    for (auto* values : {&ballScale, &ballOpacity}) values->clear();
    vertices.clear();
    edges.clear();
}

void SliceSet::appendSlices(const SliceSet& more) {
    const auto addBegins = [](std::vector<std::uint32_t>& to, const std::vector<std::uint32_t>& from) {
        const std::uint32_t end = to.back();
        for (std::size_t i = 1; i < from.size(); ++i) to.push_back(end + from[i]);
    };
    const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    addBegins(vertexBegin, more.vertexBegin);
    addBegins(edgeBegin, more.edgeBegin);
    addBegins(faceBegin, more.faceBegin);
    addBegins(cornerBegin, more.cornerBegin);
    add(vertices, more.vertices);
    add(vertexSource, more.vertexSource);
    add(ballScale, more.ballScale);
    add(ballOpacity, more.ballOpacity);
    add(edges, more.edges);
    add(edgeSource, more.edgeSource);
    add(corners, more.corners);
    add(cornerEdges, more.cornerEdges);
    add(faceSource, more.faceSource);
}

}  // namespace oval4d::slicing
