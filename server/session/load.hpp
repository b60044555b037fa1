#pragma once
// Reads objects from the text of files.

#include <string>
#include <string_view>
#include <vector>

#include "errors/error.hpp"
#include "session/command.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// An object that was read from a file, and one warning for each fault of the file that was corrected.
struct LoadedObject {
    slicing::Object object;
    std::vector<std::string> warnings;
};

/// Reads an object from a text in this format, in the calling process (other implementations of FileReader may use
/// another one). Errors: `unsupported_format`, `bad_polytope` (with the line number, if the fault is in a line),
/// `too_large`.
Result<LoadedObject> readObject(std::string_view format, std::string_view text, const std::string& name,
                                const Limits& limits);

/// Detects the format of a file from its first word: "off" (4OFF), "cloud" (CLOUD), or else "points".
std::string_view formatOf(std::string_view text);

/// Checks the name and the format of `load`, but not its data. Returns nothing if they are valid, else an error:
/// `bad_message` for a malformed name, `bad_polytope` for a name that already denotes a polytope, or
/// `unsupported_format`.
std::optional<Error> checkLoad(const Load& load, const Limits& limits);

/// Returns whether reading this format includes computing a convex hull, which takes longer than reading elements.
bool buildsHull(std::string_view format);

}  // namespace oval4d::session
