#include "slicing/section_name.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>

#include <glm/geometric.hpp>

#include "polytopes/construction/polyhedra.hpp"
#include "polytopes/construction/snub.hpp"
#include "polytopes/construction/solids.hpp"
#include "polytopes/polytope.hpp"
#include "slicing/overloaded.hpp"

// How shapes are recognized: a convex polyhedron is determined by its vertices, and its vertices are recognized by
// their distances from each other. These distances do not depend on the orientation. They suffice for
// nameOfHullOfObjectVertices(), which names a convex hull. A slice, however, need not be the convex hull of its
// vertices. It is the hull if it has the same edges and the same number of faces as the hull. Therefore nameOfSlice()
// also compares the number and the lengths of the edges, and the number of faces. The distances also distinguish
// polyhedra with the same faces and the same circumradius, such as the cuboctahedron and the triangular orthobicupola
// (Johnson's J27).

namespace oval4d::slicing {

namespace {

constexpr double kTolerance = 1e-6;  // the tolerance of distances, relative to the circumradius
constexpr int kMaxSides = 20;  // the maximum number of sides of polygons, and of the bases of prisms and antiprisms
constexpr std::size_t kMaxVertices = 120;  // the vertex count of the largest shape, the truncated icosidodecahedron
constexpr std::string_view kPoint = "point";

bool nearlyEqual(double a, double b) { return std::abs(a - b) <= kTolerance; }

// Sets `distances` to the distances of the point `from` from all `points`, in ascending order. If `from` is one of the
// points, the list includes its distance 0 from itself.
void findDistances(const std::vector<glm::dvec3>& points, const glm::dvec3& from, std::vector<double>& distances) {
    distances.clear();
    for (const glm::dvec3& point : points) distances.push_back(glm::distance(from, point));
    std::sort(distances.begin(), distances.end());
}

// Moves the center of the points to 0 and scales their circumradius to 1. Returns false if the points have no extent.
bool moveIntoUnitSphere(std::vector<glm::dvec3>& points) {
    glm::dvec3 sum(0);
    for (const glm::dvec3& point : points) sum += point;
    const glm::dvec3 center = sum / static_cast<double>(points.size());
    double radius = 0;
    for (const glm::dvec3& point : points) radius = std::max(radius, glm::distance(point, center));
    for (glm::dvec3& point : points) point = (point - center) / radius;
    return radius > 0;
}

// Returns the vertices of a regular polygon in the plane z = height, turned by `turn` around the z axis.
std::vector<glm::dvec3> regularPolygon(int sides, double height, double circumradius = 1, double turn = 0) {
    std::vector<glm::dvec3> vertices;
    for (int i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides + turn;
        vertices.emplace_back(circumradius * std::cos(angle), circumradius * std::sin(angle), height);
    }
    return vertices;
}

}  // namespace

bool NamedSection::isSectionOf(const Object& shown, const geometry::Rotation& rotation, double focusW) const {
    return object == infoOf(shown).serial && w == focusW && orientation == rotation;
}

// A shape that has a name. The shapes that knownShapes() returns have the circumradius 1.
struct SectionNamer::NamedShape {
    std::string name;
    std::array<std::size_t, 3> counts{};  // the numbers of vertices, edges and faces
    std::vector<double> edges;            // the different lengths of the edges
    // The distances of a vertex from all vertices, in ascending order. All vertices with the same distances share one
    // list. Most shapes have only one list.
    std::vector<std::vector<double>> distances;

    // Makes a shape without a name, with vertices at these positions and edges of these lengths.
    NamedShape(const std::vector<glm::dvec3>& vertices, std::vector<double> edgeLengths)
        : edges(std::move(edgeLengths)) {
        findDistancesOf(vertices);
    }

    // Makes a shape of the dimension `dimension`: 1 for a segment, 2 for a polygon and 3 for a polyhedron. Its edges
    // are the pairs of vertices with the least distance from each other.
    NamedShape(std::string shapeName, int dimension, std::vector<glm::dvec3> vertices) : name(std::move(shapeName)) {
        moveIntoUnitSphere(vertices);
        findDistancesOf(vertices);
        edges = {distances.front()[1]};
        const std::size_t edgeCount = countEdges(vertices);
        // For a polyhedron, by Euler's formula.
        const std::size_t faces = dimension == 3 ? edgeCount + 2 - vertices.size() : dimension - 1;
        counts = {vertices.size(), edgeCount, faces};
    }

