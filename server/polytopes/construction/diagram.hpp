#pragma once
// Coxeter–Dynkin diagrams of four mirrors, and the properties that follow from a diagram without building its polytope:
// symmetries, group orders and element counts.

#include <array>
#include <compare>
#include <cstdint>
#include <vector>

namespace oval4d::polytopes {

/// A branch of a Coxeter–Dynkin diagram. The mirrors at its two ends meet at the angle π · denominator / numerator. The
/// default value is a right angle, which drawn and written diagrams omit.
struct DiagramBranch {
    int numerator = 2, denominator = 1;
    auto operator<=>(const DiagramBranch&) const = default;
};

/// The regular polygon {numerator/denominator}. It has `numerator` sides, and is a star polygon if the denominator is
/// not 1. A polygon has the type of a branch, because a branch p/q between a ringed mirror (see CoxeterDiagram) and an
/// unringed mirror generates the polygon {p/q}.
using RegularPolygon = DiagramBranch;

/// A set of mirrors of a diagram: bit i is set if the set contains mirror i.
using MirrorSet = unsigned;
inline constexpr int kMirrors = 4;
/// Returns whether the set contains the mirror.
constexpr bool containsMirror(MirrorSet set, int mirror) { return (set >> static_cast<unsigned>(mirror) & 1U) != 0; }

/// A Coxeter–Dynkin diagram of four mirrors. It describes a uniform polytope, whose vertices are the images of one
/// point, the generating vertex, under the group that the reflections in the mirrors generate. The generating vertex
/// lies at distance 1 from each ringed mirror, so that all edges have length 2, and on all other mirrors.
struct CoxeterDiagram {
    std::array<std::array<DiagramBranch, 4>, 4> branches;  ///< branches[i][j] joins mirrors i and j; the matrix is
                                                           ///< symmetric, and its diagonal is not used
    std::array<bool, 4> ringed{};                          ///< for each mirror, whether it is ringed

    /// Returns the diagram that is a chain: the branches p, q and r join mirrors 0 and 1, 1 and 2, and 2 and 3.
    static CoxeterDiagram linear(DiagramBranch p, DiagramBranch q, DiagramBranch r, std::array<bool, 4> ringed);
    auto operator<=>(const CoxeterDiagram&) const = default;
};

/// A permutation of the mirrors.
using MirrorPermutation = std::array<int, 4>;

/// Returns a diagram with the mirrors of `diagram` in another order: its mirror i is mirror `from[i]` of `diagram`.
CoxeterDiagram permuted(const CoxeterDiagram& diagram, const MirrorPermutation& from);

/// Returns the permutations of the mirrors that preserve branches and rings, the identity first. Each permutation
/// induces a symmetry of the polytope.
std::vector<MirrorPermutation> automorphismsOf(const CoxeterDiagram& diagram);

/// Returns the canonical form of a diagram. Diagrams that differ only in the order of their mirrors have the same
/// canonical form.
CoxeterDiagram canonical(const CoxeterDiagram& diagram);

/// Returns the connected components of the mirrors in `set` (by default, of the whole diagram). The components are in
/// ascending order of their smallest mirror numbers.
std::vector<MirrorSet> componentsOf(const CoxeterDiagram& diagram, MirrorSet set = 0xf);

/// Returns whether every connected component of `set` contains a ringed mirror. If so, the n mirrors in `set` generate
/// an n-dimensional element of the polytope: the images of the generating vertex under their group are the vertices of
/// this element. Otherwise, these images span fewer than n dimensions.
bool generatesElement(const CoxeterDiagram& diagram, MirrorSet set);

/// Returns the order of the Coxeter group that the mirrors of `set` generate; 0 if the group is not finite. Branches
/// may be fractional, as in star polyhedra and star polychora (Coxeter, Regular Polytopes, §11.5 and §14.1).
std::uint64_t groupOrder(const CoxeterDiagram& diagram, MirrorSet set = 0xf);

/// Returns the mirrors that generate the stabilizer of the element that `set` generates. The stabilizer is the subgroup
/// of the diagram's Coxeter group that maps this element to itself. The result contains the mirrors of `set` and the
/// unringed mirrors that are perpendicular to all mirrors of `set`.
MirrorSet stabilizerOf(const CoxeterDiagram& diagram, MirrorSet set);

/// The numbers of vertices, edges, 2-faces and cells of a polytope.
struct ElementCounts {
    std::uint64_t vertices = 0, edges = 0, faces = 0, cells = 0;
    bool operator==(const ElementCounts&) const = default;
};

/// Returns the numbers of elements of the diagram's polytope. Each number is a sum of |W| / |stabilizer|, with one term
/// for each orbit of elements of this dimension; W is the Coxeter group. The caller must ensure that W is finite.
ElementCounts elementCounts(const CoxeterDiagram& diagram);

}  // namespace oval4d::polytopes
