#pragma once
// Finds the closed surfaces that bound a region of a scalar field in its slices. The field is sampled on a lattice, and
// interpolated linearly between the samples.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <variant>
#include <vector>

#include <glm/gtc/type_precision.hpp>

#include "errors/error.hpp"
#include "fields/field.hpp"
#include "fields/inside.hpp"
#include "geometry/rotation.hpp"
#include "slicing/closed_surfaces/closed_surface.hpp"
#include "slicing/closed_surfaces/field_lattice.hpp"
#include "slicing/closed_surfaces/key_numbering.hpp"
#include "slicing/closed_surfaces/kuhn_sections.hpp"

namespace oval4d::slicing {

/// Slices a field by one hyperplane at a time. The field is interpolated between its samples on a lattice. The
/// interpolated function is linear in each pentatope (4-simplex) of the lattice (see kuhn_sections.hpp). The section of
/// a pentatope by the hyperplane is divided into tetrahedra. The body is the region where the function is below the
/// level, or above it (see fields::BodySide). In a tetrahedron, the body is bounded by at most two triangles of the
/// level set and by parts of the faces of the tetrahedron. The parts of faces that lie on the boundary of the domain
/// become caps.
///
/// The surface is closed in spite of rounding errors, for two reasons. First, each point of the surface is identified
/// by the simplex of the lattice in which it lies. The simplex is an edge that the hyperplane crosses, or a triangle or
/// tetrahedron in which the hyperplane meets the level set in one point. Second, every decision is made for a lattice
/// point (whether the point lies above the hyperplane) or for a lattice edge (whether the point where the edge crosses
/// the hyperplane is inside the body). So all pentatopes that share a lattice point or edge decide the same. Lattice
/// points in the hyperplane count as above it. Points whose value equals the level count as outside. If all samples
/// have values, the surface is a 2-manifold, because it separates the inside vertices of a triangulated 3-manifold from
/// the other vertices. Triangles may have zero area.
///
/// A sample without a value is NaN or, in an array, infinite (see FieldLattice::sample()). Pentatopes that have a
/// corner without a value do not belong to the body. They form holes, and the body has caps at their boundaries. Parts
/// of the body that touch only along an edge of a hole share this edge, so the surface is not a manifold there.
///
/// A slicer keeps its memory for the next slice. Only one thread at a time may use it.
class ClosedSurfaceSlicer {
  public:
    /// The default number of lattice cells along the longest side of the domain of a formula.
    static constexpr int kFormulaCells = 64;

    /// Says which surface to extract, and limits the work.
    struct IsosurfaceOptions {
        double level = 0;  ///< the value of the function on the surface
        fields::BodySide inside = fields::BodySide::below;
        std::size_t maxTriangles = 5'000'000;  ///< the maximum number of triangles, including those of the caps
        bool pointData = false;  ///< whether ClosedSurface::values and ClosedSurface::gradients are needed
        /// A function that slice() calls often, on the calling thread. The function may read the triangles found so far
        /// in the argument `out` of slice(). If it returns true or throws, slice() stops early. May be null.
        std::function<bool()> mustStop = nullptr;
    };

    /// Prepares to slice `field`, rotated by `orientation`. `cells` is the number of lattice cells along the longest
    /// side of the domain of a formula; it is ignored for an array. `field` must outlive this object.
    ClosedSurfaceSlicer(const fields::Field& field, const geometry::Rotation& orientation, int cells = kFormulaCells)
        : lattice_(field, orientation, cells) {}

    /// Cuts the rotated field by the hyperplane at `w`, and writes the boundary of the body to `out`. If the hyperplane
    /// contains a facet of the domain, cuts the field just inside the domain instead. Overwrites `out`, which is
    /// incomplete after an error. Error: `too_large` if there are more than IsosurfaceOptions::maxTriangles triangles,
    /// or if `mustStop` returns true. Throws what `mustStop` throws.
    Result<std::monostate> slice(double w, const IsosurfaceOptions& options, ClosedSurface& out);

