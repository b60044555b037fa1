#pragma once
// Which kinds of cells are seen: hidden, faded, or shown.

#include <cstdint>
#include <string_view>
#include <vector>

#include "session/session.hpp"

namespace oval4d::session {

using KindList = std::vector<std::uint32_t>;

/// Numbers between commas or blanks: "0,2". An empty text and "none" are no kinds. Else `bad_expression`.
protocol::Result<KindList> readKinds(std::string_view text);

/// The kinds of `polytope`'s cells that `text` means: numbers, or one name, such as "hexagonal prism", which may be
/// that of several. At least one; else `bad_expression`, or `out_of_range` for a number beyond the polytope's kinds.
protocol::Result<KindList> findKinds(std::string_view text, const geometry::Polytope& polytope);

/// `kinds` with those in `changed`, in order, hidden, faded, or neither.
scene::Kinds hide(scene::Kinds kinds, const KindList& changed);
scene::Kinds fade(scene::Kinds kinds, const KindList& changed);
scene::Kinds reveal(scene::Kinds kinds, const KindList& changed);

/// Sets `hidden` and `faded` where `set` holds them. One alone takes its kinds out of the other list; where both name
/// a kind, it is hidden. `out_of_range` for a number beyond the polytope's kinds.
protocol::Result<std::monostate> setKinds(State& state, const protocol::Set& set);

}  // namespace oval4d::session
