#pragma once
// The table of file formats.

#include <span>
#include <string_view>
#include <vector>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// Returns all formats: the rows of protocol/export_formats.json, each with its writer. The first call reads the table.
/// Throws std::logic_error if a row has no writer, or a writer has no row. Throws std::bad_optional_access if a row has
/// a value that is not allowed. Thread-safe.
std::span<const Format> formats();

/// Returns the format with this name, or nullptr if there is none.
const Format* formatNamed(std::string_view name);

/// Returns the names of all formats.
std::vector<std::string_view> formatNames();

}  // namespace oval4d::exports
