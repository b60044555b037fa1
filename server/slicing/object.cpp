#include "slicing/object.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "fields/field.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/surface_mesh.hpp"
#include "polytopes/off.hpp"
#include "polytopes/polytope.hpp"
#include "slicing/cloud_slicer.hpp"
#include "slicing/overloaded.hpp"

namespace oval4d::slicing {

namespace {

using geometry::CellComplex;
using geometry::PointCloud;

const std::vector<glm::dvec4>& verticesOf(const Object& object) {
    return visitElements(
        Overloaded{[](const CellComplex& complex) -> const std::vector<glm::dvec4>& { return complex.vertices; },
                   [](const PointCloud& cloud) -> const std::vector<glm::dvec4>& { return cloud.points; }},
        object);
}

// Returns the radius of the balls at the corners of a field's domain. The radius is small, because the domain's edges
// only frame the surfaces.
double relativeBallRadius(const fields::Field& /*field*/) { return 0.016; }

double relativeBallRadius(const CellComplex& p) {
    double sum = 0;
    for (const auto& [a, b] : p.edges) sum += glm::distance(p.vertices[a], p.vertices[b]);
    const double meanEdge = sum / static_cast<double>(p.edges.size());
    const double radius = 0.062 * std::min(1.0, std::pow(meanEdge / p.circumradius, 0.65));
    // The bars that show the edges of a nonconvex slice may cross each other. With half the radius, the crossings stay
    // visible.
    return p.convex ? radius : 0.5 * radius;
}

// Returns the radius of the balls and bars of a surface. The radius has a lower bound: however fine the mesh of the
// surface is, the curves in its slices must be visible.
double relativeBallRadius(const geometry::SurfaceMesh& surface) {
    constexpr double kLeast = 0.016;
    return std::max(kLeast, relativeBallRadius(static_cast<const CellComplex&>(surface)));
}

std::size_t memoryOf(const fields::Field& field) {
    std::size_t functions = 0;
    if (!field.isTransformed) {
        functions = field.function->memoryBytes();
        if (field.second) functions += field.second->function->memoryBytes();
    }
    return sizeof field + functions + polytopes::memoryOf(*field.domain);
}

void findCellCenters(const CellComplex& p, std::vector<glm::dvec4>& out) {
    out.resize(p.cells.size());
    for (std::size_t c = 0; c < out.size(); ++c) {
        glm::dvec4 sum(0);
        double count = 0;
        for (const auto face : p.cells[c]) {
            for (const auto v : p.faces[face]) sum += p.vertices[v];
            count += static_cast<double>(p.faces[face].size());
        }
        out[c] = sum / count;
    }
}

void findFaceCenters(const CellComplex& p, std::vector<glm::dvec4>& out) {
    out.assign(p.faces.size(), glm::dvec4(0));
    for (std::size_t f = 0; f < out.size(); ++f) {
        const auto loop = p.faces[f];
        for (const std::uint32_t v : loop) out[f] += p.vertices[v] / static_cast<double>(loop.size());
    }
}

// Returns the vector that is perpendicular to a, b and c, and whose length is the volume of their parallelepiped.
glm::dvec4 perpendicularTo(const glm::dvec4& a, const glm::dvec4& b, const glm::dvec4& c) {
    const auto minor = [&](int i, int j, int k) {
        return glm::dot(glm::dvec3(a[i], a[j], a[k]),
                        glm::cross(glm::dvec3(b[i], b[j], b[k]), glm::dvec3(c[i], c[j], c[k])));
    };
    return {-minor(1, 2, 3), minor(0, 2, 3), -minor(0, 1, 3), minor(0, 1, 2)};
}

// Finds the normal of each cell: the 4-D counterpart of a polygon's area vector. The cell's 2-faces are divided into
// triangles that are counterclockwise seen from outside the cell. For each triangle, perpendicularTo() is applied to
// the vectors from a fixed vertex of the cell to its three corners. The normal is the sum of the results. The
// orientations of all cells agree, so all normals point outward.
void findCellHyperplanes(const CellComplex& p, std::vector<glm::dvec4>& normals, std::vector<double>& offsets) {
    normals.assign(p.cells.size(), glm::dvec4(0));
    offsets.assign(p.cells.size(), 0);
    for (std::size_t c = 0; c < normals.size(); ++c) {
        const glm::dvec4 origin = p.vertices[p.faces[p.cells[c][0]][0]];
        double absoluteVolume = 0;  // six times the sum of |volume| of the tetrahedra from `origin` to the triangles
        for (std::uint32_t at = p.cells.begin[c]; at < p.cells.begin[c + 1]; ++at) {
            const auto loop = p.faces[p.cells.items[at]];
            const glm::dvec4 first = p.vertices[loop[0]] - origin;
            for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
                const glm::dvec4 part =
                    perpendicularTo(first, p.vertices[loop[i]] - origin, p.vertices[loop[i + 1]] - origin);
                normals[c] += static_cast<double>(p.cellSigns[at]) * part;
                absoluteVolume += glm::length(part);
            }
        }
        if (glm::length(normals[c]) <= 1e-9 * absoluteVolume) normals[c] = glm::dvec4(0);
        offsets[c] = glm::dot(normals[c], origin);
    }
}

}  // namespace

