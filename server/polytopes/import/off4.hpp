#pragma once
// Reads 4OFF files.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "polytopes/import/polygon_soup.hpp"
#include "text_files/file_error.hpp"

namespace oval4d::polytopes {

/// The contents of a 4OFF file.
struct Off4 {
    PolygonSoup soup;
    std::uint32_t edges = 0;  ///< the number of edges that the file states
    /// The fault of the first record that is too short for its line, if the file has a line for each record. The
    /// records were then read without regard to lines. If the result is not a polytope, this is the reason.
    std::optional<text_files::FileError> shortRecord;
};

/// Reads the text of a 4OFF file, as importPolytope() describes it. Records are first taken to begin on a line of their
/// own, so that whatever follows them on the line is ignored. If the file cannot be read so, the records of a kind may
/// follow each other without regard to lines, as Geomview reads them. Throws a FileError if the file is malformed, or
/// has more than `maxVertices` vertices. If the file has a line for each record, the error names the first record that
/// is too short for its line.
Off4 readOff4(std::string_view text, std::size_t maxVertices);

/// Returns whether the file begins with the keyword of an OFF file, such as 4OFF, COFF or 4off.
bool isOff(std::string_view text);

}  // namespace oval4d::polytopes
