#pragma once
// A cache of the newest snapshot of a session and its pictures.

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <tuple>
#include <utility>
#include <vector>

#include "net/live/snapshot.hpp"

namespace oval4d::net {

/// The newest snapshot of a session, and the pictures that have been made of this snapshot. Each picture is made once,
/// and sent to all clients with the same StreamKey. Not thread-safe.
class SnapshotPictureCache {
  public:
    using MessagesByStream = std::vector<std::pair<StreamKey, OutgoingMessage>>;

    /// Returns the snapshot that is kept; null if there is none.
    const SnapshotPtr& snapshot() const { return snapshot_; }
    /// Returns the snapshot if it has this revision and quality, else null.
    SnapshotPtr find(std::uint64_t revision, slicing::Quality quality) const {
        const bool isKept = snapshot_ && snapshot_->revision == revision && snapshot_->quality == quality;
        return isKept ? snapshot_ : nullptr;
    }
    /// Returns the picture of this revision for `key`, if its quality is at least `atLeast`; null if there is none.
    const OutgoingMessage* find(const StreamKey& key, std::uint64_t revision, slicing::Quality atLeast) const {
        if (!snapshot_ || snapshot_->revision != revision || snapshot_->quality < atLeast) return nullptr;
        const auto found = std::ranges::find(pictures_, key, &MessagesByStream::value_type::first);
        return found == pictures_.end() ? nullptr : &found->second;
    }

    /// Adds pictures of `snapshot`. Does nothing if the snapshot that is kept is newer: it has a later revision, or the
    /// same revision in a higher quality. If another snapshot is kept, first drops it and its pictures, and keeps
    /// `snapshot` instead. `snapshot` may be null if there are no pictures.
    void addUnlessOlder(const SnapshotPtr& snapshot, MessagesByStream pictures) {
        const auto age = [](const Snapshot& each) { return std::tie(each.revision, each.quality); };
        if (!snapshot || (snapshot_ && age(*snapshot) < age(*snapshot_))) return;
        if (snapshot != snapshot_) clear();
        snapshot_ = snapshot;
        std::ranges::move(pictures, std::back_inserter(pictures_));
    }
    /// Frees the memory of the snapshot and its pictures.
    void clear() {
        snapshot_.reset();
        pictures_ = {};
    }

  private:
    SnapshotPtr snapshot_;
    MessagesByStream pictures_;
};

}  // namespace oval4d::net
