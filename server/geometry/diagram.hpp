#pragma once
// Coxeter–Dynkin diagrams of four mirrors, and what follows from them without building anything.

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace oval4d::geometry {

/// Why a text names no polytope.
struct NameError {
    enum class Reason : std::uint8_t {
        unknown,     ///< no name and no notation; `message` is empty
        impossible,  ///< a notation that is understood but makes no polytope, such as "2,5-duoprism"
        too_large,   ///< one of more vertices than allowed
    };
    Reason reason = Reason::unknown;
    std::string message;  ///< what is wrong and what is allowed
};

/// A branch of a diagram: the mirrors at its two ends meet at π·denominator / numerator. Also the regular polygon
/// {numerator/denominator}, a star where the denominator is not 1.
struct Branch {
    int numerator = 2, denominator = 1;
    auto operator<=>(const Branch&) const = default;
};

/// Mirrors of a diagram, one bit each.
using Subset = unsigned;
inline constexpr int kMirrors = 4;
constexpr bool holds(Subset set, int mirror) { return (set >> static_cast<unsigned>(mirror) & 1U) != 0; }

/// Four mirrors and which of them are ringed: the generating vertex stands off the ringed mirrors at distance 1, so
/// that all edges are 2 long, and lies on the others.
struct Diagram {
    std::array<std::array<Branch, 4>, 4> branches;  ///< symmetric; the diagonal is not read
    std::array<bool, 4> ringed{};

    /// The linear diagram with these three branches: {p, q, r}.
    static Diagram linear(Branch p, Branch q, Branch r, std::array<bool, 4> ringed);
    auto operator<=>(const Diagram&) const = default;
};

/// A permutation of the mirrors.
using Permutation = std::array<int, 4>;

/// The diagram whose mirror i is mirror `from[i]` of this one.
Diagram permuted(const Diagram& diagram, const Permutation& from);

/// The permutations that leave branches and rings as they are, the identity first. Each is a symmetry of the polytope.
std::vector<Permutation> symmetriesOf(const Diagram& diagram);

/// The same for all diagrams that differ in the order of their mirrors only.
Diagram canonical(const Diagram& diagram);

/// The connected parts, that of the first mirror first.
std::vector<Subset> partsOf(const Diagram& diagram, Subset set = 0xf);

/// Whether every connected part of the set holds a ring: then its mirrors sweep out an element of as many dimensions
/// as they are, else one of fewer.
bool spansAnElement(const Diagram& diagram, Subset set);

/// The order of the group that these mirrors generate, or 0 where it is not finite (Coxeter, Regular Polytopes,
/// §11.5 and §14.1: the finite groups, with the star polyhedra's and polychora's generators).
std::uint64_t groupOrder(const Diagram& diagram, Subset set = 0xf);

/// The mirrors that keep the element swept out by `set` where it is: those of `set`, and the unringed ones
/// perpendicular to them all.
Subset keepersOf(const Diagram& diagram, Subset set);

/// Numbers of vertices, edges, 2-faces and cells.
struct ElementCounts {
    std::uint64_t vertices = 0, edges = 0, faces = 0, cells = 0;
    bool operator==(const ElementCounts&) const = default;
};

/// The sums over the orbits of elements, |W| / |stabiliser|. The group must be finite.
ElementCounts elementCounts(const Diagram& diagram);

/// Linear notation: nodes x (ringed) and o, with the numbers of the branches between: "x5o3o3x", "x5/2o5o3o". A blank
/// stands between unconnected parts, "x5o x7o"; "*b" goes back to the second node, "x3o3o *b3o" (after Krieger and
/// Klitzing). The diagram is one of a finite group with a ring in every part, or the error says why not.
std::variant<Diagram, NameError> parseDiagram(std::string_view text);

/// Schläfli symbols of regular and truncated polytopes and products of them: "{3,3,5}", "t0,1{4,3,3}", "r{3,3,3}",
/// "{5}×{7}", "t{4,3}×{}" ("x" for "×" too). Checked as a diagram is.
std::variant<Diagram, NameError> parseSchlaefli(std::string_view text);

/// The diagram in linear notation, in the order of its mirrors.
std::string symbolOf(const Diagram& diagram);

/// "{3,3,5}", "t0,1{4,3,3}", "t0,1{4,3}×{}", "{5}×{7}"; empty for a diagram that branches.
std::string schlaefliOf(const Diagram& diagram);

/// "5" or "5/2".
std::string textOf(Branch branch);

/// From "5" or "5/2": a whole number from 2 to 1,000,000, or a fraction in lowest terms greater than 2.
std::optional<Branch> parseBranch(std::string_view text);

}  // namespace oval4d::geometry
