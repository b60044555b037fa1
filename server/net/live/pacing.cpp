#include "net/live/pacing.hpp"

namespace oval4d::net {

void Pacing::recordSent(std::uint64_t revision) {
    newest_ = revision;
    unshown_.push_back({revision, {}});
}

void Pacing::recordWritten(std::uint64_t revision, Clock::time_point now) {
    for (UnshownPicture& picture : unshown_) {
        if (picture.revision == revision) picture.written = now;
    }
}

void Pacing::recordShown(std::uint64_t revision) {
    while (!unshown_.empty() && unshown_.front().revision <= revision) unshown_.pop_front();
}

void Pacing::assumeShown(Clock::time_point now, Clock::duration timeout) {
    while (!unshown_.empty() && unshown_.front().written && *unshown_.front().written + timeout <= now) {
        unshown_.pop_front();
    }
}

std::optional<Pacing::Clock::time_point> Pacing::deadline(Clock::duration timeout) const {
    if (unshown_.empty() || !unshown_.front().written) return {};
    return *unshown_.front().written + timeout;
}

}  // namespace oval4d::net
