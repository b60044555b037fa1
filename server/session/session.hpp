#pragma once
// One session's state as a value, and commands as functions on it.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/polytope.hpp"
#include "geometry/rotation.hpp"
#include "geometry/slice_set.hpp"
#include "protocol/cpp/error.hpp"
#include "protocol/cpp/request.hpp"
#include "scene/scene.hpp"

namespace oval4d::session {

using PolytopePtr = std::shared_ptr<const geometry::Polytope>;

struct SliceSettings {
    int count = 21;      ///< odd: n runs from focus − h to focus + h, h = (count − 1) / 2
    double spacing = 0;  ///< δ, in the polytope's units
    int focus = 0;       ///< f
    bool operator==(const SliceSettings&) const = default;
};

/// All that a picture is made from, and all that undo brings back.
struct State {
    PolytopePtr polytope;  ///< never null
    geometry::Rotation orientation;
    double alpha, beta;  ///< radians
    double step;         ///< radians: what k, j, K and J add
    SliceSettings slices;
    scene::Look look;
    bool turning = false;
    std::optional<geometry::Turn> last;  ///< the last rotation: what '.' repeats and space continues

    geometry::Hyperplanes hyperplanes() const;
    bool operator==(const State&) const = default;
};

/// The state in which a session starts: the 5-cell in the paper's position.
State initialState();

/// The spacing at which `count` slices span the circumscribed sphere.
double spanningSpacing(const geometry::Polytope& polytope, int count);

/// Limits on a session; every one can be set by an option of the server.
struct Limits {
    int maxSlices = 201;
    std::size_t maxUndo = 1000;
    std::size_t maxLoaded = 8;  ///< polytopes loaded into one session
    /// of a loaded polytope, points of a list, or a polytope outside the catalogue that is built by its name
    std::size_t maxVertices = 100'000;
    std::size_t maxHullCells = 100'000;  ///< of the hull of a list of points
};

/// A session: the state, its history, and the polytopes loaded into it. A value: it copies and compares.
struct Session {
    State now = initialState();
    std::deque<State> past;     ///< the oldest first
    std::vector<State> future;  ///< the next one last
    std::map<std::string, PolytopePtr, std::less<>> loaded;
    std::string pendingKey;      ///< the "g" of "gg"
    std::uint64_t revision = 0;  ///< counts the changes of `now`
    bool operator==(const Session&) const = default;
};

class Workshop;

/// Carries out a command. On an error the session is as it was. Whatever a key can change can be undone; moving the
/// camera is not a step of the history. A command that changes nothing leaves the revision as it is. What
/// takes long is left to `workshop`, or else done at once.
protocol::Result<std::monostate> apply(Session& session, const protocol::Command& command, const Limits& limits);
protocol::Result<std::monostate> apply(Session& session, const protocol::Command& command, const Limits& limits,
                                       Workshop& workshop);

/// Continues a turning session by `seconds`: a second turns by kTurnsPerSecond times the last rotation's angles.
/// One history step covers the whole of a continuous turn.
inline constexpr double kTurnsPerSecond = 6;
void advance(Session& session, double seconds);

/// The ':' line as a command: "polytope 24-cell", "set slices=31", "rotate xw,yz pi/8 pi/sqrt(3)-pi/8", "reset".
protocol::Result<protocol::Command> parseCommandLine(std::string_view line, const State& state);

}  // namespace oval4d::session
