#pragma once
// Calls of a function after a delay, on a timer that the caller chooses.

#include <boost/asio/steady_timer.hpp>
#include <boost/system/error_code.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <utility>

namespace oval4d::net {

/// Schedules one call of `call` after `delay`; must not be called while a call is scheduled. When this function and its
/// copies are destroyed, a scheduled call is dropped. Tests pass functions of a virtual time.
using CallAfter = std::function<void(std::chrono::steady_clock::duration delay, std::function<void()> call)>;

/// Returns a CallAfter with a timer of its own, which calls on `strand`. It must be called on this strand.
template <typename Strand>
CallAfter callAfterOn(const Strand& strand) {
    return [timer = std::make_shared<boost::asio::steady_timer>(strand)](std::chrono::steady_clock::duration delay,
                                                                         std::function<void()> call) {
        timer->expires_after(delay);
        timer->async_wait([call = std::move(call)](const boost::system::error_code& failed) {
            if (!failed) call();  // it fails only if the timer was destroyed
        });
    };
}

}  // namespace oval4d::net
