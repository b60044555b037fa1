#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "polytopes/construction/diagram.hpp"

namespace oval4d::polytopes {

struct Polytope;

/// An interface that builds one polytope on request, and returns properties of the polytope without building it. Each
/// family of polytopes has a derived class.
class Recipe {
  public:
    virtual ~Recipe() = default;

    /// Returns the numbers of elements of the polytope. If build() computes a convex hull, the numbers are estimates.
    virtual ElementCounts countElements() const = 0;

    /// The value that symmetryOrder() returns if the order is not known.
    static constexpr std::uint64_t kUnknownOrder = 0;
    /// Returns the order of the full symmetry group, which includes reflections, or kUnknownOrder.
    virtual std::uint64_t symmetryOrder() const = 0;

    /// Returns the total number of points of all convex hulls that build() computes, or an estimate. Returns 0 if
    /// build() computes no convex hull.
    virtual std::uint64_t hullPointCount() const { return 0; }

    /// Returns the Coxeter–Dynkin diagram in linear notation, such as "x3o4o3o" or, for a snub, "s3s4o3o". Returns an
    /// empty string if there is none.
    virtual std::string linearNotation() const { return {}; }

    /// Returns the Schläfli symbol, such as "{3,4,3}". Returns an empty string if there is none.
    virtual std::string schlaefli() const { return {}; }

    /// Builds the polytope, centered at the origin, and gives it this name. Throws std::invalid_argument if the
    /// polytope cannot be built, for example because elements would coincide.
    virtual Polytope build(const std::string& name) const = 0;
};

/// A polytope that can be built: its name and its recipe. Designs with equal names build equal polytopes; caches use
/// the name as their key.
struct PolytopeDesign {
    std::string name;  ///< the name of the polytope, such as "truncated tesseract" or "5,7-duoprism"
    std::shared_ptr<const Recipe> recipe;
};

}  // namespace oval4d::polytopes
