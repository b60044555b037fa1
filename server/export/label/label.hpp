#pragma once
// Text labels that are engraved into bodies or plates.

#include <optional>
#include <string>
#include <vector>

#include "export/budget.hpp"
#include "export/label/letters.hpp"
#include "export/mesh/mesh.hpp"

namespace oval4d::exports {

/// The text of a label, laid out in one line and in two lines. engrave() uses the layout that allows larger letters.
/// makeLabelPlate() uses two lines.
class LabelText {
  public:
    /// `name` is the object's name, and `w` the position of the slice's hyperplane as text, such as "w = −0.25". Throws
    /// std::runtime_error if the font cannot be read.
    LabelText(const std::string& name, const std::string& w);

    /// Engraves the text into a convex body, on the face where the letters can be largest. Triangles with the same
    /// entry in `mesh.cells` form a face. Letters are at most size / 10 high, and from 0.25 to 0.8 mm deep. `size` is
    /// ExportRequest::size, in millimeters. Returns false and leaves the mesh unchanged if the body is not convex or is
    /// too thin, or if the letters would be less than 1 mm high. Throws ExportRefused if the time limit is exceeded or
    /// a stop was requested: the time is quadratic in the number of faces.
    bool engrave(Mesh& mesh, double size, const RoundingGrid& grid, const ExportBudget& budget) const;

    /// Returns a plate with the text engraved into its top side. Letters are size / 15 high, but at least 3 and at most
    /// 12 mm. The bottom of the plate lies in the plane z = 0. The plate is centered along x, and extends from y = 0
    /// toward negative y. `size` is ExportRequest::size, in millimeters. Throws std::runtime_error if the letters
    /// cannot be engraved.
    Mesh makeLabelPlate(double size, const RoundingGrid& grid) const;

  private:
    std::vector<TextOutlines> versions_;  // the layout in one line, and the layout in two lines
};

}  // namespace oval4d::exports