    // Makes a regular star polyhedron with the center 0. `edge` is the length of its edges, and `sides` the number of
    // sides of its faces.
    NamedShape(std::string shapeName, std::vector<glm::dvec3> vertices, double edge, std::size_t sides)
        : name(std::move(shapeName)), edges{edge / glm::length(vertices.front())} {
        moveIntoUnitSphere(vertices);
        findDistancesOf(vertices);
        const std::size_t edgeCount = countEdges(vertices);
        counts = {vertices.size(), edgeCount, 2 * edgeCount / sides};
    }

    NamedShape(std::string shapeName, polytopes::SolidMesh mesh) : name(std::move(shapeName)) {
        moveIntoUnitSphere(mesh.vertices);
        findDistancesOf(mesh.vertices);
        std::size_t sides = 0;
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            const auto loop = mesh.faces[f];
            for (std::size_t i = 0; i < loop.size(); ++i, ++sides) {
                const double length = glm::distance(mesh.vertices[loop[i]], mesh.vertices[loop[(i + 1) % loop.size()]]);
                if (!hasEdgeOfLength(length)) edges.push_back(length);
            }
        }
        counts = {mesh.vertices.size(), sides / 2, mesh.faces.size()};
    }

    void findDistancesOf(const std::vector<glm::dvec3>& vertices) {
        std::vector<double> ofVertex;
        for (const glm::dvec3& vertex : vertices) {
            findDistances(vertices, vertex, ofVertex);
            if (!hasVertexWithDistances(ofVertex)) distances.push_back(ofVertex);
        }
    }
    // Returns the number of pairs of vertices whose distance is the length of an edge of the shape.
    std::size_t countEdges(const std::vector<glm::dvec3>& vertices) const {
        std::size_t ends = 0;
        std::vector<double> ofVertex;
        for (const glm::dvec3& vertex : vertices) {
            findDistances(vertices, vertex, ofVertex);
            ends += std::ranges::count_if(ofVertex, [&](double distance) { return hasEdgeOfLength(distance); });
        }
        return ends / 2;
    }
    // Returns whether a vertex of the shape has the distances `ofVertex` from all vertices.
    bool hasVertexWithDistances(const std::vector<double>& ofVertex) const {
        return std::any_of(distances.begin(), distances.end(), [&](const std::vector<double>& known) {
            return std::equal(known.begin(), known.end(), ofVertex.begin(), nearlyEqual);
        });
    }
    bool hasEdgeOfLength(double length) const {
        return std::ranges::any_of(edges, [length](double known) { return nearlyEqual(known, length); });
    }
};

// A family of polyhedra with the same name and different proportions: all polyhedra of one kind over regular polygons
// with the same number of sides, or all cuboids.
struct SectionNamer::PolyhedronFamily {
    enum class Kind : std::uint8_t { cuboid, prism, antiprism, pyramid, bipyramid };

    Kind kind;
    polytopes::RegularPolygon base;  // the base of the polyhedra; a square for cuboids
    std::string name;
    std::array<std::size_t, 3> counts{};  // the numbers of vertices, edges and faces

    PolyhedronFamily(Kind familyKind, polytopes::RegularPolygon polygon, std::string familyName)
        : kind(familyKind), base(polygon), name(std::move(familyName)) {
        const auto n = static_cast<std::size_t>(base.numerator);
        if (kind == Kind::cuboid || kind == Kind::prism) counts = {2 * n, 3 * n, n + 2};
        if (kind == Kind::antiprism) counts = {2 * n, 4 * n, 2 * n + 2};
        if (kind == Kind::pyramid) counts = {n + 1, 2 * n, n + 1};
        if (kind == Kind::bipyramid) counts = {n + 2, 3 * n, 2 * n};
    }

    // Returns the members of the family that may have edges of these lengths, which are in ascending order. For
    // cuboids, there is one such member. For other kinds there are up to two, because either length may be that of the
    // sides of the polygon.
    std::vector<NamedShape> membersWithEdgeLengths(const std::vector<double>& lengths) const {
        const double shortest = lengths.front(), longest = lengths.back();
        std::vector<NamedShape> members;
        if (kind == Kind::cuboid) {
            const double middle = lengths[lengths.size() / 2];
            std::vector<glm::dvec3> vertices;
            for (const double x : {0.0, shortest}) {
                for (const double y : {0.0, middle}) vertices.insert(vertices.end(), {{x, y, 0}, {x, y, longest}});
            }
            members.emplace_back(vertices, std::vector{shortest, middle, longest});
            return members;
        }
        for (const auto& [side, lateral] : {std::pair{shortest, longest}, std::pair{longest, shortest}}) {
            const std::vector<glm::dvec3> vertices = verticesOf(side, lateral);
            if (!vertices.empty()) members.emplace_back(vertices, std::vector{side, lateral});
        }
        return members;
    }

