#pragma once
// The state of a session, and the functions that apply commands to it.

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

/// The objects loaded into a session, by name.
using LoadedObjects = std::map<std::string, slicing::Object, std::less<>>;

/// Bounds of HyperplaneSettings, besides those of its spacing and its offset.
using geometry::kMaxOffset, geometry::kMaxSpacing, geometry::kMinSpacing;
inline constexpr int kMaxFocus = 1'000'000;  ///< absolute value of the focus index

/// The hyperplanes that cut the object into slices: w = offset + n · spacing, for `count` consecutive integers n.
struct HyperplaneSettings {
    int count = 21;      ///< odd; n is from focus − h to focus + h, where h = (count − 1) / 2
    double spacing = 0;  ///< δ, the distance between neighboring hyperplanes, in the object's units
    int focus = 0;       ///< f, the index of the focus slice
    double offset = 0;   ///< w of the hyperplane n = 0, in the object's units
    bool operator==(const HyperplaneSettings&) const = default;
};
void visitStoredMembers(serialization::ReadOrWritten<HyperplaneSettings> auto& slices, auto& visit) {
    auto& [count, spacing, focus, offset] = slices;
    visit.member(0, count);
    visit.member(1, spacing, geometry::Range::finite());
    visit.member(2, focus);
    visit.addedMember(3, offset, geometry::Range::finite());
}

/// A motion in progress that the command TurnToward has started: the object turns to the orientation `goal` along the
/// shortest way, at constant speed.
struct OngoingTurnToward {
    static constexpr double kMaxSeconds = 10;

    geometry::Rotation goal;
    double seconds = 0;  ///< the time that is left; greater than 0, at most kMaxSeconds
    bool operator==(const OngoingTurnToward&) const = default;
};
void visitStoredMembers(serialization::ReadOrWritten<OngoingTurnToward> auto& turn, auto& visit) {
    auto& [goal, seconds] = turn;
    visit.rotation(0, goal);
    visit.member(2, seconds, geometry::Range::positiveUpTo(OngoingTurnToward::kMaxSeconds));
}

/// Everything that determines a picture, except the viewport, the quality and the viewer's color scheme. Undo restores
/// all members except the camera's orbit.
struct State {
    static constexpr geometry::Range kAngleRange{-2 * std::numbers::pi, 2 * std::numbers::pi};  ///< of alpha and beta
    static constexpr geometry::Range kStepRange{1e-9, 2 * std::numbers::pi};                    ///< of step
    static constexpr geometry::Range kPlaySpeedRange{1.0 / 16, 16};                             ///< of playSpeed

    slicing::Object source;  ///< the object as it was built or loaded; never null
    geometry::ReferenceFrame referenceFrame;
    slicing::Object object;  ///< what is shown: `source` in `referenceFrame` (see slicing::transformedTo())
    geometry::Rotation orientation;
    double alpha, beta;  ///< the angles of the rotation keys, in radians
    double step;         ///< the change of alpha or beta by the keys k, j, K and J, in radians
    HyperplaneSettings slices;
    scene::Look look;
    bool turning = false;                    ///< whether the object turns continuously: advance() repeats `lastTurn`
    std::optional<geometry::Turn> lastTurn;  ///< the last rotation, which the keys '.' and space repeat
    /// The motion that TurnToward has started; advance() continues it until it ends. Empty if there is none, and always
    /// empty while `turning` is true.
    std::optional<OngoingTurnToward> ongoingTurnToward;
    /// Whether the focus moves to and fro between the lowest and the highest w of the object, by advance(). Whatever
    /// else sets the focus or the offset ends this.
    bool playing = false;
    bool playsDownward = false;  ///< the direction in which the focus moves, or moves when `playing` becomes true
    double playSpeed = 1;        ///< at the speed 1, the focus moves from end to end in kSecondsFromEndToEnd

    /// Returns pointers to `source` and `object`. Both hold the same object if `referenceFrame` is the default.
    std::array<const slicing::Object*, 2> objects() const { return {&source, &object}; }
    /// Returns the hyperplanes that `slices` describes.
    geometry::Hyperplanes hyperplanes() const;
    /// Returns w of the focus slice, in the object's units.
    double focusW() const { return slices.offset + slices.focus * slices.spacing; }
    /// Returns the focus point x, y, z, w in the coordinates of the object's file.
    glm::dvec4 focusPointInFile() const {
        return slicing::infoOf(object).originInFile + glm::dvec4(look.focusPoint, focusW());
    }
    /// Returns whether the object or the focus moves without further commands: the object continuously or toward an
    /// element, or the focus to and fro.
    bool isMoving() const { return turning || ongoingTurnToward || playing; }
    bool operator==(const State&) const = default;
};
void visitStoredMembers(serialization::ReadOrWritten<State> auto& state, auto& visit) {
    // `object` is not stored, because it can be computed from `source` and `frame`.
    auto& [source, frame, object, orientation, alpha, beta, step, slices, look, turning, lastTurn, ongoing, playing,
           playsDownward, playSpeed] = state;
    visit.object(0, source);
    visit.rotation(1, orientation);
    visit.array(3, [&state](auto& angles) {
        angles.member(0, state.alpha, State::kAngleRange);
        angles.member(1, state.beta, State::kAngleRange);
        angles.member(2, state.step, geometry::Range::positiveUpTo(State::kStepRange.most));
    });
    visit.member(4, slices);
    visit.member(5, look);
    visit.member(6, turning);
    visit.member(7, lastTurn);
    visit.addedMember(8, ongoing);
    visit.addedMember(9, frame);
    visit.addedMember(10, playing);
    visit.addedMember(11, playsDownward);
    visit.addedMember(12, playSpeed, State::kPlaySpeedRange);
}

