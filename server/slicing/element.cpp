#include "slicing/element.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "fields/field.hpp"
#include "geometry/point_cloud.hpp"
#include "polytopes/polygon_names.hpp"
#include "polytopes/polytope.hpp"
#include "slicing/overloaded.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

namespace {

using geometry::CellComplex;
using geometry::PointCloud;

// Calls `visit` with the index of each vertex of the element. For a cell, visits a vertex once for each 2-face of the
// cell that contains the vertex.
template <typename Visit>
void visitVertexNumbers(const CellComplex& p, const Element& element, Visit visit) {
    const std::size_t i = element.index;
    switch (element.kind) {
        case ElementKind::vertex:
            visit(static_cast<std::uint32_t>(i));
            break;
        case ElementKind::edge:
            for (const auto v : p.edges[i]) visit(v);
            break;
        case ElementKind::face:
            for (const auto v : p.faces[i]) visit(v);
            break;
        case ElementKind::cell:
            for (const auto face : p.cells[i]) {
                for (const auto v : p.faces[face]) visit(v);
            }
            break;
    }
}

template <typename Visit>
void visitVertexNumbers(const PointCloud& /*cloud*/, const Element& element, Visit visit) {
    visit(static_cast<std::uint32_t>(element.index));
}

const std::vector<glm::dvec4>& verticesOf(const CellComplex& p) { return p.vertices; }
const std::vector<glm::dvec4>& verticesOf(const PointCloud& cloud) { return cloud.points; }

// Calls `visit` with the position of each vertex that visitVertexNumbers() visits, in the same order.
template <typename Elements, typename Visit>
void visitVertices(const Elements& object, const Element& element, Visit visit) {
    visitVertexNumbers(object, element, [&](std::uint32_t v) { visit(verticesOf(object)[v]); });
}

// Tells which elements contain a given element, or are contained in it. An element contains another one if it contains
// all vertices of the other one.
template <typename Elements>
class IncidenceTest {
  public:
    IncidenceTest(const Elements& object, const Element& element) : object_(object), element_(element) {
        isOwn_.resize(verticesOf(object).size());
        visitVertexNumbers(object, element, [&](std::uint32_t v) { isOwn_[v] = true; });
        own_ = static_cast<std::size_t>(std::ranges::count(isOwn_, true));
    }

    bool operator()(const Element& other) {
        if (other.kind == element_.kind) return other == element_;
        common_.clear();
        bool isWithin = true;
        visitVertexNumbers(object_, other, [&](std::uint32_t v) {
            if (isOwn_[v])
                common_.push_back(v);
            else
                isWithin = false;
        });
        if (other.kind < element_.kind) return isWithin;
        std::ranges::sort(common_);
        const auto repeated = std::ranges::unique(common_);
        return common_.size() - repeated.size() == own_;
    }

  private:
    const Elements& object_;
    Element element_;
    std::vector<bool> isOwn_;  // per vertex of the object: whether the given element contains it
    std::size_t own_ = 0;      // the number of vertices of the given element
    std::vector<std::uint32_t> common_;
};

// An orthonormal basis of the directions within an element.
class OrthonormalBasis {
  public:
    /// Makes the basis of an element of dimension `dimension` from vectors that span the directions within the element,
    /// by the Gram–Schmidt process. Each step takes the vector whose part perpendicular to the basis is longest, so
    /// that rounding errors of the points do not count as directions. Stops early if the longest part is at most
    /// `tolerance` long. Overwrites `vectors`.
    OrthonormalBasis(std::span<glm::dvec4> vectors, std::size_t dimension, double tolerance) {
        while (size_ < std::min(dimension, basis_.size()) && !vectors.empty()) {
            const glm::dvec4 longest = *std::ranges::max_element(vectors, {}, [](const auto& v) { return dot(v, v); });
            if (glm::length(longest) <= tolerance) return;
            const glm::dvec4 unit = basis_.at(size_++) = glm::normalize(longest);
            if (size_ == dimension) return;
            for (glm::dvec4& v : vectors) v -= glm::dot(v, unit) * unit;
        }
    }

