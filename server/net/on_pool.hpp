#pragma once
// Waiting in a coroutine for a job of the worker pool.

#include <boost/asio/associated_executor.hpp>
#include <boost/asio/async_result.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <exception>
#include <functional>
#include <memory>
#include <utility>

#include "net/worker_pool.hpp"

namespace oval4d::net {

/// Carries out `work` on a worker, in its turn in `lane`; the coroutine goes on, on its own executor, with the value or
/// the exception. Make `work` in an ordinary function: GCC 12 destroys twice what a closure in a coroutine has
/// captured.
template <typename Value>
boost::asio::awaitable<Value> onPool(WorkerPool& pool, std::function<Value(picture::Painter&)> work,
                                     WorkerPool::LanePtr lane = nullptr) {
    namespace asio = boost::asio;
    auto start = [&pool](auto handler, std::function<Value(picture::Painter&)> job, WorkerPool::LanePtr in) {
        // A std::function must copy, a completion handler cannot: so it is shared.
        auto shared = std::make_shared<decltype(handler)>(std::move(handler));
        auto carryOut = [shared, job = std::move(job)](picture::Painter& painter) mutable {
            std::exception_ptr failure;
            auto value = std::make_shared<Value>();
            try {
                *value = job(painter);
            } catch (...) {
                failure = std::current_exception();
            }
            const auto executor = asio::get_associated_executor(*shared);
            asio::post(executor, [shared = std::move(shared), failure, value]() mutable {
                std::move (*shared)(failure, std::move(*value));
            });
        };
        pool.post(std::move(carryOut), std::move(in));
    };
    return asio::async_initiate<const asio::use_awaitable_t<>, void(std::exception_ptr, Value)>(
        start, asio::use_awaitable, std::move(work), std::move(lane));
}

}  // namespace oval4d::net