/// Returns the initial state of a session: the 5-cell in the position that it has in Kageyama's paper.
State initialState();

/// Returns the spacing at which `count` slices lie from −r to r, where r = slicing::initialSliceExtent(object). If
/// `count` is 1, returns r.
double spanningSpacing(const slicing::Object& object, int count);

/// Limits on a session. Each can be set by an option of the server.
struct Limits {
    int maxSlices = 201;                    ///< the maximum of HyperplaneSettings::count
    std::size_t maxUndo = 1000;             ///< undo steps
    std::size_t maxUndoBytes = 64U << 20U;  ///< bytes of objects and cell type lists that only undo steps use
    std::size_t maxLoaded = 8;              ///< objects loaded into one session
    /// The maximum number of vertices of a loaded polytope, of points in a list or a point cloud, and of vertices of a
    /// polytope that is built from its name, unless it is in the catalogue.
    std::size_t maxVertices = 100'000;
    std::size_t maxHullCells = 100'000;           ///< cells of the convex hull of a list of points
    std::size_t maxFieldBytes = 256U << 20U;      ///< bytes of the samples of an array, as 32-bit floats
    std::size_t maxFirstLevelBytes = 64U << 20U;  ///< the same, of the level of an image that is shown first
};

/// A session: the current state, its history, and the loaded objects. Sessions can be copied and compared.
struct Session {
    State current = initialState();
    std::deque<State> undoSteps;   ///< undo steps, the oldest first
    std::vector<State> redoSteps;  ///< redo steps, the next one last
    LoadedObjects loaded;
    std::string pendingKey;  ///< the first key of a sequence that has begun, such as the "g" of "gg"; else empty
    /// Counts the changes of `current`: increases by one with every command and every step of the motion that changes
    /// `current`, and with nothing else.
    std::uint64_t revision = 0;
    bool operator==(const Session&) const = default;
};
void visitStoredMembers(serialization::ReadOrWritten<Session> auto& session, auto& visit) {
    // The numbers 0 and 2 are those of the version and of the list of objects, which a record has besides: see
    // store/session_codec.cpp. There, the list of objects has the order in which the states are visited.
    auto& [current, undoSteps, redoSteps, loaded, pendingKey, revision] = session;
    visit.member(1, revision);
    visit.member(3, current);
    visit.member(4, undoSteps);
    visit.member(5, redoSteps);
    visit.member(6, loaded);
    visit.member(7, pendingKey);
}

/// Returns the memory of an object in bytes; 0 if all sessions share it: a polytope of the catalogue, an example field,
/// or a field of the data folder.
std::size_t unsharedMemory(const slicing::Object& object);

/// Returns the memory of a session's objects in bytes: the sum of unsharedMemory() over all objects. Each object counts
/// once.
std::size_t ownObjectMemory(const Session& session);

/// Returns the memory of a session's history in bytes, without the objects.
std::size_t historyMemoryWithoutObjects(const Session& session);

class ObjectLoader;

/// What a command makes of a session: the new state and the new loaded objects.
struct Outcome {
    State next;
    std::optional<LoadedObjects> loaded = {};  ///< empty if they stay the same
};
/// The outcome of a command, or the error that the command ends with; empty if it has not been computed.
using ComputedOutcome = std::optional<Result<Outcome>>;

/// Returns whether a command needs an object, or critical values of w, that `loader` does not have yet. If so, this
/// object or search becomes pending. The caller must complete it with ObjectLoader::completePending(), and call
/// needsLoading() again, because a command may need first an object and then this object transformed to the frame of
/// reference. Does not change the session. Overwrites `outcome`: if the result is false, and the function had to
/// compute the outcome of the command, with this outcome, for apply().
bool needsLoading(const Session& session, const Command& command, const Limits& limits, ObjectLoader& loader,
                  ComputedOutcome& outcome);

/// Applies a command to the session. After an error, the session is unchanged, except that a key whose action is
/// refused ends the sequence to which it belongs (see Session::pendingKey). Every change adds an undo step, except
/// moves of the camera, the end of continuous turning or of playing, commands with `continues`, and added time steps;
/// see history.hpp. `loader` builds polytopes and reads files. If it has LoadingMode::deferred, needsLoading() must
/// have returned false for this session, this command and this loader. `outcome`: what needsLoading() has computed, if
/// the session has not changed since; then this is not computed again.
Result<std::monostate> apply(Session& session, const Command& command, const Limits& limits, ObjectLoader& loader,
                             ComputedOutcome outcome = {});

/// The speed of continuous turning: how often the last rotation is repeated per second.
inline constexpr double kRotationRepeatsPerSecond = 6;
/// How long the focus takes from the lowest w of the object to the highest, if State::playSpeed is 1.
inline constexpr double kSecondsFromEndToEnd = 8;
/// Continues the motion by `seconds`: continuous turning, or a turn toward an element, which ends at its goal; and then
/// playing, between the ends of the turned object. A focus beyond an end moves to the end, where it turns back. Adds no
/// undo step, because one undo step covers the whole motion. Increases the revision only if the state changes: not if
/// everything is at rest, if the object turns by the angle 0, or if the step is lost to rounding.
void advance(Session& session, double seconds);

}  // namespace oval4d::session
