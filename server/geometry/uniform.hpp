#pragma once
// The uniform polychora that have a name of their own and a diagram.

#include <span>
#include <string_view>

namespace oval4d::geometry {

struct UniformPolychoron {
    std::string_view family;      ///< "regular", "star", "uniform A4", "uniform B4", "uniform F4", "uniform H4"
    std::string_view name;        ///< "truncated tesseract"
    std::string_view bowers;      ///< Bowers' short name: "tat"
    std::string_view symbol;      ///< its diagram: "x4x3o3o"
    std::string_view others;      ///< other diagrams of it, comma between: "o3x3o *b3o,o4o3x3o"
    std::string_view otherNames;  ///< comma between
};

/// The six regular ones, the ten regular stars, and the 39 others, by family. None is there twice.
std::span<const UniformPolychoron> uniformPolychora();

}  // namespace oval4d::geometry
