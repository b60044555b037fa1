#pragma once
// The uniform polychora that have both a name of their own and a Coxeter–Dynkin diagram.

#include <span>
#include <string_view>

namespace oval4d::polytopes {

/// The names and diagrams of a uniform polychoron (4-D polytope).
struct NamedWythoffianPolychoron {
    std::string_view family;  ///< one of "regular", "star", "uniform A4", "uniform B4", "uniform F4", "uniform H4"
    std::string_view name;    ///< the usual name, such as "truncated tesseract"
    std::string_view bowers;  ///< Bowers' short name, such as "tat"
    std::string_view linearNotation;  ///< its diagram in linear notation, such as "x4x3o3o"
    std::string_view otherDiagrams;   ///< its other diagrams, separated by commas, such as "o3x3o *b3o,o4o3x3o"
    std::string_view otherNames;      ///< other names, separated by commas, such as "tesseract,hypercube"
};

/// Returns the six convex regular polychora, the ten regular star polychora, and 39 other convex uniform polychora,
/// ordered by family. No polychoron occurs twice.
std::span<const NamedWythoffianPolychoron> namedWythoffianPolychora();

}  // namespace oval4d::polytopes
