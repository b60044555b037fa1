#pragma once
// The minimum rate at which a client must read.

#include <algorithm>
#include <chrono>
#include <cstddef>

#include "net/options.hpp"

namespace oval4d::net {

/// Computes the timeouts that enforce the minimum reading rate while one message or reply is written. Otherwise a very
/// slow client could make the server hold the message for hours. Each fragment must be written within
/// Options::writeTimeout. In addition, the whole message must be written at the average rate Options::minReadRate, with
/// two more write timeouts of grace; a rate of 0 turns this limit off.
class MinReadRate {
  public:
    using Clock = std::chrono::steady_clock;

    explicit MinReadRate(const Options& options)
        : grace_(options.writeTimeout), perSecond_(static_cast<double>(options.minReadRate)) {}

    /// Counts bytes that the client has accepted.
    void count(std::size_t bytes) { taken_ += static_cast<double>(bytes); }

    /// Returns the time within which the next fragment must be written; 1 ms if the client is already too slow.
    Clock::duration timeout() const {
        const Seconds lived = Clock::now() - start_;
        const Seconds left = perSecond_ > 0 ? 2 * grace_ + Seconds(taken_ / perSecond_) - lived : grace_;
        return std::chrono::duration_cast<Clock::duration>(std::clamp(left, Seconds(0.001), grace_));
    }

  private:
    const Seconds grace_;
    const double perSecond_;
    double taken_ = 0;
    const Clock::time_point start_ = Clock::now();
};

}  // namespace oval4d::net
