#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "polytopes/construction/diagram.hpp"

namespace oval4d::polytopes {

struct Polytope;

/// Builds one polytope, and computes its properties without building it. There is a derived class for each family of
/// polytopes.
class Recipe {
  public:
    virtual ~Recipe() = default;

    /// Returns the numbers of elements.
    virtual ElementCounts counts() const = 0;

    /// Returns the order of the full symmetry group, which includes reflections.
    virtual std::uint64_t symmetryOrder() const = 0;

    /// Returns the Coxeter–Dynkin diagram in linear notation; empty if there is none.
    virtual std::string linearNotation() const { return {}; }

    /// Returns the Schläfli symbol; empty if there is none.
    virtual std::string schlaefli() const { return {}; }

    /// Builds the polytope and gives it this name. The polytope is centered at the origin. Throws std::invalid_argument
    /// if the polytope cannot be built, for example because elements would coincide.
    virtual Polytope build(const std::string& name) const = 0;
};

/// A polytope that can be built: its canonical name and its recipe. All texts that denote the same polytope give a
/// design with the same name.
struct Design {
    std::string name;  ///< "truncated tesseract", "5,7-duoprism"
    std::shared_ptr<const Recipe> recipe;
};

}  // namespace oval4d::polytopes
