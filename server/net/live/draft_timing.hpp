#pragma once
// Decides when the pictures of fields are drafts, which have a lower quality.

#include <chrono>
#include <optional>

namespace oval4d::net {

/// Tells whether a session changes in quick succession, so that pictures of a field must be drafts
/// (slicing::Quality::draft). A period of quick changes begins with a change that follows the previous one within
/// kBurst. It ends when the session has not changed for kRest, or with a change at least kBurst after the previous one.
class DraftTiming {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds kBurst{300}, kRest{200};

    /// `opened`: the time at which the session was opened.
    explicit DraftTiming(Clock::time_point opened) : changed_(opened) {}

    /// Records that the session has reached a new revision.
    void recordChange(Clock::time_point now) {
        isQuick_ = changedBefore_ && now - changed_ < kBurst;
        changedBefore_ = true;
        changed_ = now;
    }
    /// Begins a period of quick changes, even if the last change was not within kBurst of the previous one.
    void begin() { isQuick_ = true; }
    /// Ends the period of quick changes if the session has rested for kRest.
    void endIfRested(Clock::time_point now) { isQuick_ = isQuick_ && now < restEnds(); }

    bool hasQuickChanges() const { return isQuick_; }
    /// Returns the time at which the session reached its current revision.
    Clock::time_point lastChangeTime() const { return changed_; }
    /// Returns the time from which endIfRested() ends a period of quick changes, if the session does not change before
    /// that time.
    Clock::time_point restEnds() const { return changed_ + kRest; }

  private:
    Clock::time_point changed_;
    bool changedBefore_ = false;  // whether the session has changed since it was opened
    bool isQuick_ = false;
};

}  // namespace oval4d::net
