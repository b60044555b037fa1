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
struct Off4Contents {
    PolygonSoup soup;
    std::uint32_t edges = 0;  ///< the number of edges that the file states
    /// The fault of the first record whose line has too few words. Set only if the file has as many lines as records,
    /// but could be read only without regard to lines. If the elements read do not form a polytope, this fault is the
    /// probable reason.
    std::optional<text_files::FileError> shortRecord;
};

/// Reads the text of a 4OFF file, as described at importPolytope(). First assumes that each record begins on a line of
/// its own, and ignores whatever follows the record on its line. If this fails, reads the records of some or all kinds
/// without regard to lines, as Geomview does. Throws a FileError if the file is malformed, or has more than
/// `maxVertices` vertices. If the file has as many lines as records, the error names the first record whose line has
/// too few words.
Off4Contents readOff4(std::string_view text, std::size_t maxVertices);

/// Returns whether a 4OFF file has cells, that is, whether the fourth count in its header is greater than 0. A header
/// with only three counts, as in files of Geomview, means that there are no cells. Reads only the header. Throws a
/// FileError if the header is malformed.
bool listsCells(std::string_view text);

/// Returns whether the first word of the file is a keyword of the OFF formats, in upper or lower case: "OFF" after
/// digits and letters of ST, C and N, as in 4OFF, COFF or nOFF. readOff4() does not accept all of them. The number of
/// vertices may follow in the same word. Other words that begin with "off" are no keywords, because "offset" may name a
/// column of a table.
bool isOffFormat(std::string_view text);

}  // namespace oval4d::polytopes