    /// Returns the coordinates, in this basis, of the orthogonal projection of v onto the span of the basis. If the
    /// basis has fewer than three vectors, the remaining coordinates are 0.
    glm::dvec3 coordinates(const glm::dvec4& v) const {
        return {glm::dot(v, basis_[0]), glm::dot(v, basis_[1]), glm::dot(v, basis_[2])};
    }

    /// Returns the component of v that is perpendicular to all vectors of the basis.
    glm::dvec4 perpendicular(glm::dvec4 v) const {
        for (std::size_t i = 0; i < size_; ++i) v -= glm::dot(v, basis_.at(i)) * basis_.at(i);
        return v;
    }

  private:
    std::array<glm::dvec4, 3> basis_{};
    std::size_t size_ = 0;
};

// Returns the result of elementDirectionOf(). `points` is a buffer, which is overwritten. A caller with many elements
// passes the same buffer for all of them, so that memory is allocated only once.
template <typename Elements>
glm::dvec4 elementDirectionIn(const Elements& object, const Element& element, const glm::dvec4& preferred,
                              std::vector<glm::dvec4>& points) {
    const double tolerance = 1e-6 * object.circumradius;
    points.clear();
    visitVertices(object, element, [&](const glm::dvec4& v) { points.push_back(v); });
    const glm::dvec4 center = std::accumulate(points.begin(), points.end(), glm::dvec4(0)) / double(points.size());
    for (glm::dvec4& point : points) point -= center;
    const OrthonormalBasis basis(points, static_cast<std::size_t>(element.kind), tolerance);
    const glm::dvec4 foot = basis.perpendicular(center);
    if (glm::length(foot) > tolerance) return foot;
    const glm::dvec4 near = basis.perpendicular(glm::normalize(preferred));
    if (glm::length(near) > 1e-6) return near;
    glm::dvec4 best(0);
    for (int axis = 0; axis < 4; ++axis) {
        glm::dvec4 unit(0);
        unit[axis] = 1;
        const glm::dvec4 part = basis.perpendicular(unit);
        if (glm::length(part) > glm::length(best)) best = part;
    }
    return best;
}

void findSourcesIn(const CellComplex& p, const Element& element, PartsShowingElement& out) {
    const auto index = static_cast<std::uint32_t>(element.index);
    const auto edgeCount = static_cast<std::uint32_t>(p.edges.size());
    const auto faceCount = static_cast<std::uint32_t>(p.faces.size());
    const auto addEdge = [&](std::uint32_t e) {
        out.edges.push_back(faceCount + e);
        out.ownVertices.insert(out.ownVertices.end(), p.edges[e].begin(), p.edges[e].end());
    };
    const auto addFace = [&](std::uint32_t f) {
        out.edges.push_back(f);
        for (const auto e : p.faceEdges[f]) addEdge(e);
    };
    switch (element.kind) {
        case ElementKind::vertex:
            out.ownVertices.push_back(index);
            out.vertices.push_back(edgeCount + index);
            for (std::uint32_t e = 0; e < edgeCount; ++e) {
                if (p.edges[e][0] == index || p.edges[e][1] == index) out.vertices.push_back(e);
            }
            break;
        case ElementKind::edge:
            out.vertices.push_back(index);
            addEdge(index);
            break;
        case ElementKind::face:
            addFace(index);
            break;
        case ElementKind::cell:
            for (const auto f : p.cells[index]) addFace(f);
            break;
    }
}

void findSourcesIn(const PointCloud& /*cloud*/, const Element& element, PartsShowingElement& out) {
    out.vertices.push_back(static_cast<std::uint32_t>(element.index));
    out.ownVertices = out.vertices;
}

// Sets the length, area or volume of `element` in `out`, in the units of the object's file or of a field's function.
// `toFile` is the linear part of the map from the object's coordinates to those of the file or function.
void measureSize(const CellComplex& p, const Element& element, const glm::dmat4& toFile, ElementMeasurements& out) {
    std::vector<glm::dvec4> points;
    visitVertices(p, element, [&](const glm::dvec4& v) { points.push_back(v); });
    // Points relative to a vertex of the element lose the fewest digits by cancellation.
    const glm::dvec4 base = points.front();
    for (glm::dvec4& point : points) point = toFile * (point - base);
    const OrthonormalBasis basis(points, static_cast<std::size_t>(element.kind), 0);
    const auto at = [&](std::uint32_t v) { return basis.coordinates(toFile * (p.vertices[v] - base)); };
    const std::size_t index = element.index;
    switch (element.kind) {
        case ElementKind::vertex:
            break;
        case ElementKind::edge:
            out.length = glm::distance(at(p.edges[index][0]), at(p.edges[index][1]));
            break;
        case ElementKind::face: {
            // The area is the norm of the area bivector. Its components are the areas of the projections to the
            // coordinate planes. The norm does not depend on which vertex of the loop is the first, even if the 2-face
            // is not flat.
            const auto loop = p.faces[index];
            const auto place = [&](std::uint32_t v) { return toFile * (p.vertices[v] - base); };
            double square = 0;
            for (int r = 0; r < 3; ++r) {
                for (int s = r + 1; s < 4; ++s) {
                    double twice = 0;
                    for (std::size_t i = 0; i < loop.size(); ++i) {
                        const glm::dvec4 a = place(loop[i]), b = place(loop[(i + 1) % loop.size()]);
                        twice += a[r] * b[s] - a[s] * b[r];
                    }
                    square += twice * twice / 4;
                }
            }
            out.area = std::sqrt(square);
            break;
        }
        case ElementKind::cell: {
            // The 2-faces are divided into triangles with the corners a, b and c, relative to `base`. The volume is the
            // sum of det(a, b, c) / 6, the signed volumes of the tetrahedra from `base` to these triangles.
            double volume = 0;
            for (std::uint32_t item = p.cells.begin[index]; item < p.cells.begin[index + 1]; ++item) {
                const auto loop = p.faces[p.cells.items[item]];
                for (std::size_t i = 1; i + 1 < loop.size(); ++i)
                    volume += p.cellSigns[item] * glm::dot(at(loop[0]), glm::cross(at(loop[i]), at(loop[i + 1]))) / 6;
            }
            out.volume = std::abs(volume);  // the sign depends only on the handedness of the basis
            break;
        }
    }
}

// Returns the direction that `orientation` turns to +w, in the object's own coordinates.
glm::dvec4 wDirectionInObject(const geometry::Rotation& orientation) { return orientation.inverse()({0, 0, 0, 1}); }

}  // namespace

