#pragma once
// Functions that hide, fade and show cells by cell type, such as all cubes. Messages and commands call a cell type a
// "kind".

#include <cstdint>
#include <string_view>
#include <vector>

#include "session/session.hpp"

namespace oval4d::session {

/// Indices of cell types in the list ObjectInfo::cellTypes of an object.
using CellTypeList = std::vector<std::uint32_t>;

/// Parses cell type numbers separated by commas, blanks or tabs, such as "0,2". Returns the numbers sorted and without
/// duplicates. Returns an empty list for an empty string and for "none". Error: `bad_expression` for any other text.
Result<CellTypeList> parseCellTypes(std::string_view text);

/// Returns the cell types of `object` that `text` selects, at least one. `text` is a list of numbers as in
/// parseCellTypes(), or one name. A name, such as "hexagonal prism", selects all cell types with this name or, if there
/// are none, with another name of the same solid. Errors: `bad_expression` if `text` is neither a list nor such a name;
/// `out_of_range` if the object has no cells, or no cell type with one of the numbers.
Result<CellTypeList> findCellTypes(std::string_view text, const geometry::ObjectInfo& object);

/// hideCellTypes() returns `filter`, changed so that the cell types in `changed` are hidden. fadeCellTypes() makes
/// these cell types faded (translucent), and revealCellTypes() makes them fully visible. `changed` must be sorted.
scene::CellTypeFilter hideCellTypes(scene::CellTypeFilter filter, const CellTypeList& changed);
scene::CellTypeFilter fadeCellTypes(scene::CellTypeFilter filter, const CellTypeList& changed);
scene::CellTypeFilter revealCellTypes(scene::CellTypeFilter filter, const CellTypeList& changed);

/// Replaces the lists of hidden and faded cell types in `state` by the lists in `set`. If `set` has only one of the two
/// lists, its cell types are removed from the other list of `state`. A cell type in both lists of `set` becomes hidden.
/// Error: `out_of_range` if the object has no cell type with one of the numbers; `state` is then unchanged.
Result<std::monostate> applyCellTypeVisibility(State& state, const ChangeSettings& set);

}  // namespace oval4d::session
