#pragma once
// Surfaces for tests, as meshes of quadrilaterals.

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "geometry/surface_mesh.hpp"
#include "slicing/object.hpp"

namespace oval4d::support {

/// Makes a mesh of `columns` × `rows` quadrilaterals. `place` returns the position of the vertex in a column and a row.
/// `number` maps a column from 0 to `columns` and a row from 0 to `rows` to the index of a vertex. So `number`
/// determines how the sides of the mesh are joined.
template <typename Place, typename Number>
slicing::SurfacePtr surfaceOf(const std::string& name, std::uint32_t columns, std::uint32_t rows,
                              std::uint32_t vertexCount, Place place, Number number) {
    std::vector<glm::dvec4> vertices(vertexCount);
    geometry::JaggedArray faces;
    for (std::uint32_t i = 0; i <= columns; ++i) {
        for (std::uint32_t j = 0; j <= rows; ++j) vertices[number(i, j)] = place(i, j);
    }
    for (std::uint32_t i = 0; i < columns; ++i) {
        for (std::uint32_t j = 0; j < rows; ++j)
            faces.add(std::vector{number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)});
    }
    return std::make_shared<const geometry::SurfaceMesh>(
        geometry::makeSurfaceMesh(name, std::move(vertices), std::move(faces)));
}

/// Returns the product of two regular polygons with `sides` and `otherSides` sides, in the planes xy and zw. Both
/// polygons have the circumradius √½. So all vertices lie on the Clifford torus, and the quadrilaterals are flat.
inline slicing::SurfacePtr cliffordTorus(std::uint32_t sides, std::uint32_t otherSides) {
    const auto place = [=](std::uint32_t i, std::uint32_t j) {
        const double a = 2 * std::numbers::pi * (i % sides) / sides;
        const double b = 2 * std::numbers::pi * (j % otherSides) / otherSides;
        return std::sqrt(0.5) * glm::dvec4(std::cos(a), std::sin(a), std::cos(b), std::sin(b));
    };
    return surfaceOf("torus", sides, otherSides, sides * otherSides, place,
                     [=](std::uint32_t i, std::uint32_t j) { return i % sides * otherSides + j % otherSides; });
}

/// Returns a Klein bottle, which R⁴ contains without self-intersections. `columns` and `rows` are the numbers of
/// quadrilaterals along and around the tube. The quadrilaterals are not flat.
inline slicing::SurfacePtr kleinBottle(std::uint32_t columns, std::uint32_t rows) {
    const auto place = [=](std::uint32_t i, std::uint32_t j) {
        const double u = 2 * std::numbers::pi * i / columns, v = 2 * std::numbers::pi * j / rows;
        const double r = 2 + std::cos(v);
        return glm::dvec4(r * std::cos(u), r * std::sin(u), std::sin(v) * std::cos(u / 2),
                          std::sin(v) * std::sin(u / 2));
    };
    // After one turn, the tube is joined to its mirror image: the point with u = 2π and v is the point with u = 0 and
    // −v.
    return surfaceOf("Klein bottle", columns, rows, columns * rows, place, [=](std::uint32_t i, std::uint32_t j) {
        return i < columns ? i * rows + j % rows : (rows - j % rows) % rows;
    });
}

/// Returns the graph of the complex function z²: the points (x, y, Re z², Im z²) for x and y from −1 to 1. Its boundary
/// consists of 4 · `steps` edges.
inline slicing::SurfacePtr graphOfSquare(std::uint32_t steps) {
    const auto place = [=](std::uint32_t i, std::uint32_t j) {
        const double x = 2.0 * i / steps - 1, y = 2.0 * j / steps - 1;
        return glm::dvec4(x, y, x * x - y * y, 2 * x * y);
    };
    return surfaceOf("z squared", steps, steps, (steps + 1) * (steps + 1), place,
                     [=](std::uint32_t i, std::uint32_t j) { return i * (steps + 1) + j; });
}

}  // namespace oval4d::support