const geometry::ObjectInfo& infoOf(const Object& object) {
    return std::visit([](const auto& shared) -> const geometry::ObjectInfo& { return *shared; }, object);
}

std::array<std::size_t, 4> elementCounts(const Object& object) {
    using Counts = std::array<std::size_t, 4>;
    return visitElements(Overloaded{[](const CellComplex& complex) {
                                        return Counts{complex.vertices.size(), complex.edges.size(),
                                                      complex.faces.size(), complex.cells.size()};
                                    },
                                    [](const PointCloud& cloud) { return Counts{cloud.points.size(), 0, 0, 0}; }},
                         object);
}

bool hasConvexFaces(const Object& object) {
    return visitElements(Overloaded{[](const CellComplex& complex) { return complex.convexFaces; },
                                    [](const PointCloud& /*cloud*/) { return true; }},
                         object);
}

// This function has one case per kind of object. A new kind has no case here, so the function does not compile until
// the kind states its properties.
ObjectKindProperties propertiesOf(const Object& object) {
    return std::visit(Overloaded{[](const PolytopePtr& /*polytope*/) {
                                     return ObjectKindProperties{.noun = "polytope",
                                                                 .isPlural = false,
                                                                 .slices = SliceContent::solids,
                                                                 .slicesAreThick = false,
                                                                 .sectionsHaveNames = true};
                                 },
                                 [](const SurfacePtr& /*surface*/) {
                                     return ObjectKindProperties{.noun = "surface",
                                                                 .isPlural = false,
                                                                 .slices = SliceContent::curves,
                                                                 .slicesAreThick = false,
                                                                 .sectionsHaveNames = true};
                                 },
                                 [](const CloudPtr& /*cloud*/) {
                                     return ObjectKindProperties{.noun = "points",
                                                                 .isPlural = true,
                                                                 .slices = SliceContent::points,
                                                                 .slicesAreThick = true,
                                                                 .sectionsHaveNames = false};
                                 },
                                 [](const FieldPtr& /*field*/) {
                                     return ObjectKindProperties{.noun = "field",
                                                                 .isPlural = false,
                                                                 .slices = SliceContent::level_surfaces,
                                                                 .slicesAreThick = false,
                                                                 .sectionsHaveNames = false};
                                 }},
                      object);
}

const fields::Field* fieldIn(const Object& object) {
    const auto* field = std::get_if<FieldPtr>(&object);
    return field == nullptr ? nullptr : field->get();
}

Object transformedTo(const Object& object, const geometry::ReferenceFrame& frame) {
    return frame == geometry::ReferenceFrame{} ? object : transformedTo(object, frame, geometry::nextSerial());
}

