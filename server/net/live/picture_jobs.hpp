#pragma once
// Records the unfinished jobs that make pictures of a session.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "net/live/snapshot.hpp"

namespace oval4d::net {

/// The picture jobs of a session. At most one job at a time is queued or being drawn. When the last picture of a job
/// has been drawn, the next job may be queued, although this picture is still being encoded. Not thread-safe.
class PictureJobs {
  public:
    /// A picture that has been drawn and is being encoded.
    struct PictureBeingEncoded {
        std::uint64_t job = 0, revision = 0;
        slicing::Quality quality = slicing::Quality::full;
        PictureStreamKey streamKey;
    };

    /// Returns whether a job is queued or being drawn.
    bool isQueuedOrDrawing() const { return drawing_ != 0; }
    /// Returns the number of the job that is queued or being drawn. If there is none, returns the number of the next
    /// job. Numbers start at 1.
    std::uint64_t currentOrNextJobNumber() const { return isQueuedOrDrawing() ? drawing_ : jobs_ + 1; }
    /// Records that the job with the number currentOrNextJobNumber() has been queued. No other job may be queued or
    /// being drawn.
    void recordQueued() { drawing_ = ++jobs_; }
    /// Records that the last picture of a job has been drawn and is being encoded.
    void recordLastPictureDrawn(const PictureBeingEncoded& picture) {
        if (drawing_ == picture.job) drawing_ = 0;
        encoding_.push_back(picture);
    }
    /// Records that a job is done: all its pictures are encoded.
    void recordDone(std::uint64_t job) {
        if (drawing_ == job) drawing_ = 0;
        std::erase_if(encoding_, [&](const PictureBeingEncoded& each) { return each.job == job; });
    }

    /// Returns how many pictures with the key `key` are being encoded.
    std::size_t countEncoding(const PictureStreamKey& key) const {
        return static_cast<std::size_t>(std::ranges::count(encoding_, key, &PictureBeingEncoded::streamKey));
    }
    /// Returns whether a picture of this revision with this key is being encoded, in the quality `atLeast` or a better
    /// one.
    bool isEncoding(const PictureStreamKey& key, std::uint64_t revision, slicing::Quality atLeast) const {
        return std::ranges::any_of(encoding_, [&](const PictureBeingEncoded& each) {
            return each.streamKey == key && each.revision == revision && each.quality >= atLeast;
        });
    }

  private:
    std::uint64_t jobs_ = 0;     // the number of jobs so far
    std::uint64_t drawing_ = 0;  // the number of the job that is queued or being drawn; 0 if there is none
    std::vector<PictureBeingEncoded> encoding_;  // the last pictures of jobs that are not done
};

}  // namespace oval4d::net
