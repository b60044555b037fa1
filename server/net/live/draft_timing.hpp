#pragma once
// Decides when the pictures of fields are drafts: pictures of lower quality, which are made faster.

#include <chrono>
#include <optional>

namespace oval4d::net {

/// Detects quick changes of a session. During quick changes, pictures of a field are drafts (slicing::Quality::draft).
/// A period of quick changes begins with a change that comes less than kBurst after the previous change. The period
/// ends when the session has not changed for kRest, or with a change that comes at least kBurst after the previous one.
class DraftTiming {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds kBurst{300}, kRest{200};

    /// `opened` is the time at which the session was opened.
    explicit DraftTiming(Clock::time_point opened) : changed_(opened) {}

    /// Records a change: the session has reached a new revision.
    void recordChange(Clock::time_point now) {
        isQuick_ = changedBefore_ && now - changed_ < kBurst;
        changedBefore_ = true;
        changed_ = now;
    }
    /// Begins a period of quick changes, however long ago the previous change was.
    void beginQuickChanges() { isQuick_ = true; }
    /// Ends the period of quick changes if the session has not changed for kRest before `now`.
    void endQuickChangesIfRested(Clock::time_point now) { isQuick_ = isQuick_ && now < quickChangesEndTime(); }

    bool hasQuickChanges() const { return isQuick_; }
    /// Returns the time at which the session reached its current revision.
    Clock::time_point lastChangeTime() const { return changed_; }
    /// Returns the time from which endQuickChangesIfRested() ends a period of quick changes, provided that no change
    /// comes before this time.
    Clock::time_point quickChangesEndTime() const { return changed_ + kRest; }

  private:
    Clock::time_point changed_;
    bool changedBefore_ = false;  // whether the session has changed since it was opened
    bool isQuick_ = false;
};

}  // namespace oval4d::net
