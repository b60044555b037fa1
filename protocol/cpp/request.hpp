#pragma once
// The messages to the server, parsed: no JSON and no strings as types past this point.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/mat4x4.hpp>

#include "export/wish.hpp"
#include "geometry/rotation.hpp"
#include "scene/scene.hpp"

namespace oval4d::protocol {

// Commands: what changes a session. The same structs come from messages, from keys and from the ':' line.

struct Key {
    std::string key;  ///< as KeyboardEvent.key has it: "y", "K", "2", " ", "["
    bool shift = false, ctrl = false;
};
struct Rotate {
    geometry::Turn turn;
};
/// Every member that is present is set; the others stay.
struct Set {
    std::optional<std::string> polytope;  ///< a name or alias of the catalogue, or of a loaded polytope
    std::optional<glm::dmat4> orientation;
    std::optional<double> alpha, beta;  ///< radians
    std::optional<double> step;         ///< radians: what k, j, K and J add
    std::optional<int> count;           ///< odd
    std::optional<double> spacing;
    std::optional<int> focus;
    std::optional<scene::View> view;
    std::optional<bool> turning;
    std::optional<bool> faces, bars, balls, coordinates;
    std::optional<double> azimuth, elevation, zoom;
    std::optional<scene::Colouring> colouring;
    std::optional<std::vector<std::uint32_t>> hidden, faded;  ///< kinds of cells, in any order
    std::optional<geometry::Turn> last;  ///< what '.' repeats and space continues, as a state has it
};
struct Load {
    std::string name, format, data;
};
struct Undo {};
struct Redo {};
struct Reset {};
struct CommandLine {
    std::string line;  ///< without the ':'
};
using Command = std::variant<Key, Rotate, Set, Load, Undo, Redo, Reset, CommandLine>;

/// A colouring as the wire has it, and back; nothing for any other word.
std::string_view wireName(scene::Colouring colouring);
std::optional<scene::Colouring> colouringNamed(std::string_view name);

// The rest concerns one connection.

enum class Stream : std::uint8_t { none, geometry, frames };
enum class Encoding : std::uint8_t { json, cbor };

struct Hello {
    Stream stream = Stream::none;
    Encoding encoding = Encoding::json;
    scene::Viewport viewport;
    std::optional<std::string> token;
};
enum class What : std::uint8_t { state, slices, frame, file, catalogue, keymap };
struct Get {
    What what = What::state;
    std::optional<scene::Viewport> viewport;  ///< for slices and frames; else the connection's own
    exports::Wish file;                       ///< for a file
};
struct ShownRevision {
    std::uint64_t revision = 0;
};

struct Request {
    std::optional<double> id;  ///< echoed in the answer as it came
    std::variant<Hello, Get, ShownRevision, Command> body;
};

}  // namespace oval4d::protocol
