#include "slicing/section_name.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "polytopes/construction/polyhedra.hpp"
#include "polytopes/construction/snub.hpp"
#include "polytopes/polytope.hpp"
#include "slicing/overloaded.hpp"

// A convex polyhedron is determined by its vertices. The vertices are recognized by their distances from each other,
// which do not depend on the orientation. These distances suffice for nameOfObjectVertices(), which names a convex
// hull. A slice, however, need not be the convex hull of its vertices. It is the hull if it has the same edges and the
// same number of faces as the hull. Therefore nameOfSlice() also compares the number and the lengths of the edges, and
// the number of faces. The distances also distinguish polyhedra with the same faces and the same circumradius, such as
// the cuboctahedron and the triangular orthobicupola (Johnson's J27).

namespace oval4d::slicing {

namespace {

constexpr double kTolerance = 1e-6;        // the tolerance of distances, relative to the circumradius
constexpr int kMaxSides = 20;              // of polygons, and of the bases of prisms and antiprisms
constexpr std::size_t kMaxVertices = 120;  // the vertex count of the largest shape, the truncated icosidodecahedron
constexpr std::string_view kPoint = "point";

bool near(double a, double b) { return std::abs(a - b) <= kTolerance; }

// Sets `distances` to the distances of a point from all points, including itself, in ascending order.
void findDistances(const std::vector<glm::dvec3>& points, const glm::dvec3& from, std::vector<double>& distances) {
    distances.clear();
    for (const glm::dvec3& point : points) distances.push_back(glm::distance(from, point));
    std::sort(distances.begin(), distances.end());
}

// Moves the center of the points to 0 and scales their circumradius to 1. Returns false if they have no extent.
bool moveIntoUnitSphere(std::vector<glm::dvec3>& points) {
    glm::dvec3 sum(0);
    for (const glm::dvec3& point : points) sum += point;
    const glm::dvec3 center = sum / static_cast<double>(points.size());
    double radius = 0;
    for (const glm::dvec3& point : points) radius = std::max(radius, glm::distance(point, center));
    for (glm::dvec3& point : points) point = (point - center) / radius;
    return radius > 0;
}

// Returns the vertices of a regular polygon of circumradius 1 in the plane z = height.
std::vector<glm::dvec3> regularPolygon(int sides, double height) {
    std::vector<glm::dvec3> vertices;
    for (int i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        vertices.emplace_back(std::cos(angle), std::sin(angle), height);
    }
    return vertices;
}

}  // namespace

bool NamedSection::isOf(const Object& shown, const geometry::Rotation& rotation, double focusW) const {
    return object == infoOf(shown).serial && w == focusW && orientation == rotation;
}

// A shape that has a name. Its circumradius is 1.
struct SectionNamer::Shape {
    std::string name;
    std::array<std::size_t, 3> counts{};  // the numbers of vertices, edges and faces
    double edge = 0;                      // the length of all edges
    // The distances of a vertex from all vertices, in ascending order: one list for all vertices with the same
    // distances. Most shapes have only one list.
    std::vector<std::vector<double>> distances;

    // `dimension` is 1 for a segment, 2 for polygons and 3 for polyhedra. Takes the pairs of vertices with the least
    // distance from each other as the edges.
    Shape(std::string shapeName, int dimension, std::vector<glm::dvec3> vertices) : name(std::move(shapeName)) {
        moveIntoUnitSphere(vertices);
        std::size_t edgeEnds = 0;
        std::vector<double> ofVertex;
        for (const glm::dvec3& vertex : vertices) {
            findDistances(vertices, vertex, ofVertex);
            if (!hasVertex(ofVertex)) distances.push_back(ofVertex);
            edge = ofVertex[1];
            edgeEnds += std::count_if(ofVertex.begin(), ofVertex.end(), [&](double d) { return near(d, edge); });
        }
        const std::size_t edges = edgeEnds / 2;
        const std::size_t faces = dimension == 3 ? edges + 2 - vertices.size() : dimension - 1;  // Euler's formula
        counts = {vertices.size(), edges, faces};
    }

