#include "net/live/pacing.hpp"

namespace oval4d::net {

void PicturePacing::recordSent(std::uint64_t revision) {
    newest_ = revision;
    unshown_.push_back({revision, {}});
}

void PicturePacing::recordWritten(std::uint64_t revision, Clock::time_point now) {
    for (UnshownPicture& picture : unshown_) {
        if (picture.revision == revision) picture.written = now;
    }
}

void PicturePacing::recordShown(std::uint64_t revision) {
    while (!unshown_.empty() && unshown_.front().revision <= revision) unshown_.pop_front();
}

void PicturePacing::assumeShown(Clock::time_point now, Clock::duration timeout) {
    while (!unshown_.empty() && unshown_.front().written && *unshown_.front().written + timeout <= now) {
        unshown_.pop_front();
    }
}

std::optional<PicturePacing::Clock::time_point> PicturePacing::assumeShownTime(Clock::duration timeout) const {
    if (unshown_.empty() || !unshown_.front().written) return {};
    return *unshown_.front().written + timeout;
}

}  // namespace oval4d::net