std::size_t elementCount(const Object& object, ElementKind kind) {
    return elementCounts(object).at(static_cast<std::size_t>(kind));
}

glm::dvec4 elementDirectionOf(const Object& object, const Element& element, const glm::dvec4& preferred) {
    std::vector<glm::dvec4> points;
    return visitElements([&](const auto& elements) { return elementDirectionIn(elements, element, preferred, points); },
                         object);
}

geometry::Rotation rotationToW(const Object& object, const Element& element, const geometry::Rotation& orientation) {
    const glm::dvec4 own = elementDirectionOf(object, element, wDirectionInObject(orientation));
    return geometry::Rotation::between(orientation(own), {0, 0, 0, 1});
}

std::optional<Element> elementToTurnTo(const Object& object, ElementKind kind, const geometry::Rotation& orientation,
                                       const std::optional<Element>& incident) {
    const glm::dvec4 w = wDirectionInObject(orientation);
    std::vector<std::size_t> candidates(elementCount(object, kind));
    std::iota(candidates.begin(), candidates.end(), std::size_t{0});
    double best = -2;
    std::size_t nearest = 0;  // the index in `candidates` of the element whose direction has the cosine `best`
    std::vector<glm::dvec4> points;
    const auto findNearest = [&](const auto& elements) {
        if (incident) {
            IncidenceTest isIncident(elements, *incident);
            std::erase_if(candidates, [&](std::size_t i) { return !isIncident(Element{kind, i}); });
        }
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            const double cosine =
                glm::dot(w, glm::normalize(elementDirectionIn(elements, {kind, candidates[i]}, w, points)));
            // Elements at the same angle from +w are equally near. The first of them is chosen, so that rounding does
            // not decide.
            constexpr double kSame = 1e-9;
            if (cosine > best + kSame) {
                best = cosine;
                nearest = i;
            }
        }
    };
    visitElements(findNearest, object);
    if (candidates.empty()) return std::nullopt;
    // An element already points to +w if its angle from +w is less than 1.4e-6 radians, where 1 − cos is 1e-12.
    constexpr double kThere = 1e-12;
    if (best > 1 - kThere) nearest = (nearest + 1) % candidates.size();
    return Element{kind, candidates[nearest]};
}