    // Returns whether one of the vertices has these distances from all vertices.
    bool hasVertex(const std::vector<double>& ofVertex) const {
        return std::any_of(distances.begin(), distances.end(), [&](const std::vector<double>& known) {
            return std::equal(known.begin(), known.end(), ofVertex.begin(), near);
        });
    }
};

const std::vector<SectionNamer::Shape>& SectionNamer::shapes() {
    using polytopes::RegularPolygon;
    static const std::vector<Shape> kShapes = [] {
        std::vector<Shape> shapes;
        for (const polytopes::NamedPolyhedron& solid : polytopes::namedPolyhedra()) {
            if (polytopes::isConvex(solid))
                shapes.emplace_back(std::string(solid.name), 3, polytopes::verticesOf(solid));
        }
        for (int n = 3; n <= kMaxSides; ++n) {
            const RegularPolygon polygon{n, 1};
            shapes.emplace_back(polytopes::nounOf(polygon), 2, regularPolygon(n, 0));
            if (n != 4) {  // for n = 4, the prism is a cube, which is a Platonic solid
                const double halfEdge = std::sin(std::numbers::pi / n);
                auto prism = regularPolygon(n, halfEdge);
                const auto bottom = regularPolygon(n, -halfEdge);
                prism.insert(prism.end(), bottom.begin(), bottom.end());
                shapes.emplace_back(polytopes::adjectiveOf(polygon) + " prism", 3, std::move(prism));
            }
            if (n != 3) {  // for n = 3, the antiprism is an octahedron, which is a Platonic solid
                shapes.emplace_back(polytopes::adjectiveOf(polygon) + " antiprism", 3,
                                    polytopes::snubOf(polygon, {2, 1}).vertices);
            }
        }
        std::vector<glm::dvec3> rhombic;
        for (const double x : {-1, 1}) {
            rhombic.insert(rhombic.end(), {{2 * x, 0, 0}, {0, 2 * x, 0}, {0, 0, 2 * x}});
            for (const double y : {-1, 1}) rhombic.insert(rhombic.end(), {{x, y, -1}, {x, y, 1}});
        }
        shapes.emplace_back("rhombic dodecahedron", 3, rhombic);
        shapes.emplace_back("segment", 1, std::vector<glm::dvec3>{{-1, 0, 0}, {1, 0, 0}});
        return shapes;
    }();
    return kShapes;
}

bool SectionNamer::mayHaveName(const Object& object, const geometry::Rotation& orientation, double w) {
    const double slack = kOnPlaneTolerance * infoOf(object).circumradius;
    const glm::dvec4 direction = orientation.inverse()({0, 0, 0, 1});
    const auto sideOf = [&](const glm::dvec4& vertex) {
        const double height = glm::dot(direction, vertex) - w;
        return height > slack ? 1 : height < -slack ? -1 : 0;
    };
    const auto countInPlane = [&](const std::vector<glm::dvec4>& vertices) {
        return static_cast<std::size_t>(std::ranges::count_if(vertices, [&](const auto& v) { return sideOf(v) == 0; }));
    };
    if (!propertiesOf(object).sectionsHaveNames) return false;
    return visitElements(Overloaded{[&](const geometry::CellComplex& complex) {
                                        const std::size_t inPlane = countInPlane(complex.vertices);
                                        if (inPlane > 0 && inPlane <= kMaxVertices) return true;
                                        std::size_t size = inPlane;
                                        for (const auto& [a, b] : complex.edges) {
                                            const int sides = sideOf(complex.vertices[a]) * sideOf(complex.vertices[b]);
                                            size += sides < 0 ? 1 : 0;
                                            if (size > kMaxVertices) return false;
                                        }
                                        return size > 0;
                                    },
                                    [](const geometry::PointCloud& /*cloud*/) { return false; }},
                         object);
}

std::string_view SectionNamer::nameOfSlice(const SliceSet& slices, int slice) {
    const std::array counts{slices.vertexCount(slice), slices.edgeCount(slice), slices.faceCount(slice)};
    if (counts == std::array<std::size_t, 3>{1, 0, 0}) return kPoint;
    const auto hasTheseCounts = [&](const Shape& shape) { return shape.counts == counts; };
    if (std::none_of(shapes().begin(), shapes().end(), hasTheseCounts)) return {};
    const auto first = slices.vertices.begin() + slices.vertexBegin[slice];
    vertices_.assign(first, first + static_cast<std::ptrdiff_t>(counts[0]));
    if (!moveIntoUnitSphere(vertices_)) return {};
    const auto edges = std::span(slices.edges).subspan(slices.edgeBegin[slice], counts[1]);
    for (const Shape& shape : shapes()) {
        if (hasTheseCounts(shape) && edgesHaveLength(edges, shape.edge) && verticesAreThoseOf(shape)) return shape.name;
    }
    return {};
}

std::string_view SectionNamer::nameOfObjectVertices(const SliceSet& slices, int slice, std::size_t edges) {
    vertices_.clear();
    for (std::uint32_t v = slices.vertexBegin[slice]; v < slices.vertexBegin[slice + 1]; ++v) {
        if (slices.vertexSource[v] < edges) continue;
        if (vertices_.size() == kMaxVertices) return {};
        vertices_.push_back(slices.vertices[v]);
    }
    if (vertices_.size() < 2) return vertices_.empty() ? std::string_view() : kPoint;
    if (!moveIntoUnitSphere(vertices_)) return {};
    for (const Shape& shape : shapes()) {
        if (shape.counts[0] == vertices_.size() && verticesAreThoseOf(shape)) return shape.name;
    }
    return {};
}

bool SectionNamer::isSolid(std::string_view name) {
    const auto shape = std::ranges::find(shapes(), name, &Shape::name);
    return shape != shapes().end() && shape->counts[2] > 1;
}

bool SectionNamer::edgesHaveLength(std::span<const std::array<std::uint32_t, 2>> edges, double length) const {
    return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
        return near(glm::distance(vertices_[edge[0]], vertices_[edge[1]]), length);
    });
}

bool SectionNamer::verticesAreThoseOf(const Shape& shape) {
    return std::all_of(vertices_.begin(), vertices_.end(), [&](const glm::dvec3& vertex) {
        findDistances(vertices_, vertex, distances_);
        return shape.hasVertex(distances_);
    });
}

}  // namespace oval4d::slicing
