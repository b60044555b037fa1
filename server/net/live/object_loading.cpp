#include "net/live/object_loading.hpp"

#include <utility>
#include <variant>

#include "net/jobs/file_reader.hpp"
#include "net/jobs/loader_job.hpp"
#include "net/jobs/run_on_pool.hpp"
#include "parallel/worker_pool.hpp"

namespace oval4d::net {

namespace asio = boost::asio;

session::ObjectLoader ObjectLoading::makeLoader() const {
    const session::CriticalSearchOptions search{&services_.critical, services_.options.file.time};
    return {services_.options.session, services_.polytopes, session::ObjectLoader::LoadingMode::deferred,
            session::FileReader(), search};
}

asio::awaitable<std::optional<Error>> ObjectLoading::completePending(ClientAccountPtr by, std::shared_ptr<Peer> peer,
                                                                     session::ObjectLoader& loader,
                                                                     std::stop_token stop) {
    auto reservation = metered_->client()->byteAccount().reserve(loader.estimatedMemory());
    if (!reservation) co_return kTooManyBytes;
    const parallel::WorkerPool::Seconds cost = loader.estimatedDuration();
    const bool needsFile = loader.pendingNeedsFile();
    std::shared_ptr<CriticalValueSearch> search;
    if (loader.isSearchPending())
        search = searches_.add(peer, metered_->value.current, services_.exportWorkers.stopToken());
    // The worker shares the ownership of the loader, because the worker may outlive this coroutine.
    const auto running = std::make_shared<session::ObjectLoader>(std::move(loader));
    if (needsFile) {
        running->readFilesWith(makeFileReader(services_, std::move(stop)));
        co_await runOnPool<std::monostate>(services_.loadWorkers, loaderJob(running),
                                           metered_->client()->loadJobQueue(), cost);
    } else if (search) {
        co_await runOnPool<std::monostate>(services_.exportWorkers, loaderJob(running, search->stopToken()),
                                           publisher_->jobQueuesOf(by).exports, cost);
    } else {
        co_await runOnPool<std::monostate>(services_.pictureWorkers.workers(), loaderJob(running),
                                           publisher_->jobQueuesOf(by).pictures, cost);
    }
    loader = std::move(*running);
    const std::size_t bytes = loader.loadedObjectMemory();
    if (bytes > reservation->size() && !reservation->growTo(bytes)) co_return kTooManyBytes;
    co_return std::nullopt;
}

asio::awaitable<Result<slicing::Object>> ObjectLoading::readArrayInBackground(session::LoadObject load,
                                                                              std::stop_token stop) {
    session::ObjectLoader loader = makeLoader();
    Result<session::ObjectWithWarnings> read = loader.objectFrom(load);
    if (loader.isPending()) {
        if (auto refused = co_await completePending(metered_->client(), nullptr, loader, std::move(stop)))
            co_return *refused;
        read = loader.objectFrom(load);
    }
    if (!read) co_return read.error();
    co_return read->object;
}

}  // namespace oval4d::net
