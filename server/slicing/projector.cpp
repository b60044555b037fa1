#include "slicing/projector.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "geometry/index.hpp"
#include "geometry/point_cloud.hpp"
#include "polytopes/polytope.hpp"
#include "slicing/cloud_slicer.hpp"
#include "slicing/overloaded.hpp"

namespace oval4d::slicing {

namespace {

using geometry::kNone;

// Which elements of a cell complex are written to part 0 of the output, the projection of the object (see
// Projector::project()).
struct ProjectedElementSelection {
    const DrawnElements* unhidden;    // the selected elements; if null, `facing` selects elements
    const std::vector<bool>* facing;  // per cell: whether its elements are selected; if null, all elements are selected
    bool face(const geometry::CellComplex& p, std::size_t f) const {
        if (unhidden != nullptr) return unhidden->faces[f];
        return facing == nullptr || (*facing)[p.faceCells[f][0]] || (*facing)[p.faceCells[f][1]];
    }
};

// Numbers the selected vertices and edges. Sets the entries of `vertices` and `edges` to the indices of these elements
// in part 0 of the output, or to kNone for elements that are not selected. An edge that is seen in parts gets the index
// of its first part.
void numberSelectedElements(const geometry::CellComplex& p, const ProjectedElementSelection& selection,
                            std::vector<std::uint32_t>& vertices, std::vector<std::uint32_t>& edges) {
    vertices.assign(p.vertices.size(), kNone);
    edges.assign(p.edges.size(), kNone);
    std::uint32_t count = 0;
    if (selection.unhidden != nullptr) {
        const DrawnElements& drawn = *selection.unhidden;
        for (const DrawnElements::EdgePart& part : drawn.edgeParts)
            edges[part.edge] = std::min(edges[part.edge], count++);
        for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] = drawn.vertices[v] ? 0 : kNone;
        for (std::size_t f = 0; f < p.faces.size(); ++f) {
            if (!drawn.faces[f]) continue;
            for (const std::uint32_t v : p.faces[f]) vertices[v] = 0;
        }
    } else {
        for (std::size_t f = 0; f < p.faces.size(); ++f) {
            if (!selection.face(p, f)) continue;
            for (const std::uint32_t e : p.faceEdges[f]) edges[e] = 0;
        }
        for (std::size_t e = 0; e < edges.size(); ++e) {
            if (edges[e] == kNone) continue;
            edges[e] = count++;
            for (const std::uint32_t v : p.edges[e]) vertices[v] = 0;
        }
    }
    count = 0;
    for (std::uint32_t& v : vertices) {
        if (v != kNone) v = count++;
    }
}

// Adds to part 0 of the output the parts of edges that are seen, and a vertex at each end of such a part within an
// edge. `number` has the index of each vertex of the complex in part 0, or kNone. `place` returns the projection of a
// vertex. If some vertices have no balls, sets the scales and opacities of the balls of all vertices.
template <typename Place>
void addEdgeParts(const geometry::CellComplex& p, const DrawnElements& drawn, const std::vector<std::uint32_t>& number,
                  Place place, SliceSet& out) {
    for (std::uint32_t v = 0; v < number.size(); ++v) {
        if (number[v] != kNone) out.ballOpacity.push_back(drawn.vertices[v] ? 1.0F : 0.0F);
    }
    for (const DrawnElements::EdgePart& part : drawn.edgeParts) {
        const std::array<std::uint32_t, 2>& ends = p.edges[part.edge];
        const auto vertexAt = [&](double at, std::uint32_t end) {
            if (at <= 0 || at >= 1) return number[end];
            out.vertices.push_back(glm::mix(place(ends[0]), place(ends[1]), at));
            out.vertexSource.push_back(part.edge);
            return static_cast<std::uint32_t>(out.vertices.size() - 1);
        };
        const std::uint32_t from = vertexAt(part.from, ends[0]), to = vertexAt(part.to, ends[1]);
        out.edges.push_back({from, to});
        out.edgeSource.push_back(static_cast<std::uint32_t>(p.faces.size()) + part.edge);
    }
    out.ballOpacity.resize(out.vertices.size(), 0.0F);
    if (std::ranges::find(out.ballOpacity, 0.0F) == out.ballOpacity.end()) {
        out.ballOpacity.clear();
    } else {
        out.ballScale.assign(out.vertices.size(), 1.0F);
    }
}

void clear(SliceSet& out) {
    out.vertexBegin.assign(1, 0);
    out.edgeBegin.assign(1, 0);
    out.faceBegin.assign(1, 0);
    out.cornerBegin.assign(1, 0);
    out.vertices.clear();
    out.vertexSource.clear();
    out.ballScale.clear();
    out.ballOpacity.clear();
    out.edges.clear();
    out.edgeSource.clear();
    out.corners.clear();
    out.cornerEdges.clear();
    out.faceSource.clear();
}

void endPart(SliceSet& out) {
    out.vertexBegin.push_back(static_cast<std::uint32_t>(out.vertices.size()));
    out.edgeBegin.push_back(static_cast<std::uint32_t>(out.edges.size()));
    out.faceBegin.push_back(static_cast<std::uint32_t>(out.faceSource.size()));
}

}  // namespace

