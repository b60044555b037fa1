#pragma once
// Slices a field into closed surfaces. Replaces the field by the piecewise linear interpolation of its values on a
// lattice.

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

/// Slices the interpolated field by one hyperplane at a time. The function is linear in each pentatope (4-simplex) of
/// the lattice (see kuhn_sections.hpp). The section of a pentatope by the hyperplane is divided into tetrahedra. The
/// part of a tetrahedron that belongs to the body of the level (see fields::Inside) is bounded by at most two triangles
/// of the level set and by parts of the faces of the tetrahedron. Those parts of faces that lie on the boundary of the
/// domain become caps.
///
/// The surface is closed in spite of rounding errors, for two reasons. First, each of its points is the intersection of
/// a lattice simplex with the hyperplane and the level set, and is identified by this simplex. Second, all decisions
/// are made for a lattice point (whether it lies above the hyperplane) or a lattice edge (whether the point where it
/// crosses the hyperplane is inside the body), so that they agree in all pentatopes with this point or edge. Lattice
/// points in the hyperplane count as above it, and points whose value equals the level as outside. If all samples have
/// values, the surface is a 2-manifold, because it separates the inside points of a triangulated 3-manifold from the
/// others. Triangles may have zero area.
///
/// Samples that are NaN or infinite have no value (see FieldLattice::sample()). Pentatopes with such a corner do not
/// belong to the body; they form holes, and the body has caps there. Parts of the body that touch along an edge of a
/// hole share this edge.
///
/// Reuses its memory. Only one thread at a time may use a slicer.
class ClosedSurfaceSlicer {
  public:
    /// The default number of lattice cells along the longest side of the domain of a formula.
    static constexpr int kFormulaCells = 64;

    struct IsosurfaceOptions {
        double level = 0;  ///< the value of the function on the surface
        fields::Inside inside = fields::Inside::below;
        std::size_t maxTriangles = 5'000'000;  ///< including those of the caps
        bool pointData = false;  ///< whether ClosedSurface::values and ClosedSurface::gradients are needed
        /// Called often, on the thread that called slice(). May read the triangles found so far in `out`. If it returns
        /// true or throws, the slicer stops early. May be null.
        std::function<bool()> mustStop = nullptr;
    };

    /// `cells` is the number of lattice cells along the longest side of the domain of a formula; it is ignored for an
    /// array. `field` must outlive this object.
    ClosedSurfaceSlicer(const fields::Field& field, const geometry::Rotation& orientation, int cells = kFormulaCells)
        : lattice_(field, orientation, cells) {}

    /// Slices the rotated field by the hyperplane at `w`. If the hyperplane contains a facet of the domain, the slice
    /// is the limit of those inside the domain. Overwrites `out`, which is incomplete after an error. Error:
    /// `too_large` if there are more than IsosurfaceOptions::maxTriangles triangles, or if `mustStop` returns true.
    /// Throws what `mustStop` throws.
    Result<std::monostate> slice(double w, const IsosurfaceOptions& options, ClosedSurface& out);

    /// Returns the lattice on which the field is sampled.
    const FieldLattice& lattice() const { return lattice_; }

  private:
    static constexpr int kBrick = 4;                  // cells along each side of a brick, which is sampled as a whole
    static constexpr std::size_t kBrickPoints = 625;  // (kBrick + 1)⁴

    enum class RunStatus : std::uint8_t { working, too_large, stopped };
    using Triangle = std::array<std::uint32_t, 3>;

    // A box of lattice cells: along each axis, those from `first` up to, but not including, `end`.
    struct CellRange {
        glm::ivec4 first, end;
    };
    // Where the hyperplane crosses an edge of a pentatope.
    struct PentatopeEdgeCrossing {
        double t = 0;         // the position along the edge: 0 at its first end, 1 at its second
        double value = 0;     // the interpolated value of the function there; negated if sign_ is −1
        bool inside = false;  // whether the crossing is inside the body
    };
    // A pentatope that the hyperplane meets.
    struct CutPentatope {
        const Pentatope* shape;
        glm::ivec4 cell;
        std::array<double, 5> heights, values;  // per corner: its height above the hyperplane, its value
        std::array<std::array<PentatopeEdgeCrossing, 5>, 5>
            crossings;  // [i][j], i < j: on the edge between corners i and j
        bool positive;  // the argument `positive` of sectionOf()
    };

    double movedIntoDomain(double w) const;
    void cutRange(const CellRange& range);
    bool meetsHyperplane(const CellRange& range) const;
    bool touchesBoundary(const CellRange& range) const;
    void cutBrick(const CellRange& range);
    void cutCell(glm::ivec4 cell, const std::array<double, 16>& heights, const std::array<double, 16>& values);
    void cutPentatope(const CutPentatope& cut, unsigned above, unsigned boundaryFacets);
    void addCapAtNanCorner(const CutPentatope& cut, unsigned above, std::size_t hole);
    void findCrossings(CutPentatope& cut, unsigned above) const;
    void addLevelSet(const CutPentatope& cut, const SectionTetrahedron& tetrahedron, unsigned inside);
    void addGradients(const CutPentatope& cut, std::size_t first);
    void addCap(const CutPentatope& cut, const SectionTetrahedron& tetrahedron, std::size_t face, bool reversed);
    std::uint32_t pointOn(const CutPentatope& cut, const PentatopeEdge& edge);
    std::uint32_t pointBetween(const CutPentatope& cut, const PentatopeEdge& inner, const PentatopeEdge& outer);
    glm::dvec3 position(const CutPentatope& cut, const PentatopeEdge& edge) const;
    std::uint64_t keyOf(const CutPentatope& cut, unsigned corners) const;
    double signedValueOrNan(float sample) const;

    FieldLattice lattice_;
    // The state of the current slice. If the body is above the level, values and level are negated, so that the body is
    // always below the level.
    IsosurfaceOptions options_;
    double level_ = 0, sign_ = 1;
    // Per axis and lattice index along this axis: the term that this index adds to the height of a lattice point above
    // the hyperplane.
    std::array<std::vector<double>, 4> heights_;
    RunStatus status_ = RunStatus::working;
    std::size_t visits_ = 0;
    KeyNumbering numbers_;
    std::vector<Triangle> caps_;
    ClosedSurface* out_ = nullptr;
};

}  // namespace oval4d::slicing