    // Returns the vertices of the member of the family whose polygon has sides of the length `side`, and whose other
    // edges have the length `lateral`. Returns an empty list if there is no such member.
    std::vector<glm::dvec3> verticesOf(double side, double lateral) const {
        const int sides = base.numerator;
        const double radius = side / (2 * std::sin(std::numbers::pi * base.denominator / sides));
        const double turn = kind == Kind::antiprism ? std::numbers::pi / sides : 0;
        const bool hasApex = kind == Kind::pyramid || kind == Kind::bipyramid;
        // The horizontal extent of a lateral edge.
        const double across = hasApex ? radius : 2 * radius * std::sin(turn / 2);
        const double height = std::sqrt(lateral * lateral - across * across);
        if (!(height > kTolerance)) return {};
        std::vector<glm::dvec3> vertices = regularPolygon(sides, 0, radius);
        if (hasApex) {
            vertices.emplace_back(0, 0, height);
            if (kind == Kind::bipyramid) vertices.emplace_back(0, 0, -height);
        } else {
            const auto top = regularPolygon(sides, height, radius, turn);
            vertices.insert(vertices.end(), top.begin(), top.end());
        }
        return vertices;
    }
};

const std::vector<SectionNamer::NamedShape>& SectionNamer::knownShapes() {
    using polytopes::RegularPolygon;
    static const std::vector<NamedShape> kShapes = [] {
        const auto named = polytopes::namedPolyhedra();
        std::vector<NamedShape> shapes;
        for (const polytopes::NamedPolyhedron& solid : named) {
            if (!polytopes::isConvex(solid)) {
                // The Coxeter–Dynkin diagram of {p, q} is xpoqo; that of its dual {q, p} is opoqx.
                const std::string_view diagram = solid.linearNotation;
                const char sides = diagram.starts_with('x') ? diagram[1] : diagram[diagram.size() - 2];
                constexpr double kEdge = 2;
                shapes.emplace_back(std::string(solid.name), polytopes::verticesOf(solid), kEdge,
                                    static_cast<std::size_t>(sides - '0'));
                continue;
            }
            shapes.emplace_back(std::string(solid.name), 3, polytopes::verticesOf(solid));
            const polytopes::SolidDescription dual{&solid, 0, false, true};
            const std::string nameOfDual = polytopes::nameOf(dual);
            // The duals of the Platonic solids are Platonic solids themselves, so they already have names.
            if (std::ranges::none_of(named, [&](const auto& other) { return other.name == nameOfDual; }))
                shapes.emplace_back(nameOfDual, polytopes::meshOf(dual));
        }
        for (int n = 3; n <= kMaxSides; ++n) {
            const RegularPolygon polygon{n, 1};
            shapes.emplace_back(polytopes::polygonNoun(polygon), 2, regularPolygon(n, 0));
            if (n != 4) {  // for n = 4, the prism is a cube, which is a Platonic solid
                const double halfEdge = std::sin(std::numbers::pi / n);
                auto prism = regularPolygon(n, halfEdge);
                const auto bottom = regularPolygon(n, -halfEdge);
                prism.insert(prism.end(), bottom.begin(), bottom.end());
                shapes.emplace_back(polytopes::adjectiveOf(polygon) + " prism", 3, std::move(prism));
            }
            if (n != 3) {  // for n = 3, the antiprism is an octahedron, and the trapezohedron a cube
                shapes.emplace_back(polytopes::adjectiveOf(polygon) + " antiprism", 3,
                                    polytopes::snubOf(polygon, {2, 1}).vertices);
                const polytopes::SolidDescription trapezohedron{nullptr, n, true, true};
                shapes.emplace_back(polytopes::nameOf(trapezohedron), polytopes::meshOf(trapezohedron));
            }
        }
        shapes.emplace_back("segment", 1, std::vector<glm::dvec3>{{-1, 0, 0}, {1, 0, 0}});
        return shapes;
    }();
    return kShapes;
}