std::vector<bool> elementsCutBy(const Object& object, ElementKind kind, const geometry::Rotation& orientation,
                                const geometry::Hyperplanes& plane) {
    std::vector<bool> isCut(elementCount(object, kind));
    const glm::dvec4 direction = wDirectionInObject(orientation);
    const auto cutComplex = [&](const CellComplex& complex) {
        const double w = plane.w(0), slack = kOnPlaneTolerance * complex.circumradius;
        std::vector<double> distances;  // per vertex: its distance from the hyperplane, positive above the hyperplane
        distances.reserve(complex.vertices.size());
        for (const glm::dvec4& v : complex.vertices) distances.push_back(glm::dot(direction, v) - w);
        for (std::size_t i = 0; i < isCut.size(); ++i) {
            bool isAbove = false, isBelow = false;
            visitVertexNumbers(complex, {kind, i}, [&](std::uint32_t v) {
                isAbove = isAbove || distances[v] > slack;
                isBelow = isBelow || distances[v] < -slack;
            });
            isCut[i] = isAbove == isBelow;
        }
    };
    const auto cutCloud = [&](const PointCloud& cloud) {
        for (std::size_t i = 0; i < isCut.size(); ++i) {
            const double height = glm::dot(direction, cloud.points[i]);
            const double number = std::floor((height - plane.offset) / plane.spacing + 0.5) - plane.first;
            isCut[i] = number >= 0 && number < plane.count;
        }
    };
    visitElements(Overloaded{cutComplex, cutCloud}, object);
    return isCut;
}

void PartsShowingElement::clear() {
    for (auto* list : {&vertices, &edges, &ownVertices}) list->clear();
}

void findPartsShowing(const Object& object, const Element& element, PartsShowingElement& out) {
    out.clear();
    visitElements([&](const auto& elements) { findSourcesIn(elements, element, out); }, object);
    for (auto* list : {&out.vertices, &out.edges, &out.ownVertices}) {
        std::ranges::sort(*list);
        list->erase(std::unique(list->begin(), list->end()), list->end());
    }
}

namespace {

// Returns the product of the units of the axes along which the vertices of an element of a field's box differ.
std::string unitOfElementSize(const Object& object, const fields::Field& field,
                              std::span<const std::uint32_t> vertices) {
    std::vector<std::string> units;
    for (int axis = 0; axis < 4; ++axis) {
        double least = field.box.max[axis], most = field.box.min[axis];
        for (const std::uint32_t v : vertices) {
            const double at = vertexInFile(object, v)[axis];
            least = std::min(least, at);
            most = std::max(most, at);
        }
        // The vertices are corners of the box: along an axis, they differ by the whole extent of the box or not at all.
        if (most - least > (field.box.max[axis] - field.box.min[axis]) / 2)
            units.push_back(field.units.at(static_cast<std::size_t>(axis)));
    }
    return fields::unitOfProduct(units);
}

}  // namespace

