#pragma once
// The state of a session, the session with its undo history, and the functions that apply commands to a session.

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "errors/error.hpp"
#include "geometry/hyperplanes.hpp"
#include "geometry/range.hpp"
#include "geometry/reference_frame.hpp"
#include "geometry/rotation.hpp"
#include "scene/scene.hpp"
#include "serialization/stored_members.hpp"
#include "session/command.hpp"
#include "slicing/object.hpp"

namespace oval4d::session {

/// The objects that were loaded into a session, by name.
using LoadedObjects = std::map<std::string, slicing::Object, std::less<>>;

/// The bounds of the offset and the spacing of hyperplanes, in circumradii of the object.
using geometry::kMaxOffset, geometry::kMaxSpacing, geometry::kMinSpacing;
inline constexpr int kMaxFocus = 1'000'000;  ///< the maximum absolute value of HyperplaneSettings::focus

/// The hyperplanes that cut the object into slices: w = offset + n · spacing, for `count` consecutive integers n.
/// Lengths are in units of the object.
struct HyperplaneSettings {
    int count = 21;      ///< odd; n runs from focus − h to focus + h, where h = (count − 1) / 2
    double spacing = 0;  ///< δ, the distance between neighboring hyperplanes
    int focus = 0;       ///< the index n of the focus slice (the middle one)
    double offset = 0;   ///< the w of the hyperplane with n = 0
    bool operator==(const HyperplaneSettings&) const = default;
};
void visitStoredMembers(serialization::ReadOrWritten<HyperplaneSettings> auto& slices, auto& visit) {
    auto& [count, spacing, focus, offset] = slices;
    visit.member(0, count);
    visit.member(1, spacing, geometry::NumberRange::ofFiniteNumbers());
    visit.member(2, focus);
    visit.memberAddedLater(3, offset, geometry::NumberRange::ofFiniteNumbers());
}

/// A turn in progress, which the command TurnToward has started. The object turns to the orientation `goal` along the
/// shortest way, at constant speed.
struct OngoingTurnToward {
    static constexpr double kMaxSeconds = 10;

    geometry::Rotation goal;
    double seconds = 0;  ///< the remaining time; greater than 0, at most kMaxSeconds
    bool operator==(const OngoingTurnToward&) const = default;
};
void visitStoredMembers(serialization::ReadOrWritten<OngoingTurnToward> auto& turn, auto& visit) {
    auto& [goal, seconds] = turn;
    visit.rotation(0, goal);
    visit.member(2, seconds, geometry::NumberRange::positiveUpTo(OngoingTurnToward::kMaxSeconds));
}

/// Everything that determines a picture, except the viewport, the drawing quality and the viewer's color scheme. Undo
/// restores all members except the camera's orbit.
struct State {
    /// The range of alpha and beta, in radians.
    static constexpr geometry::NumberRange kAngleRange{-2 * std::numbers::pi, 2 * std::numbers::pi};
    /// The range of step, in radians.
    static constexpr geometry::NumberRange kStepRange{1e-9, 2 * std::numbers::pi};
    static constexpr geometry::NumberRange kPlaySpeedRange{1.0 / 16, 16};  ///< the range of playSpeed

    slicing::Object source;  ///< the object as built or loaded, in its own coordinates; never null
    geometry::ReferenceFrame referenceFrame;
    /// The object that is shown: `source` in the coordinates of `referenceFrame`; never null.
    slicing::Object object;
    geometry::Rotation orientation;
    double alpha, beta;  ///< the angles of the rotation keys, in radians
    double step;         ///< by how much the keys k, j, K and J change alpha or beta, in radians
    HyperplaneSettings slices;
    scene::Look look;
    bool turning = false;  ///< whether the object turns continuously, by repeating `lastTurn`
    /// The last rotation, which the keys '.' and space repeat; empty if there is none.
    std::optional<geometry::RotationAngles> lastTurn;
    /// The turn that the command TurnToward has started, until it reaches its goal in advanceMotionBy(). Empty if there
    /// is none, and always empty while `turning` is true.
    std::optional<OngoingTurnToward> ongoingTurnToward;
    /// Whether advanceMotionBy() moves the focus to and fro between the lowest and the highest w of the object. Becomes
    /// false when a command sets the focus or the offset.
    bool playing = false;
    /// The direction in which the focus moves, or will move once `playing` becomes true.
    bool playsDownward = false;
    /// The speed of playing. At speed 1, the focus moves from the lowest to the highest w in kSecondsFromEndToEnd
    /// seconds.
    double playSpeed = 1;

