#pragma once
// Helpers for Asio coroutines: a completion token, a conversion of durations, and a function that awaits a callback.

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/associated_executor.hpp>
#include <boost/asio/async_result.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <utility>

namespace oval4d::net {

/// A completion token that makes an awaited operation return a tuple beginning with the error code, instead of
/// throwing.
inline constexpr auto kAsTuple = boost::asio::as_tuple(boost::asio::use_awaitable);

/// Converts any duration to the duration type of asio::steady_timer.
template <typename Duration>
auto toSteadyDuration(Duration duration) {
    return std::chrono::duration_cast<std::chrono::steady_clock::duration>(duration);
}

/// Calls `start` with a callback, suspends the coroutine until that callback is called, and returns the value that was
/// passed to the callback. `start` must ensure that the callback is called exactly once, from any thread. The coroutine
/// resumes on its own executor. Create `start` in an ordinary function: if a lambda is created in a coroutine, GCC 12
/// destroys its captures twice.
template <typename Value>
boost::asio::awaitable<Value> awaitCallback(std::function<void(std::function<void(Value)>)> start) {
    namespace asio = boost::asio;
    auto initiate = [](auto handler, const std::function<void(std::function<void(Value)>)>& begin) {
        // A completion handler is move-only, but std::function requires a copyable target.
        auto shared = std::make_shared<decltype(handler)>(std::move(handler));
        begin([shared](Value value) {
            const auto executor = asio::get_associated_executor(*shared);
            asio::post(executor,
                       [shared, value = std::move(value)]() mutable { std::move (*shared)(std::move(value)); });
        });
    };
    return asio::async_initiate<const asio::use_awaitable_t<>, void(Value)>(initiate, asio::use_awaitable,
                                                                            std::move(start));
}

}  // namespace oval4d::net
