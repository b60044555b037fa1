#pragma once
// Finds the elements of an object, and the parts of its edges, that lie behind its cells, as an eye in four dimensions
// sees them.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "geometry/cell_complex.hpp"
#include "slicing/projected_cells.hpp"

namespace oval4d::slicing {

/// Which elements of a cell complex are drawn.
struct DrawnElements {
    /// A part of an edge that is seen. `from` and `to` are the places where the part begins and ends, as fractions of
    /// the projected edge. At the ends of the edge, they are exactly 0 and 1.
    struct EdgePart {
        std::uint32_t edge;
        double from, to;
    };
    std::vector<bool> vertices, faces;  ///< an entry for each vertex and each 2-face, true if it is drawn
    std::vector<EdgePart> edgeParts;    ///< those of one edge follow each other, from its beginning to its end
};

/// For each cell of a complex: whether its elements may be drawn, and whether it hides what lies behind it.
struct DrawnAndHidingCells {
    std::vector<bool> drawn, hides;
};

/// Finds what lies behind the cells of a cell complex: vertices, parts of edges, and whole 2-faces. A 2-face of which
/// only a part lies behind cells counts as seen. A cell does not hide the elements that it contains; ProjectedCells
/// describes which other points it hides. Reuses its memory. Only one thread at a time may use an occlusion finder.
class OcclusionFinder {
  public:
    /// The default limit on the number of steps (see findDrawnElements()). This many steps take a few tenths of a
    /// second.
    static constexpr std::size_t kDefaultSteps = 50'000'000;

    /// Finds what is drawn of `complex`; `images` has the image of each vertex, as ProjectedCells describes it. Only
    /// elements of cells whose entry in DrawnAndHidingCells::drawn is true are drawn, and of these:
    /// - if `withFaces`, the 2-faces that are not wholly hidden; otherwise, no 2-face;
    /// - the parts of edges that are not hidden;
    /// - the vertices that are not hidden.
    ///
    /// An edge is divided where a cell begins or ceases to hide it, so that its parts are exact. In a 2-face, the
    /// visible parts are bounded by three kinds of lines:
    /// - the sides of the 2-face;
    /// - the lines in which cells pass through the 2-face;
    /// - the projections of other 2-faces at which the boundary of the body turns away from the eye.
    ///
    /// The 2-face is hidden if both sides of all these lines are hidden. Visible parts narrower than about 10⁻⁶ of the
    /// size of the projection may be overlooked.
    ///
    /// `steps` limits the time. A step is the comparison of a part of an element with a cell or with a triangle of the
    /// boundary of a cell. Returns false if the steps are too few; then `out` is not valid. If the steps are fewer than
    /// the pairs of a hiding cell and an element to be tested, returns false at once.
    bool findDrawnElements(const geometry::CellComplex& complex, std::span<const glm::dvec4> images,
                           const DrawnAndHidingCells& roles, bool withFaces, std::size_t steps, DrawnElements& out);

  private:
    using Box = ProjectedCells::Box;
    using Occluder = ProjectedCells::Occluder;
    using Triangle = ProjectedCells::Triangle;

    // A 2-face at which cells may begin or cease to hide what is behind them: in the projection, its two cells may lie
    // on the same side of the 2-face. `box` contains the projection of the 2-face, and `top` is the largest fourth
    // coordinate of its vertices.
    struct SilhouetteFace {
        std::uint32_t face;
        Box box;
        double top;
    };
    // The image of the plane of a 2-face: the point with the coordinates (x, y) is origin + x · right + y · up. Without
    // their fourth coordinates, `right` and `up` are orthonormal.
    struct ProjectedFaceFrame {
        glm::dvec4 origin, right, up;
        glm::dvec4 pointAt(const glm::dvec2& p) const { return origin + p.x * right + p.y * up; }
        glm::dvec2 coordinatesOf(const glm::dvec4& point) const;
    };

    void findSilhouetteFaces(const std::vector<bool>& hides);
    int orientationSignOfCell(std::uint32_t cell) const;

    bool isFaceHidden(std::uint32_t face);
    bool findFaceFrame(std::span<const std::uint32_t> loop);
    bool isSeenBesideHyperplane(const Occluder& occluder);
    bool isSeenBesideTriangle(const Triangle& triangle);
    bool isSeenBeside(const glm::dvec2& from, const glm::dvec2& to);

    // The cell complex that findDrawnElements() searches; cells_ has its cells.
    const geometry::CellComplex* complex_ = nullptr;
    ProjectedCells cells_;
    std::vector<SilhouetteFace> silhouetteFaces_;

    ProjectedFaceFrame faceFrame_{};         // the image of the plane of the tested 2-face
    std::vector<glm::dvec2> outline_;        // the vertex loop of the tested 2-face
    std::vector<std::uint32_t> candidates_;  // the indices of the occluders that may hide parts of the element
    std::vector<double> places_;             // the places at which a line crosses outline_, as fractions of the line
    std::vector<ProjectedCells::SegmentPart> visibleParts_;  // the visible parts of the tested edge
};

}  // namespace oval4d::slicing