    /// Returns pointers to `source` and `object`. Both are the same object if `referenceFrame` is the default frame.
    std::array<const slicing::Object*, 2> sourceAndObject() const { return {&source, &object}; }
    /// Returns the hyperplanes that `slices` describes.
    geometry::Hyperplanes hyperplanes() const;
    /// Returns the w of the focus slice, in units of the object.
    double focusW() const { return slices.offset + slices.focus * slices.spacing; }
    /// Returns the focus point (x, y, z, w), in the coordinates of the object's file. The planes of the matrix pass
    /// through this point.
    glm::dvec4 focusPointInFile() const {
        return slicing::infoOf(object).originInFile + glm::dvec4(look.focusPoint, focusW());
    }
    /// Returns whether the object or the focus moves without further commands: the object turns, or the focus plays.
    bool isMoving() const { return turning || ongoingTurnToward || playing; }
    bool operator==(const State&) const = default;
};
void visitStoredMembers(serialization::ReadOrWritten<State> auto& state, auto& visit) {
    // `object` is not stored, because it is computed again from `source` and `frame`.
    auto& [source, frame, object, orientation, alpha, beta, step, slices, look, turning, lastTurn, ongoing, playing,
           playsDownward, playSpeed] = state;
    visit.object(0, source);
    visit.rotation(1, orientation);
    visit.nestedArray(3, [&state](auto& angles) {
        angles.member(0, state.alpha, State::kAngleRange);
        angles.member(1, state.beta, State::kAngleRange);
        angles.member(2, state.step, geometry::NumberRange::positiveUpTo(State::kStepRange.most));
    });
    visit.member(4, slices);
    visit.member(5, look);
    visit.member(6, turning);
    visit.member(7, lastTurn);
    visit.memberAddedLater(8, ongoing);
    visit.memberAddedLater(9, frame);
    visit.memberAddedLater(10, playing);
    visit.memberAddedLater(11, playsDownward);
    visit.memberAddedLater(12, playSpeed, State::kPlaySpeedRange);
}

/// Returns the initial state of a session: the 5-cell in the position of Kageyama's paper.
State initialState();

/// Returns the spacing at which `count` slices span −r to r, where r = slicing::initialSliceExtent(object). Returns r
/// if `count` is 1.
double spanningSpacing(const slicing::Object& object, int count);

/// The limits on a session. The server has an option for each limit.
struct Limits {
    int maxSlices = 201;         ///< the maximum number of slices, HyperplaneSettings::count
    std::size_t maxUndo = 1000;  ///< the maximum number of undo steps
    /// The maximum memory, in bytes, of objects and lists of cell types that only undo steps use.
    std::size_t maxUndoBytes = 64U << 20U;
    std::size_t maxLoaded = 8;  ///< the maximum number of objects loaded into one session
    /// The maximum number of vertices of a loaded polytope, of points in a list or a point cloud, and of vertices of a
    /// polytope built from its name. Polytopes of the catalogue may be larger.
    std::size_t maxVertices = 100'000;
    /// The maximum number of cells of the convex hull of a list of points.
    std::size_t maxHullCells = 100'000;
    /// The maximum memory of an array's samples, as 32-bit floats, in bytes.
    std::size_t maxFieldBytes = 256U << 20U;
    /// The maximum memory, in bytes, of the level of a multiscale image that is shown first.
    std::size_t maxFirstLevelBytes = 64U << 20U;
};

/// A session: its current state, its history, and the loaded objects. Sessions can be copied and compared.
struct Session {
    State current = initialState();
    std::deque<State> undoSteps;   ///< the oldest first
    std::vector<State> redoSteps;  ///< the last element is the next step to redo
    LoadedObjects loaded;
    std::string pendingKey;  ///< the first key of a sequence in progress, such as "g" of "gg"; else empty
    /// The number of changes of `current`. Increases by one with every command and every step of a motion that changes
    /// `current`, and only then.
    std::uint64_t revision = 0;
    bool operator==(const Session&) const = default;
};
void visitStoredMembers(serialization::ReadOrWritten<Session> auto& session, auto& visit) {
    // Member 0 of a stored record is the version, and member 2 the list of objects: see store/session_codec.cpp. The
    // list of objects has the order in which the states below are visited.
    auto& [current, undoSteps, redoSteps, loaded, pendingKey, revision] = session;
    visit.member(1, revision);
    visit.member(3, current);
    visit.member(4, undoSteps);
    visit.member(5, redoSteps);
    visit.member(6, loaded);
    visit.member(7, pendingKey);
}

/// Returns the memory of an object in bytes. Returns 0 for an object that all sessions share: a polytope of the
/// catalogue, an example field, or a field from the server's data folder.
std::size_t unsharedMemory(const slicing::Object& object);

/// Returns the memory of a session's objects in bytes: the sum of unsharedMemory() over all different objects.
std::size_t unsharedMemoryOfObjects(const Session& session);

/// Returns the memory of a session's history in bytes, without the objects.
std::size_t historyMemoryWithoutObjects(const Session& session);

class ObjectLoader;

/// The effect of a command on a session: the new state and the new loaded objects.
struct CommandOutcome {
    State next;
    std::optional<LoadedObjects> loaded = {};  ///< empty if the loaded objects stay the same
};
/// The outcome of a command, or the error of the command; empty if not computed yet.
using ComputedOutcome = std::optional<Result<CommandOutcome>>;

/// Returns whether a command needs an object, or critical values of w, that `loader` does not have yet. If true, this
/// object or search is pending in `loader`. The caller must then call ObjectLoader::completePending(), and call
/// needsLoading() again: a command may first need an object, and then this object in another frame of reference. Does
/// not change the session. If the result is false, `outcome` is set to the outcome of the command, for apply(), or left
/// empty if it was not needed.
bool needsLoading(const Session& session, const Command& command, const Limits& limits, ObjectLoader& loader,
                  ComputedOutcome& outcome);

/// Applies a command to the session. After an error, the session is unchanged, except that the failed action of a key
/// ends the key sequence in progress (see Session::pendingKey). Every change adds an undo step. Exceptions are camera
/// moves, the end of continuous turning or of playing, commands with `continues`, and appended time steps. `loader`
/// builds polytopes and reads files. With LoadingMode::deferred, needsLoading() must have returned false for the same
/// session, command and loader. `outcome` is the result of needsLoading() if the session has not changed since, and
/// saves computing it again.
Result<std::monostate> apply(Session& session, const Command& command, const Limits& limits, ObjectLoader& loader,
                             ComputedOutcome outcome = {});

/// The speed of continuous turning: how many times per second the last rotation is repeated.
inline constexpr double kRotationRepeatsPerSecond = 6;
/// The time, in seconds, in which the focus moves from the lowest w of the object to the highest, if State::playSpeed
/// is 1.
inline constexpr double kSecondsFromEndToEnd = 8;
/// Advances all motion by `seconds`. First the object turns, continuously or toward an element, until its goal. Then
/// the focus plays between the lowest and the highest w of the turned object; at an end, it stops at this end and
/// reverses. Adds no undo step, because one undo step covers the whole motion. Increases the revision only if the state
/// changes.
void advanceMotionBy(Session& session, double seconds);

}  // namespace oval4d::session
