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

/// A completion token for awaited operations. With it, an operation returns a tuple that begins with the error code,
/// instead of throwing an exception.
inline constexpr auto kAsTuple = boost::asio::as_tuple(boost::asio::use_awaitable);

/// Converts any duration to the duration type of asio::steady_timer.
template <typename Duration>
auto toSteadyDuration(Duration duration) {
    return std::chrono::duration_cast<std::chrono::steady_clock::duration>(duration);
}

/// Calls `start` with a callback, suspends the coroutine until the callback is called, and returns the value passed to
/// it. `start` must make sure that the callback is called exactly once, on any thread. The coroutine resumes on its own
/// executor. Create `start` in an ordinary function, not in a coroutine: GCC 12 destroys the captures of a lambda in a
/// coroutine twice.
template <typename Value>
boost::asio::awaitable<Value> awaitCallback(std::function<void(std::function<void(Value)>)> start) {
    namespace asio = boost::asio;
    auto initiate = [](auto handler, const std::function<void(std::function<void(Value)>)>& begin) {
        // The completion handler can only be moved, but std::function requires a target that can be copied.
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
