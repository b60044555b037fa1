#pragma once
// Reads objects from the text of files.

#include <string>
#include <string_view>
#include <vector>

#include "errors/error.hpp"
#include "session/command.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// An object that was read from a file, and one warning for each fault that was corrected in the file.
struct LoadedObject {
    slicing::Object object;
    std::vector<std::string> warnings;
};

/// Reads an object from the text of a file, in the calling process (a FileReader of object_loader.hpp may do so in
/// another process). `format` is "off", "points" or "cloud"; `name` becomes the object's name. Errors:
/// `unsupported_format`, `bad_polytope` (with the line number, if the fault is in a line), `too_large`.
Result<LoadedObject> readObject(std::string_view format, std::string_view text, const std::string& name,
                                const Limits& limits);

/// Returns the format of a file, which its first word determines: "off" if that ends with OFF, as 4OFF does; "cloud" if
/// it is CLOUD; otherwise "points".
std::string_view detectFormat(std::string_view text);

/// Checks the name and the format of `load`, but not its data. Returns nothing if they are valid, else an error:
/// `bad_message` for a malformed name, `bad_polytope` for a name that already denotes a polytope, or
/// `unsupported_format`.
std::optional<Error> checkLoad(const Load& load, const Limits& limits);

/// Returns whether reading this format includes computing a convex hull, which takes longer than reading a polytope's
/// faces and cells from the file.
bool buildsHull(std::string_view format);

}  // namespace oval4d::session
