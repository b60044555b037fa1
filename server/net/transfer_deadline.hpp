#pragma once
// The minimum rate at which a client must read, or must send the body of a request.

#include <algorithm>
#include <chrono>
#include <cstddef>

#include "net/clock.hpp"
#include "net/server_options.hpp"

namespace oval4d::net {

/// Computes timeouts that enforce a minimum rate while one message, reply or body is transferred. Without a minimum
/// rate, a very slow client could make the server hold the data for hours. The data are transferred in fragments, with
/// two limits for each: a fragment must be transferred within ServerOptions::writeTimeout. If n bytes have been
/// transferred, the next fragment must end at the latest n / ServerOptions::minReadRate + 2 ·
/// ServerOptions::writeTimeout after the start of the first. If ServerOptions::minReadRate is 0, only the first limit
/// applies.
class TransferDeadline {
  public:
    using Clock = TimerClock::Clock;

    /// `clock` must outlive this object.
    TransferDeadline(const ServerOptions& options, const TimerClock& clock)
        : clock_(clock), grace_(options.writeTimeout), perSecond_(static_cast<double>(options.minReadRate)) {}

    /// Counts bytes that the client has accepted or sent.
    void countBytes(std::size_t bytes) { taken_ += static_cast<double>(bytes); }

    /// Returns the time from now within which the next fragment must be transferred. Returns 1 ms if the client is
    /// already too slow.
    Clock::duration nextFragmentTimeout() const {
        const Seconds lived = clock_.now() - start_;
        const Seconds left = perSecond_ > 0 ? 2 * grace_ + Seconds(taken_ / perSecond_) - lived : grace_;
        return std::chrono::duration_cast<Clock::duration>(std::clamp(left, Seconds(0.001), grace_));
    }

  private:
    const TimerClock& clock_;  // declared first, because start_ is initialized from it
    const Seconds grace_;
    const double perSecond_;
    double taken_ = 0;
    const Clock::time_point start_ = clock_.now();
};

}  // namespace oval4d::net
