#pragma once
// Snapshots of a session: the state of one revision, with the data that its pictures need.

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "net/live/message.hpp"
#include "net/server_options.hpp"
#include "net/shared_bytes.hpp"
#include "pipeline/pipeline.hpp"
#include "session/session.hpp"
#include "slicing/slice_set.hpp"
#include "slicing/surface_detail.hpp"
#include "wire/request.hpp"

namespace oval4d::net {

/// The kind of picture that a client receives for each revision. Clients with equal keys share pictures.
struct PictureStreamKey {
    wire::StreamKind stream = wire::StreamKind::none;
    wire::Encoding encoding = wire::Encoding::json;
    scene::Viewport viewport;
    scene::ColorScheme scheme = scene::ColorScheme::dark;  ///< the colors of pictures whose background is `automatic`
    std::optional<scene::Background> background = {};      ///< replaces the session's background, if not empty
    /// If the outer optional is not empty, the inner one replaces the session's highlighted element; an empty inner
    /// optional means that no element is highlighted.
    std::optional<std::optional<slicing::Element>> highlight = {};
    bool operator==(const PictureStreamKey&) const = default;
};

/// The state of one revision of a session, with its slices if a client needs them. The public members do not change
/// after the snapshot is made.
struct SessionSnapshot {
    session::State state;
    std::uint64_t revision = 0;
    std::chrono::steady_clock::time_point changed;      ///< the time at which the session reached this revision
    slicing::Quality quality = slicing::Quality::full;  ///< quality of the pictures made from this snapshot
    slicing::NamedSection section;                      ///< the section in the focus slice
    bool sliced = false;                                ///< whether `slices` is set
    slicing::SliceSet slices;

    /// Returns the `state` message of this revision for viewers who prefer pictures in this color scheme. Makes the
    /// text of each scheme only once. Thread-safe.
    SharedBytes stateTextFor(scene::ColorScheme scheme) const;
    /// Returns the `state` message that answers the request with this id. Without an id, the same as
    /// stateTextFor(scheme).
    SharedBytes stateTextFor(scene::ColorScheme scheme, std::optional<double> id) const;

  private:
    mutable std::mutex textsMutex_;
    mutable std::array<SharedBytes, scene::kSchemes.size()> texts_;  // by scheme; empty until made
};
using SessionSnapshotPtr = std::shared_ptr<const SessionSnapshot>;

/// Makes the snapshot of a revision, with slices if pictures of the kind `key` need them. Must be called on a worker.
SessionSnapshotPtr makeSnapshot(pipeline::Pipeline& pipeline, const session::State& state, std::uint64_t revision,
                                std::chrono::steady_clock::time_point changed, const PictureStreamKey& key,
                                slicing::Quality quality);

/// Makes the snapshot of a revision for clients that receive only states: without slices, and in full quality.
/// `section` is the section in the focus slice.
SessionSnapshotPtr makeStateSnapshot(const session::State& state, std::uint64_t revision,
                                     std::chrono::steady_clock::time_point changed,
                                     const slicing::NamedSection& section);

/// Returns whether the snapshot contains everything that pictures of the kind `key` need. False for a null pointer.
bool isSufficientFor(const SessionSnapshotPtr& snapshot, const PictureStreamKey& key);

/// Makes a picture of a snapshot. If the stream of `key` is frames, the picture is a PNG file; otherwise it is a
/// `slices` message with this request id. For a PNG file, calls `whenDrawn` when the picture is drawn, but not yet
/// encoded. Must be called on a worker. Throws std::runtime_error if the picture cannot be drawn.
OutgoingMessage makePicture(pipeline::Pipeline& pipeline, const SessionSnapshot& snapshot, const PictureStreamKey& key,
                            std::optional<double> id, const std::function<void()>& whenDrawn = {});

/// Returns the estimated time to make a picture of the kind `key`.
Seconds pictureCost(const session::State& state, const PictureStreamKey& key, slicing::Quality quality);

}  // namespace oval4d::net
