#pragma once
// Hides, fades and shows cells by cell type. Messages and commands call a cell type a kind.

#include <cstdint>
#include <string_view>
#include <vector>

#include "session/session.hpp"

namespace oval4d::session {

/// Indices into ObjectInfo::cellTypes.
using CellTypeList = std::vector<std::uint32_t>;

/// Parses cell type numbers separated by commas, blanks or tabs, such as "0,2". Returns them sorted and without
/// duplicates; for an empty string and for "none", returns an empty list. Error: `bad_expression` for any other text.
Result<CellTypeList> parseCellTypes(std::string_view text);

/// Returns the cell types of `object` that `text` selects, at least one. `text` has the form that parseCellTypes()
/// accepts, or it is one name, such as "hexagonal prism", which selects all cell types with this name. Errors:
/// `bad_expression` if `text` is neither; `out_of_range` if the object has no cell type with one of the numbers.
Result<CellTypeList> findCellTypes(std::string_view text, const geometry::ObjectInfo& object);

/// hide(), fade() and reveal() return `filter`, changed so that the cell types in `changed` are hidden, faded or fully
/// visible, respectively. The caller must ensure that `changed` is sorted.
scene::CellTypeFilter hide(scene::CellTypeFilter filter, const CellTypeList& changed);
scene::CellTypeFilter fade(scene::CellTypeFilter filter, const CellTypeList& changed);
scene::CellTypeFilter reveal(scene::CellTypeFilter filter, const CellTypeList& changed);

/// Replaces the lists of hidden and faded cell types in `state` by those that `set` contains. If `set` contains only
/// one list, removes the cell types in this list from the other list of `state`. A cell type that is in both lists of
/// `set` is hidden. Error: `out_of_range` if the object has no cell type with one of the numbers; `state` is then
/// unchanged.
Result<std::monostate> applyCellTypeVisibility(State& state, const Set& set);

}  // namespace oval4d::session
