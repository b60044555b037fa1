#pragma once
// Text labels on bodies.

#include <optional>
#include <string>
#include <vector>

#include "export/label/letters.hpp"
#include "export/mesh/mesh.hpp"

namespace oval4d::exports {

/// A text set in one line and in two lines; engraving uses whichever fits with larger letters.
class Caption {
  public:
    /// `name`: the title of the object. `w`: the hyperplane, as text.
    Caption(const std::string& name, const std::string& w);

    /// Engraves the text in the flat face of a convex body that allows the largest letters; `mesh.cells` identifies the
    /// faces. Letters are at most size / 10 high and at most 0.8 mm deep. Returns false and leaves the mesh unchanged
    /// if letters would be less than 1 mm high, or the body is not convex or too thin.
    bool engrave(Mesh& mesh, double size, const Grid& grid) const;

    /// A plate with the text engraved in its top side, for bodies of this size. Its bottom lies in the plane z = 0; it
    /// is centered in x and extends from y = 0 toward negative y.
    Mesh plate(double size, const Grid& grid) const;

  private:
    std::vector<Lettering> versions_;
};

}  // namespace oval4d::exports
