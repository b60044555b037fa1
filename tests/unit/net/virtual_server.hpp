#pragma once
// The services of a server in virtual time, for tests of sessions and connections.

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <cstddef>
#include <functional>
#include <future>
#include <memory>
#include <stop_token>
#include <thread>
#include <utility>

#include "hang_limit.hpp"
#include "net/services.hpp"
#include "parallel/fork_join.hpp"
#include "process/process_heap.hpp"
#include "raster/rasterizer.hpp"
#include "unit/net/virtual_timer_clock.hpp"

namespace oval4d::net {

/// The services of a server with one picture worker. Virtual time passes only in advance(). Handlers run only within
/// the functions of this class, on the thread that calls them.
class VirtualServer {
    // These members are declared first, because public members use them.
    parallel::ForkJoin forkJoin_;
    process::ProcessHeap heap_;

  public:
    explicit VirtualServer(ServerOptions serverOptions = {}) : options(std::move(serverOptions)) {}
    VirtualServer(const VirtualServer&) = delete;
    VirtualServer& operator=(const VirtualServer&) = delete;

    const ServerOptions options;
    VirtualTimerClock clock;
    ByteBudget budget{options.maxBytes};
    ClientAccounts clients{options.client, options.trustedProxies, options.maxBytes};
    FieldCacheFiles fieldCacheFiles{options.fieldCacheFolder, options.fieldCache};
    boost::asio::io_context io;
    Metrics metrics;
    file_reading::FileReaderPool readers{file_reading::FileReaderOptions{
        options.loadTimeout, Seconds(10), [](const process::ProcessLoss& /*loss*/) {}, {}, 1}};
    polytopes::PolytopeCache polytopes{options.polytopeCache};
    DataFolder data{options.data, options.dataCache, fieldCacheFiles};
    slicing::CriticalSectionsCache critical{options.criticalCache};
    pipeline::PipelinePool pictureWorkers{
        pipeline::PipelinePool::PoolOptions{
            .limits = options.jobs,
            .pictures = options.picture,
            .makeRasterizer =
                [](const std::stop_token& /*stop*/) { return std::make_unique<raster::LocalRasterizer>(); }},
        forkJoin_, heap_};
    parallel::WorkerPool exportWorkers{parallel::WorkerPool::PoolOptions{}},
        loadWorkers{parallel::WorkerPool::PoolOptions{}};
    const Services services{options, io,        pictureWorkers, exportWorkers,   metrics,  clients, loadWorkers,
                            readers, polytopes, data,           fieldCacheFiles, critical, clock};
    const ClientAccountPtr account = std::make_shared<ClientAccount>("192.0.2.1", options.client, budget, clock.now());

    /// Runs all handlers that are ready, or become ready meanwhile. Returns how many have run.
    std::size_t runHandlers() {
        std::size_t count = 0;
        for (std::size_t some = 1; some > 0; count += some) {
            io.restart();
            some = io.poll();
        }
        return count;
    }

    /// Runs handlers and picture jobs until none can run without the passing of time.
    void settle() {
        while (runHandlers() > 0 || !waitForRunningPictureJob() || runHandlers() > 0) {
        }
    }

    /// Lets virtual time pass. Advances the clock to the expiry of one timer after another, and settles after each.
    void advance(TimerClock::Clock::duration by) {
        const auto end = clock.now() + by;
        settle();
        for (auto next = clock.nextCall(); next && *next <= end; next = clock.nextCall()) {
            clock.advanceTo(*next);
            settle();
        }
        clock.advanceTo(end);
        settle();
    }

    /// Calls settle() repeatedly until `happened` returns true. Returns false if this exceeds the time limit of tests.
    [[nodiscard]] bool eventually(const std::function<bool()>& happened) {
        return support::eventually(happened, [this] { settle(); });
    }

  private:
    /// Waits until the running picture job, if any, has ended. Returns false if further jobs were waiting.
    bool waitForRunningPictureJob() {
        if (pictureWorkers.workers().waitingJobCount() > 0) {
            std::this_thread::yield();
            return false;
        }
        std::promise<void> ended;
        // There is only one worker, so this job starts after the running job has ended.
        if (!pictureWorkers.workers().post([&ended](std::size_t /*worker*/) { ended.set_value(); }, nullptr, {}))
            return false;
        ended.get_future().wait();
        return true;
    }
};

}  // namespace oval4d::net
