#pragma once
// The only limit on the time that a test may take.

#include <chrono>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <thread>

namespace oval4d::support {

/// Returns the time after which a test that waits for an event has failed. No machine is so slow that an event which
/// comes at all comes later.
inline std::chrono::seconds hangLimit() {
    static const std::chrono::seconds kLimit = [] {
        int seconds = 0;
        if (!(std::ifstream(OVAL4D_SOURCE_DIR "/tests/hang_limit_seconds") >> seconds))
            throw std::runtime_error("tests/hang_limit_seconds cannot be read");
        return std::chrono::seconds(seconds);
    }();
    return kLimit;
}

/// Waits until `happened` returns true; returns false if it does not within the limit. Calls `meanwhile` before each
/// pause.
inline bool eventually(const std::function<bool()>& happened, const std::function<void()>& meanwhile = [] {}) {
    const auto end = std::chrono::steady_clock::now() + hangLimit();
    while (!happened()) {
        if (std::chrono::steady_clock::now() > end) return false;
        meanwhile();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
}

}  // namespace oval4d::support