void Projector::project(const Object& object, const geometry::Rotation& orientation, const SliceSet& slices,
                        const ProjectionOptions& options, SliceSet& out, std::vector<std::uint32_t>& faceCells) {
    clear(out);
    faceCells.clear();
    lacksSteps_ = false;
    const ProjectionToHyperplane& projection = options.projection;
    const auto addComplex = [&](const geometry::CellComplex& p) {
        const auto edges = static_cast<std::uint32_t>(p.edges.size());
        const auto faces = static_cast<std::uint32_t>(p.faces.size());
        const auto cells = static_cast<std::uint32_t>(p.cells.size());
        const bool culled = options.culled && cells > 0, drawn = options.cells;
        if (cells > 0 && (culled || drawn)) findFacingCells(object, orientation, projection);
        const bool allHide = findHidingCells(p, options.hiddenTypes);
        const bool mayHideItself = culled && (!allHide || !infoOf(object).convex);
        if (mayHideItself) roles_.drawn = allHide ? cellIsFacing_ : roles_.hides;
        const ProjectedElementSelection selection{
            mayHideItself ? findUnhiddenElements(p, orientation, slices, options) : nullptr,
            culled ? &cellIsFacing_ : nullptr};
        lacksSteps_ = mayHideItself && selection.unhidden == nullptr;
        numberSelectedElements(p, selection, number_, edgeNumber_);
        const auto place = [&](std::uint32_t v) { return projection(slices.rotatedVertices[v]); };
        for (std::uint32_t v = 0; v < number_.size(); ++v) {
            if (number_[v] == kNone) continue;
            out.vertices.push_back(place(v));
            out.vertexSource.push_back(edges + v);
        }
        if (selection.unhidden != nullptr) {
            addEdgeParts(p, *selection.unhidden, number_, place, out);
        } else {
            for (std::uint32_t e = 0; e < edges; ++e) {
                if (edgeNumber_[e] == kNone) continue;
                out.edges.push_back({number_[p.edges[e][0]], number_[p.edges[e][1]]});
                out.edgeSource.push_back(faces + e);
            }
        }
        for (std::uint32_t f = 0; drawn && f < faces; ++f) {
            if (!selection.face(p, f)) continue;
            for (const std::uint32_t v : p.faces[f]) out.corners.push_back(number_[v]);
            for (const std::uint32_t e : p.faceEdges[f]) out.cornerEdges.push_back(edgeNumber_[e]);
            out.cornerBegin.push_back(static_cast<std::uint32_t>(out.corners.size()));
            out.faceSource.push_back(cells + f);
            if (cells == 0) {
                faceCells.push_back(f);
                continue;
            }
            const auto [first, second] = p.faceCells[f];
            const bool takesSecond = roles_.hides[first] == roles_.hides[second]
                                         ? cellIsFacing_[second] && !cellIsFacing_[first]
                                         : roles_.hides[second];
            faceCells.push_back(takesSecond ? second : first);
        }
    };
    const auto addCloud = [&](const geometry::PointCloud& cloud) {
        const double usual = relativeBallRadius(cloud) * cloud.circumradius;
        for (std::uint32_t p = 0; p < cloud.points.size(); ++p) {
            out.vertices.push_back(projection(slices.rotatedVertices[p]));
            out.vertexSource.push_back(p);
            out.ballScale.push_back(static_cast<float>(cloud.radii[p] > 0 ? cloud.radii[p] / usual : 1));
        }
        out.ballOpacity.assign(out.ballScale.size(), 1);
    };
    visitElements(Overloaded{[&](const geometry::CellComplex& complex) { addComplex(complex); },
                             [&](const geometry::PointCloud& cloud) { addCloud(cloud); }},
                  object);
    endPart(out);
    for (int i = options.firstSlice; i < options.endSlice; ++i) addSlice(slices, i, projection, out, faceCells);
    if (out.ballScale.empty()) return;
    out.ballScale.resize(out.vertices.size(), 1.0F);
    out.ballOpacity.resize(out.vertices.size(), 1.0F);
}

