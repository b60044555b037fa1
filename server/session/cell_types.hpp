#pragma once
// Hiding, fading and showing cells by cell type. Messages and commands call a cell type a kind.

#include <cstdint>
#include <string_view>
#include <vector>

#include "session/session.hpp"

namespace oval4d::session {

using CellTypeList = std::vector<std::uint32_t>;

/// Parses cell type numbers separated by commas, blanks or tabs: "0,2". Returns them sorted and without duplicates. An
/// empty text and "none" give an empty list. Error: `bad_expression`.
Result<CellTypeList> readCellTypes(std::string_view text);

/// Returns the cell types of `object` given by `text`: numbers, or one name, such as "hexagonal prism", which selects
/// all cell types with this name. Returns at least one cell type. Errors: `bad_expression`; `out_of_range` for a number
/// that the object has no cell type for.
Result<CellTypeList> findCellTypes(std::string_view text, const geometry::ObjectInfo& object);

/// Returns `filter` after hiding, fading or fully showing the cell types in `changed`, which must be sorted.
scene::CellTypeFilter hide(scene::CellTypeFilter filter, const CellTypeList& changed);
scene::CellTypeFilter fade(scene::CellTypeFilter filter, const CellTypeList& changed);
scene::CellTypeFilter reveal(scene::CellTypeFilter filter, const CellTypeList& changed);

/// Replaces the lists of hidden and faded cell types by those that `set` contains. If it contains only one list, the
/// cell types in it are removed from the other list; a cell type in both lists is hidden. Error: `out_of_range` for a
/// number that the object has no cell type for.
Result<std::monostate> setCellTypes(State& state, const Set& set);

}  // namespace oval4d::session
