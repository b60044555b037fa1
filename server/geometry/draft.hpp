#pragma once
// A polytope as a file describes it, not yet known to be sound.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/polytope.hpp"

namespace oval4d::geometry {

struct Draft {
    /// Where an element stands in the file.
    struct Origin {
        std::size_t line = 0;
        std::uint32_t number = 0;
    };

    std::vector<glm::dvec4> vertices;
    Lists faces, cells;  ///< as in Polytope
    std::vector<Origin> faceOrigins, cellOrigins;
};

/// Repairs what needs no guess, and says in `warnings` what it was. Points closer than `same` are one vertex; below 0
/// none are.
void repair(Draft& draft, double same, std::vector<std::string>& warnings);

/// Half the diagonal of the box around the vertices.
double sizeOf(const Draft& draft);

/// Throws an ImportError with the line unless 2-faces are flat, and cells lie in hyperplanes, within 5/1000 of the
/// size, and the vertices do not all lie in one.
void checkFlat(const Draft& draft);

/// makePolytope, its errors with their line.
Polytope build(Draft draft, std::string name);

}  // namespace oval4d::geometry
