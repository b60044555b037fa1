#include "polytopes/construction/snub.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "geometry/point_index.hpp"

namespace oval4d::polytopes {

namespace {

// Three mirrors that meet at the angles π/p, π/q and π/2, given by their unit normals, and two rotations. rotationP, of
// order p, is the product of the reflections in the first two mirrors. rotationQ, of order q, is the product of the
// reflections in the last two mirrors.
struct TriangleGroupGenerators {
    std::array<glm::dvec3, 3> mirrorNormals;
    glm::dmat3 rotationP, rotationQ;
};

TriangleGroupGenerators generatorsOf(DiagramBranch p, DiagramBranch q) {
    const auto cosine = [](DiagramBranch b) { return std::cos(std::numbers::pi * b.denominator / b.numerator); };
    const double sine = std::sqrt(1 - cosine(p) * cosine(p));
    const double y = -cosine(q) / sine;
    const std::array<glm::dvec3, 3> m{{{1, 0, 0}, {-cosine(p), sine, 0}, {0, y, std::sqrt(1 - y * y)}}};
    const auto mirror = [](const glm::dvec3& n) { return glm::dmat3(1) - 2.0 * glm::outerProduct(n, n); };
    return {m, mirror(m[0]) * mirror(m[1]), mirror(m[1]) * mirror(m[2])};
}

// Returns the point x between the three mirrors for which rotationP, rotationQ and their product each move x by a
// distance of 2. All edges of the snub polyhedron with the vertex x then have length 2. Solves |x − g x|² = 4 for these
// three rotations g by Newton's method.
glm::dvec3 equidistantPoint(const TriangleGroupGenerators& generators, DiagramBranch p) {
    const std::array<glm::dmat3, 3> moves{glm::dmat3(1) - generators.rotationP, glm::dmat3(1) - generators.rotationQ,
                                          glm::dmat3(1) - generators.rotationP * generators.rotationQ};
    // The initial guess lies midway between the first two mirrors, at distance 1 from the third mirror. Its distance
    // from the axis of rotationP is the circumradius of a p-gon of edge length 2.
    const double circle = 1 / std::sin(std::numbers::pi / p.numerator);
    const double angle = std::numbers::pi / 2 * (1 - 1.0 / p.numerator);
    glm::dvec3 x(circle * std::cos(angle), circle * std::sin(angle), 0);
    x.z = (1 - generators.mirrorNormals[2].y * x.y) / generators.mirrorNormals[2].z;
    constexpr int kMostSteps = 100;
    for (int step = 0; step < kMostSteps; ++step) {
        glm::dvec3 excess;
        glm::dmat3 jacobian;  // row i is the gradient of equation i
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 moved = moves.at(i) * x;
            excess[i] = glm::dot(moved, moved) - 4;
            const glm::dvec3 gradient = 2.0 * (glm::transpose(moves.at(i)) * moved);
            for (int k = 0; k < 3; ++k) jacobian[k][i] = gradient[k];
        }
        const glm::dvec3 by = glm::inverse(jacobian) * excess;
        x -= by;
        if (glm::length(by) < 1e-14 * glm::length(x)) return x;
    }
    throw std::logic_error("Newton's method for the snub polyhedron did not converge");
}

}  // namespace

PolyhedronWithFaceOrbits snubOf(DiagramBranch p, DiagramBranch q) {
    const TriangleGroupGenerators generators = generatorsOf(p, q);
    const glm::dvec3 seed = equidistantPoint(generators, p);
    // The vertices are g · seed for all rotations g of the group. For each vertex g · seed, `next` holds the indices of
    // the vertices g · rotationP · seed and g · rotationQ · seed.
    std::vector<glm::dmat3> rotations{glm::dmat3(1)};
    std::vector<glm::dvec4> points;
    std::vector<std::array<std::uint32_t, 2>> next;
    geometry::EqualPointFinder index(1e-5 * glm::length(seed));
    index.findOrAdd(glm::dvec4(seed, 0), points);
    for (std::size_t i = 0; i < rotations.size(); ++i) {
        next.emplace_back();
        for (const std::size_t k : {0U, 1U}) {
            const glm::dmat3 turned = rotations[i] * (k == 0 ? generators.rotationP : generators.rotationQ);
            const auto [number, fresh] = index.findOrAdd(glm::dvec4(turned * seed, 0), points);
            if (fresh) rotations.push_back(turned);
            next.back().at(k) = number;
        }
    }
    PolyhedronWithFaceOrbits snub;
    snub.vertices.assign(points.begin(), points.end());
    const auto addFace = [&](const std::vector<std::uint32_t>& loop, std::uint32_t orbit) {
        snub.faces.add(loop);
        snub.orbits.push_back(orbit);
    };
    for (const std::uint32_t k : {0U, 1U}) {
        std::vector<bool> done(points.size());
        for (std::uint32_t i = 0; i < points.size(); ++i) {
            std::vector<std::uint32_t> loop;
            for (std::uint32_t at = i; !done[at]; at = next[at].at(k)) {
                done[at] = true;
                loop.push_back(at);
            }
            if (loop.size() > 2) addFace(loop, k);
        }
    }
    for (std::uint32_t i = 0; i < points.size(); ++i) addFace({i, next[i][0], next[next[i][0]][1]}, 2);
    return snub;
}

}  // namespace oval4d::polytopes