    /// Returns the lattice on which the field is sampled.
    const FieldLattice& lattice() const { return lattice_; }

  private:
    // The greatest number of cells along each side of a brick, a block of the lattice that is sampled at once.
    static constexpr int kBrick = 4;
    static constexpr std::size_t kBrickPoints = 625;  // the lattice points of the largest brick: (kBrick + 1)⁴

    enum class ExtractionStatus : std::uint8_t { working, too_large, stopped };
    using Triangle = std::array<std::uint32_t, 3>;

    // A box of lattice cells. Along each axis, it has the cells from `first` up to, but not including, `end`.
    struct LatticeCellBox {
        glm::ivec4 first, end;
    };
    // The point where the hyperplane crosses an edge of a pentatope.
    struct PentatopeEdgeCrossing {
        double t = 0;         // the position of the point along the edge: 0 at the first end, 1 at the second
        double value = 0;     // the interpolated value of the function at the point; negated if sign_ is −1
        bool inside = false;  // whether the point is inside the body
    };
    // A pentatope that the hyperplane meets.
    struct CutPentatope {
        const Pentatope* shape;
        // The lattice cell of which the pentatope is a part.
        glm::ivec4 cell;
        std::array<double, 5> heights, values;  // per corner: its height above the hyperplane; signedValueOrNan() there
        std::array<std::array<PentatopeEdgeCrossing, 5>, 5>
            crossings;  // [i][j], for i < j: the crossing of the edge between corners i and j
        bool positive;  // the argument `positive` for pentatopeSection(): the orientation of the pentatope
    };

    double movedIntoDomain(double w) const;
    void cutRange(const LatticeCellBox& range);
    bool meetsHyperplane(const LatticeCellBox& range) const;
    bool touchesBoundary(const LatticeCellBox& range) const;
    void cutBrick(const LatticeCellBox& range);
    void cutCell(glm::ivec4 cell, const std::array<double, 16>& heights, const std::array<double, 16>& values);
    void cutPentatope(const CutPentatope& cut, unsigned above, unsigned boundaryFacets);
    void addCapAtNanCorner(const CutPentatope& cut, unsigned above, std::size_t hole);
    void findCrossings(CutPentatope& cut, unsigned above) const;
    void addLevelSet(const CutPentatope& cut, const SectionTetrahedron& tetrahedron, unsigned inside);
    void addGradients(const CutPentatope& cut, std::size_t first);
    void addCap(const CutPentatope& cut, const SectionTetrahedron& tetrahedron, std::size_t face, bool reversed);
    std::uint32_t findOrAddPointOn(const CutPentatope& cut, const PentatopeEdge& edge);
    std::uint32_t findOrAddPointBetween(const CutPentatope& cut, const PentatopeEdge& inner,
                                        const PentatopeEdge& outer);
    glm::dvec3 crossingPosition(const CutPentatope& cut, const PentatopeEdge& edge) const;
    std::uint64_t simplexKeyOf(const CutPentatope& cut, unsigned corners) const;
    double signedValueOrNan(float sample) const;

    FieldLattice lattice_;
    // The options of the current slice. If the body lies above the level, sign_ is −1, and the values and the level are
    // negated, so that the body always lies below the level.
    IsosurfaceOptions options_;
    double level_ = 0, sign_ = 1;
    // The height of the lattice point (i, j, k, l) above the hyperplane is heights_[0][i] + heights_[1][j] +
    // heights_[2][k] + heights_[3][l].
    std::array<std::vector<double>, 4> heights_;
    ExtractionStatus status_ = ExtractionStatus::working;
    std::size_t visits_ = 0;
    KeyNumbering numbers_;
    std::vector<Triangle> caps_;
    ClosedSurface* out_ = nullptr;
};

}  // namespace oval4d::slicing