ElementMeasurements measureElement(const Object& object, const Element& element) {
    std::vector<std::uint32_t> vertices;
    visitElements(
        [&](const auto& elements) {
            visitVertexNumbers(elements, element, [&](std::uint32_t v) { vertices.push_back(v); });
        },
        object);
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    ElementMeasurements out;
    for (const std::uint32_t v : vertices) out.center += vertexInFile(object, v);
    out.center /= static_cast<double>(vertices.size());
    const fields::Field* const field = fieldIn(object);
    const glm::dmat4 toFile = field == nullptr ? glm::dmat4(1) : field->toFunction;
    if (field != nullptr) out.unit = unitOfElementSize(object, *field, vertices);
    visitElements(Overloaded{[&](const CellComplex& complex) { measureSize(complex, element, toFile, out); },
                             [](const PointCloud& /*cloud*/) {}},
                  object);
    return out;
}

std::pair<double, double> rangeOfW(const Object& object, const geometry::Rotation& orientation,
                                   const Element& element) {
    const glm::dvec4 direction = wDirectionInObject(orientation);
    double least = std::numeric_limits<double>::max(), most = -least;
    const auto include = [&](const glm::dvec4& v) {
        const double w = glm::dot(direction, v);
        least = std::min(least, w);
        most = std::max(most, w);
    };
    visitElements([&](const auto& elements) { visitVertices(elements, element, include); }, object);
    return {least, most};
}

std::string nameOfFace(const Object& object, std::size_t face) {
    std::vector<glm::dvec4> corners;
    const auto addCorner = [&](std::uint32_t v) { corners.push_back(vertexInFile(object, v)); };
    const Element element{ElementKind::face, face};
    visitElements([&](const auto& elements) { visitVertexNumbers(elements, element, addCorner); }, object);
    return polytopes::nameOfPolygon(corners);
}

std::vector<VertexGroupAtW> groupHeights(std::vector<double> heights, double same) {
    std::ranges::sort(heights);
    std::vector<VertexGroupAtW> groups;
    for (auto first = heights.begin(); first != heights.end();) {
        auto last = first + 1;
        while (last != heights.end() && *last - *(last - 1) <= same) ++last;
        const auto count = static_cast<std::size_t>(last - first);
        groups.push_back({std::accumulate(first, last, 0.0) / static_cast<double>(count), count});
        first = last;
    }
    return groups;
}

std::vector<VertexGroupAtW> vertexHeights(const Object& object, const geometry::Rotation& orientation) {
    const glm::dvec4 direction = wDirectionInObject(orientation);
    std::vector<double> heights;
    const auto add = [&](const std::vector<glm::dvec4>& vertices) {
        heights.reserve(vertices.size());
        for (const glm::dvec4& v : vertices) heights.push_back(glm::dot(direction, v));
    };
    visitElements([&](const auto& elements) { add(verticesOf(elements)); }, object);
    return groupHeights(std::move(heights), kOnPlaneTolerance * infoOf(object).circumradius);
}

std::optional<double> nextVertexHeight(const Object& object, const geometry::Rotation& orientation, double w,
                                       bool upward) {
    const double slack = kOnPlaneTolerance * infoOf(object).circumradius;
    const glm::dvec4 direction = wDirectionInObject(orientation);
    std::optional<double> next;
    const auto consider = [&](const std::vector<glm::dvec4>& vertices) {
        for (const glm::dvec4& v : vertices) {
            const double height = glm::dot(direction, v);
            const bool beyond = upward ? height > w + slack : height < w - slack;
            if (beyond && (!next || (upward ? height < *next : height > *next))) next = height;
        }
    };
    visitElements([&](const auto& elements) { consider(verticesOf(elements)); }, object);
    return next;
}

}  // namespace oval4d::slicing
