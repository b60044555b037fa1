#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

void SliceSet::resize(SliceCounts size) {
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

void SliceSet::end(SliceCounts at) {
    begin(planes.count, at);
    if (vertices.size() != at.vertices || edges.size() != at.edges || faceSource.size() != at.faces ||
        corners.size() != at.corners)
        resize(at);
    cornerBegin.back() = at.corners;
}

}  // namespace oval4d::slicing
