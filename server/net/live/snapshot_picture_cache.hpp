#pragma once
// A cache of a session's newest snapshot, and of the pictures made of this snapshot.

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <tuple>
#include <utility>
#include <vector>

#include "net/live/snapshot.hpp"

namespace oval4d::net {

/// The newest snapshot of a session, and the pictures that have been made of this snapshot. Clients with equal
/// PictureStreamKeys share a picture. Not thread-safe.
class SnapshotPictureCache {
  public:
    using MessagesByStream = std::vector<std::pair<PictureStreamKey, OutgoingMessage>>;

    /// Returns the snapshot in the cache; null if there is none.
    const SessionSnapshotPtr& snapshot() const { return snapshot_; }
    /// Returns the snapshot in the cache if it has this revision and quality, else null.
    SessionSnapshotPtr findSnapshot(std::uint64_t revision, slicing::Quality quality) const {
        const bool isKept = snapshot_ && snapshot_->revision == revision && snapshot_->quality == quality;
        return isKept ? snapshot_ : nullptr;
    }
    /// Returns the picture of this revision for `key` in the quality `atLeast` or a better one; null if there is none.
    const OutgoingMessage* find(const PictureStreamKey& key, std::uint64_t revision, slicing::Quality atLeast) const {
        if (!snapshot_ || snapshot_->revision != revision || snapshot_->quality < atLeast) return nullptr;
        const auto found = std::ranges::find(pictures_, key, &MessagesByStream::value_type::first);
        return found == pictures_.end() ? nullptr : &found->second;
    }

    /// Adds pictures of `snapshot`. Does nothing if the cache has a newer snapshot: one of a later revision, or of the
    /// same revision in higher quality. If the cache has an older snapshot, drops it and its pictures first. `snapshot`
    /// may be null if there are no pictures.
    void addUnlessOlder(const SessionSnapshotPtr& snapshot, MessagesByStream pictures) {
        const auto age = [](const SessionSnapshot& each) { return std::tie(each.revision, each.quality); };
        if (!snapshot || (snapshot_ && age(*snapshot) < age(*snapshot_))) return;
        if (snapshot != snapshot_) clear();
        snapshot_ = snapshot;
        std::ranges::move(pictures, std::back_inserter(pictures_));
    }
    /// Frees the memory of the snapshot and of its pictures.
    void clear() {
        snapshot_.reset();
        pictures_ = {};
    }

  private:
    SessionSnapshotPtr snapshot_;
    MessagesByStream pictures_;
};

}  // namespace oval4d::net
