#pragma once
// Conversion of Coxeter–Dynkin diagrams to and from text: linear notation and Schläfli symbols.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "polytopes/construction/diagram.hpp"

namespace oval4d::polytopes {

/// The reason why a text names no polytope.
struct PolytopeNameError {
    enum class Reason : std::uint8_t {
        unknown,     ///< the text is neither a known name nor in a known notation; `message` may be empty
        impossible,  ///< the text is in a known notation, but describes no polytope, such as "2,5-duoprism", or is too
                     ///< long
        too_large,   ///< the polytope has too many vertices, or is built from convex hulls of too many points
    };
    Reason reason = Reason::unknown;
    std::string message;  ///< what is wrong and what is allowed, as a text for the user

    /// Returns an error with Reason::impossible.
    static PolytopeNameError impossible(std::string message) { return {Reason::impossible, std::move(message)}; }
};

/// Parses a diagram in linear notation (after Krieger and Klitzing): nodes x (ringed) and o with branch numbers between
/// them, as in "x5o3o3x" and "x5/2o5o3o". A blank separates connected components, as in "x5o x7o"; after "*b", the next
/// branch starts at the second node, as in "x3o3o *b3o".
///
/// Returns an error if the text has another form, if there are not four nodes, if the group is not finite, or if a
/// component has no ringed node. Also returns an error if a branch with an even denominator joins two ringed nodes,
/// because the polygons of such a branch would cover themselves twice.
std::variant<CoxeterDiagram, PolytopeNameError> parseDiagram(std::string_view text);

/// Parses Schläfli symbols of regular and truncated polytopes and of their products: "{3,3,5}", "t0,1{4,3,3}",
/// "r{3,3,3}", "{5}×{7}", "t{4,3}×{}"; "x" may replace "×". Returns the same errors as parseDiagram().
std::variant<CoxeterDiagram, PolytopeNameError> parseSchlaefli(std::string_view text);

/// Returns the diagram in linear notation, such as "x3o4o3o", in the order of its mirrors.
std::string linearNotationOf(const CoxeterDiagram& diagram);

/// Returns the Schläfli symbol, such as "{3,3,5}", "t0,1{4,3,3}", "t0,1{4,3}×{}" or "{5}×{7}". Returns an empty string
/// if a connected component of the diagram is not a chain.
std::string schlaefliOf(const CoxeterDiagram& diagram);

/// Returns the branch as text, such as "5" or "5/2".
std::string textOf(DiagramBranch branch);

/// Parses a branch such as "5" or "5/2": an integer of at least 2, or a fraction in lowest terms greater than 2.
/// Returns an empty optional for other texts, and if the numerator is greater than 1,000,000.
std::optional<DiagramBranch> parseBranch(std::string_view text);

}  // namespace oval4d::polytopes
