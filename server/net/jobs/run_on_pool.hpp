#pragma once
// Runs a job on a worker pool, while a coroutine waits for the result.

#include <boost/asio/associated_executor.hpp>
#include <boost/asio/async_result.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <exception>
#include <functional>
#include <memory>
#include <utility>

#include "parallel/worker_pool.hpp"

namespace oval4d::net {

/// Queues the function `work` in the job queue `jobQueue` of `pool`, suspends the coroutine until a worker has run
/// `work`, and returns the result of `work`. `pool` is a parallel::WorkerPool or a pipeline::PipelinePool. `cost` is
/// the estimated running time of `work`. The coroutine resumes on its own executor. Throws the exception of `work`, or
/// QueueFull if the pool rejects the job. Create `work` in an ordinary function, not in a coroutine: GCC 12 destroys
/// the captures of a lambda in a coroutine twice.
template <typename Value, typename Pool>
boost::asio::awaitable<Value> runOnPool(Pool& pool, std::function<Value(typename Pool::JobArgument)> work,
                                        parallel::WorkerPool::JobQueuePtr jobQueue,
                                        parallel::WorkerPool::Seconds cost) {
    namespace asio = boost::asio;
    auto start = [&pool, cost](auto handler, std::function<Value(typename Pool::JobArgument)> job,
                               parallel::WorkerPool::JobQueuePtr in) {
        // The completion handler can only be moved, but std::function requires a target that can be copied.
        auto shared = std::make_shared<decltype(handler)>(std::move(handler));
        auto run = [shared, job = std::move(job)](typename Pool::JobArgument argument) mutable {
            std::exception_ptr failure;
            auto value = std::make_shared<Value>();
            try {
                *value = job(argument);
            } catch (...) {
                failure = std::current_exception();
            }
            const auto executor = asio::get_associated_executor(*shared);
            asio::post(executor, [shared = std::move(shared), failure, value]() mutable {
                std::move (*shared)(failure, std::move(*value));
            });
        };
        if (pool.post(std::move(run), std::move(in), cost)) return;
        const auto executor = asio::get_associated_executor(*shared);
        asio::post(executor, [shared]() mutable {
            std::move (*shared)(std::make_exception_ptr(parallel::QueueFull()), Value{});
        });
    };
    return asio::async_initiate<const asio::use_awaitable_t<>, void(std::exception_ptr, Value)>(
        start, asio::use_awaitable, std::move(work), std::move(jobQueue));
}

}  // namespace oval4d::net
