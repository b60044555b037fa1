#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "polytopes/construction/diagram.hpp"

namespace oval4d::polytopes {

struct Polytope;

/// Builds a polytope, and knows from theory the properties that it will have. Each family of polytopes has a derived
/// class.
class Recipe {
  public:
    virtual ~Recipe() = default;

    /// The numbers of elements.
    virtual ElementCounts counts() const = 0;

    /// The order of the full symmetry group, reflections included.
    virtual std::uint64_t symmetryOrder() const = 0;

    /// The Coxeter–Dynkin diagram in linear notation; empty if there is none.
    virtual std::string symbol() const { return {}; }

    /// The Schläfli symbol; empty if there is none.
    virtual std::string schlaefli() const { return {}; }

    /// Builds the polytope, centered at the origin. Throws std::invalid_argument if elements coincide.
    virtual Polytope build(const std::string& name) const = 0;
};

/// The canonical name of a polytope and the recipe for building it. Texts that denote the same polytope give the same
/// design.
struct Design {
    std::string name;  ///< "truncated tesseract", "5,7-duoprism"
    std::shared_ptr<const Recipe> recipe;
};

}  // namespace oval4d::polytopes