const std::vector<SectionNamer::PolyhedronFamily>& SectionNamer::families() {
    using Kind = PolyhedronFamily::Kind;
    using polytopes::RegularPolygon;
    static const std::vector<PolyhedronFamily> kFamilies = [] {
        std::vector<PolyhedronFamily> families;
        families.emplace_back(Kind::cuboid, RegularPolygon{4, 1}, "cuboid");
        for (int n = 3; n <= kMaxSides; ++n) {
            const RegularPolygon polygon{n, 1};
            const std::string adjective = polytopes::adjectiveOf(polygon);
            // For n = 4, the prism is a cuboid.
            if (n != 4) families.emplace_back(Kind::prism, polygon, adjective + " prism");
            families.emplace_back(Kind::antiprism, polygon, adjective + " antiprism");
            // For n = 3, the pyramid is a tetrahedron.
            if (n != 3) families.emplace_back(Kind::pyramid, polygon, adjective + " pyramid");
            families.emplace_back(Kind::bipyramid, polygon, adjective + " bipyramid");
            for (int d = 2; 2 * d < n; ++d) {
                const RegularPolygon star{n, d};
                if (std::gcd(n, d) == 1)
                    families.emplace_back(Kind::prism, star, polytopes::adjectiveOf(star) + " prism");
            }
        }
        return families;
    }();
    return kFamilies;
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
    const auto hasTheseCounts = [&](const auto& shape) { return shape.counts == counts; };
    if (std::ranges::none_of(knownShapes(), hasTheseCounts) && std::ranges::none_of(families(), hasTheseCounts))
        return {};
    const auto first = slices.vertices.begin() + slices.vertexBegin[slice];
    vertices_.assign(first, first + static_cast<std::ptrdiff_t>(counts[0]));
    if (!moveIntoUnitSphere(vertices_)) return {};
    const auto edges = std::span(slices.edges).subspan(slices.edgeBegin[slice], counts[1]);
    for (const NamedShape& shape : knownShapes()) {
        if (hasTheseCounts(shape) && haveEdgeLengthsOf(shape, edges) && verticesAreThoseOf(shape)) return shape.name;
    }
    return nameOfFamily(slices, slice, true);
}

std::string_view SectionNamer::nameOfHullOfObjectVertices(const SliceSet& slices, int slice, std::size_t edges) {
    vertices_.clear();
    for (std::uint32_t v = slices.vertexBegin[slice]; v < slices.vertexBegin[slice + 1]; ++v) {
        if (slices.vertexSource[v] < edges) continue;
        if (vertices_.size() == kMaxVertices) return {};
        vertices_.push_back(slices.vertices[v]);
    }
    if (vertices_.size() < 2) return vertices_.empty() ? std::string_view() : kPoint;
    if (!moveIntoUnitSphere(vertices_)) return {};
    for (const NamedShape& shape : knownShapes()) {
        if (shape.counts[0] == vertices_.size() && verticesAreThoseOf(shape)) return shape.name;
    }
    // If no edge of the object crosses the hyperplane, a convex slice is the convex hull of the object's vertices in
    // it.
    return vertices_.size() == slices.vertexCount(slice) ? nameOfFamily(slices, slice, false) : std::string_view();
}

bool SectionNamer::isSolidName(std::string_view name) {
    const auto shape = std::ranges::find(knownShapes(), name, &NamedShape::name);
    if (shape != knownShapes().end()) return shape->counts[2] > 1;
    return std::ranges::find(families(), name, &PolyhedronFamily::name) != families().end();
}

// Returns the name of the family to which a slice belongs, or an empty string if it belongs to none. If `withStars` is
// false, also returns an empty string for a prism over a star polygon. vertices_ must have the vertices of the slice.
std::string_view SectionNamer::nameOfFamily(const SliceSet& slices, int slice, bool withStars) {
    const std::array counts{slices.vertexCount(slice), slices.edgeCount(slice), slices.faceCount(slice)};
    const auto edges = std::span(slices.edges).subspan(slices.edgeBegin[slice], counts[1]);
    lengths_.clear();
    for (const PolyhedronFamily& family : families()) {
        if (family.counts != counts || (!withStars && family.base.denominator != 1)) continue;
        if (lengths_.empty()) {
            for (const auto& [a, b] : edges) lengths_.push_back(glm::distance(vertices_[a], vertices_[b]));
            std::ranges::sort(lengths_);
        }
        for (const NamedShape& member : family.membersWithEdgeLengths(lengths_)) {
            if (haveEdgeLengthsOf(member, edges) && verticesAreThoseOf(member)) return family.name;
        }
    }
    return {};
}

bool SectionNamer::haveEdgeLengthsOf(const NamedShape& shape,
                                     std::span<const std::array<std::uint32_t, 2>> edges) const {
    return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
        return shape.hasEdgeOfLength(glm::distance(vertices_[edge[0]], vertices_[edge[1]]));
    });
}

bool SectionNamer::verticesAreThoseOf(const NamedShape& shape) {
    return std::all_of(vertices_.begin(), vertices_.end(), [&](const glm::dvec3& vertex) {
        findDistances(vertices_, vertex, distances_);
        return shape.hasVertexWithDistances(distances_);
    });
}

}  // namespace oval4d::slicing
