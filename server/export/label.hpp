#pragma once
// Labels on bodies.

#include <optional>
#include <string>
#include <vector>

#include "export/letters.hpp"
#include "export/mesh.hpp"

namespace oval4d::exports {

/// The same text as one line and as two: whichever can be larger is taken.
class Caption {
  public:
    Caption(const std::string& name, const std::string& w);

    /// Cuts the text into the flat face that has most room for it, of a convex body whose faces are told by `cells`.
    /// Letters are at most a tenth of `size` high and the cut is at most 0.8 mm deep. False, and the mesh as it was,
    /// where letters would be less than 1 mm high or the body is not convex or too thin.
    bool engrave(Mesh& mesh, double size, const Grid& grid) const;

    /// A plate that has the text cut into its upper side, for bodies of this size: in the plane z = 0, centred in x,
    /// below the x axis.
    Mesh plate(double size, const Grid& grid) const;

  private:
    std::vector<Lettering> versions_;
};

}  // namespace oval4d::exports
