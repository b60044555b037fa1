#include "polytopes/construction/prism_over.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/jagged_array.hpp"

namespace oval4d::polytopes {

Polytope prismOver(std::string name, const PolyhedronWithFaceOrbits& base) {
    const auto n = static_cast<std::uint32_t>(base.vertices.size());
    const auto m = static_cast<std::uint32_t>(base.faces.size());
    std::vector<glm::dvec4> vertices;
    for (const double w : {-1.0, 1.0}) {
        for (const glm::dvec3& v : base.vertices) vertices.emplace_back(v, w);
    }
    geometry::JaggedArray faces;  // the faces of the two bases, then a rectangle for each edge of the base
    for (const std::uint32_t shift : {0U, n}) {
        for (std::size_t f = 0; f < m; ++f) {
            std::vector<std::uint32_t> loop(base.faces[f].begin(), base.faces[f].end());
            for (std::uint32_t& v : loop) v += shift;
            faces.add(loop);
        }
    }
    geometry::JaggedArray cells;
    std::vector<std::uint32_t> bottom(m);
    std::vector<std::uint32_t> cellTypes;
    for (const std::uint32_t shift : {0U, m}) {
        for (std::uint32_t f = 0; f < m; ++f) bottom[f] = f + shift;
        cells.add(bottom);
        cellTypes.push_back(0);
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> lateralFaces;
    for (std::uint32_t f = 0; f < m; ++f) {
        const auto loop = base.faces[f];
        std::vector<std::uint32_t> own{f, f + m};
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const auto [a, b] = std::minmax(loop[i], loop[(i + 1) % loop.size()]);
            const auto [square, fresh] = lateralFaces.try_emplace({a, b}, static_cast<std::uint32_t>(faces.size()));
            if (fresh) faces.add(std::array{a, b, b + n, a + n});
            own.push_back(square->second);
        }
        cells.add(own);
        cellTypes.push_back(1 + base.orbits[f]);
    }
    return makePolytope(std::move(name), std::move(vertices), std::move(faces), std::move(cells), std::move(cellTypes));
}

}  // namespace oval4d::polytopes