void Projector::addSlice(const SliceSet& slices, int slice, const ProjectionToHyperplane& projection, SliceSet& out,
                         std::vector<std::uint32_t>& faceCells) {
    const auto append = [](auto& to, const auto& from, std::uint32_t begin, std::uint32_t end) {
        to.insert(to.end(), from.begin() + begin, from.begin() + end);
    };
    const std::uint32_t v0 = slices.vertexBegin[slice], v1 = slices.vertexBegin[slice + 1];
    const std::uint32_t e0 = slices.edgeBegin[slice], e1 = slices.edgeBegin[slice + 1];
    const std::uint32_t f0 = slices.faceBegin[slice], f1 = slices.faceBegin[slice + 1];
    const std::uint32_t c0 = slices.cornerBegin[f0], c1 = slices.cornerBegin[f1];
    const double magnification = projection.magnification(slices.planes.w(slice));
    if (slices.ballScale.empty()) {
        for (std::uint32_t v = v0; v < v1; ++v) out.vertices.push_back(slices.vertices[v] * magnification);
    } else {  // the points of a cloud lie near the hyperplane of the slice, not in it
        for (std::uint32_t v = v0; v < v1; ++v)
            out.vertices.push_back(projection(slices.rotatedVertices[slices.vertexSource[v]]));
        append(out.ballScale, slices.ballScale, v0, v1);
        append(out.ballOpacity, slices.ballOpacity, v0, v1);
    }
    append(out.vertexSource, slices.vertexSource, v0, v1);
    append(out.edges, slices.edges, e0, e1);
    append(out.edgeSource, slices.edgeSource, e0, e1);
    const auto corner = static_cast<std::uint32_t>(out.corners.size());
    for (std::uint32_t f = f0; f < f1; ++f) out.cornerBegin.push_back(corner + slices.cornerBegin[f + 1] - c0);
    append(out.corners, slices.corners, c0, c1);
    append(out.cornerEdges, slices.cornerEdges, c0, c1);
    append(out.faceSource, slices.faceSource, f0, f1);
    append(faceCells, slices.faceSource, f0, f1);
    endPart(out);
}

// Finds the cells whose outer sides are turned toward the eye E. The outer side of a cell is turned toward E if E lies
// on the outer side of the cell's hyperplane. This is so if n·E > n·p, where n is the outward normal of the cell and p
// any point of the cell. For E = (0, 0, 0, d), division by d gives n_w > (n·p) / d.
void Projector::findFacingCells(const Object& object, const geometry::Rotation& orientation,
                                const ProjectionToHyperplane& projection) {
    const geometry::ObjectInfo& info = infoOf(object);
    if (object_ != info.serial) {
        object_ = info.serial;
        findCellHyperplanes(object, normals_, offsets_);
    }
    const glm::dmat4 matrix = orientation.matrix();
    const glm::dvec4 toW(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]);
    cellIsFacing_.resize(normals_.size());
    for (std::size_t c = 0; c < normals_.size(); ++c) {
        // With this slack, a cell that is seen edge-on does not count as facing the eye.
        const double slack = kOnPlaneTolerance * glm::length(normals_[c]);
        cellIsFacing_[c] = glm::dot(toW, normals_[c]) > offsets_[c] * projection.inverseDistance + slack;
    }
}

// Sets roles_.hides: only cells of the types `hiddenTypes` hide nothing. Returns whether all cells hide what lies
// behind them.
bool Projector::findHidingCells(const geometry::CellComplex& complex, std::span<const std::uint32_t> hiddenTypes) {
    roles_.hides.assign(complex.cells.size(), true);
    bool all = true;
    for (std::size_t c = 0; c < complex.cells.size() && !hiddenTypes.empty(); ++c) {
        if (!std::ranges::binary_search(hiddenTypes, complex.typeOfCell[c])) continue;
        roles_.hides[c] = false;
        all = false;
    }
    return all;
}

// Returns what of an object does not lie behind its cells, or null if options.occlusionSteps are too few to find it.
// Expects that roles_ is valid.
const DrawnElements* Projector::findUnhiddenElements(const geometry::CellComplex& complex,
                                                     const geometry::Rotation& orientation, const SliceSet& slices,
                                                     const ProjectionOptions& options) {
    const OcclusionInput input{complex.serial,
                               orientation,
                               options.projection,
                               options.cells,
                               {options.hiddenTypes.begin(), options.hiddenTypes.end()},
                               options.occlusionSteps};
    if (occlusionInput_ != input) {
        occlusionInput_.reset();
        images_.clear();
        for (const glm::dvec4& vertex : slices.rotatedVertices)
            images_.push_back(options.projection.projectWithHeight(vertex));
        occlusionFound_ =
            occlusion_.findDrawnElements(complex, images_, roles_, options.cells, options.occlusionSteps, unhidden_);
        occlusionInput_ = input;
    }
    return occlusionFound_ ? &unhidden_ : nullptr;
}

}  // namespace oval4d::slicing