Object transformedTo(const Object& object, const geometry::ReferenceFrame& frame, std::uint64_t serial) {
    if (frame == geometry::ReferenceFrame{}) return object;
    return std::visit(
        [&]<typename Kind>(const std::shared_ptr<const Kind>& shared) -> Object {
            return std::make_shared<const Kind>(transformedTo(*shared, frame, serial));
        },
        object);
}

double initialSliceExtent(const Object& object) {
    constexpr double kInDomain = 0.95;
    const fields::Field* field = fieldIn(object);
    if (field == nullptr) return infoOf(object).circumradius;
    double reach = 0;
    for (const glm::dvec4& vertex : field->domain->vertices) reach = std::max(reach, std::abs(vertex.w));
    return kInDomain * reach;
}

std::size_t memoryOf(const Object& object) {
    return std::visit([](const auto& shared) { return memoryOf(*shared); }, object);
}

const void* identityOf(const Object& object) {
    return std::visit([](const auto& shared) -> const void* { return shared.get(); }, object);
}

glm::dvec4 vertexInFile(const Object& object, std::size_t index) {
    const glm::dvec4& own = verticesOf(object)[index];
    const fields::Field* const field = fieldIn(object);
    return field == nullptr ? infoOf(object).originInFile + own : field->center + field->toFunction * own;
}

std::pair<double, double> rangeOfW(const Object& object, const geometry::Rotation& orientation) {
    const glm::dmat4 matrix = orientation.matrix();
    const glm::dvec4 row(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]);
    const auto& vertices = verticesOf(object);
    std::pair<double, double> range{glm::dot(row, vertices.front()), glm::dot(row, vertices.front())};
    for (const glm::dvec4& v : vertices) {
        const double w = glm::dot(row, v);
        range = {std::min(range.first, w), std::max(range.second, w)};
    }
    return range;
}

double relativeBallRadius(const Object& object) {
    return std::visit([](const auto& shared) { return relativeBallRadius(*shared); }, object);
}

void findCellCenters(const Object& object, std::vector<glm::dvec4>& out) {
    visitElements(Overloaded{[&](const CellComplex& complex) { findCellCenters(complex, out); },
                             [&](const PointCloud& /*cloud*/) { out.clear(); }},
                  object);
}

void findFaceCenters(const Object& object, std::vector<glm::dvec4>& out) {
    visitElements(Overloaded{[&](const CellComplex& complex) { findFaceCenters(complex, out); },
                             [&](const PointCloud& /*cloud*/) { out.clear(); }},
                  object);
}

void findCellHyperplanes(const Object& object, std::vector<glm::dvec4>& normals, std::vector<double>& offsets) {
    visitElements(Overloaded{[&](const CellComplex& complex) { findCellHyperplanes(complex, normals, offsets); },
                             [&](const PointCloud& /*cloud*/) {
                                 normals.clear();
                                 offsets.clear();
                             }},
                  object);
}

std::span<const std::uint32_t> typesOfCells(const Object& object) {
    using CellTypeNumbers = std::span<const std::uint32_t>;
    return visitElements(Overloaded{[](const CellComplex& complex) { return CellTypeNumbers(complex.typeOfCell); },
                                    [](const PointCloud& /*cloud*/) { return CellTypeNumbers(); }},
                         object);
}

std::string write4Off(const Object& object, std::span<const glm::dvec4> rotatedVertices) {
    std::vector<glm::dvec4> vertices(rotatedVertices.begin(), rotatedVertices.end());
    for (glm::dvec4& v : vertices) v += infoOf(object).originInFile;
    return visitElements(Overloaded{[&](const CellComplex& complex) { return polytopes::write4Off(complex, vertices); },
                                    [&](const PointCloud& cloud) {
                                        CellComplex points;
                                        points.name = cloud.name;
                                        return polytopes::write4Off(points, vertices);
                                    }},
                         object);
}

}  // namespace oval4d::slicing
