#pragma once
// Waiting in a coroutine.

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

/// Asio's operations then give their error code, first of what they give, and throw nothing.
inline constexpr auto kQuietly = boost::asio::as_tuple(boost::asio::use_awaitable);

/// A duration as the timers take it.
template <typename Duration>
auto steady(Duration duration) {
    return std::chrono::duration_cast<std::chrono::steady_clock::duration>(duration);
}

/// Calls `start` with a function that is to be called once, from any thread; the coroutine then goes on, on its own
/// executor, with the value given. Make `start` in an ordinary function: GCC 12 destroys twice what a closure in a
/// coroutine has captured.
template <typename Value>
boost::asio::awaitable<Value> awaited(std::function<void(std::function<void(Value)>)> start) {
    namespace asio = boost::asio;
    auto initiate = [](auto handler, const std::function<void(std::function<void(Value)>)>& begin) {
        // A std::function must copy, a completion handler cannot: so it is shared.
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
