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
    return {services_.options.session, services_.polytopes, session::ObjectLoader::Mode::deferred,
            session::FileReader(), search};
}

asio::awaitable<std::optional<Error>> ObjectLoading::completePending(AddressAccountPtr by, std::shared_ptr<Peer> peer,
                                                                     session::ObjectLoader& loader) {
    auto reservation = metered_->client()->byteAccount().reserve(loader.memoryNeeded());
    if (!reservation) co_return kTooManyBytes;
    const parallel::WorkerPool::Seconds cost = loader.estimatedDuration();
    const bool needsFile = loader.pendingNeedsFile();
    std::shared_ptr<CriticalSearchHandle> search;
    if (loader.isSearchPending())
        search = searches_.add(peer, metered_->value.current, services_.exportWorkers.stopToken());
    // The worker shares the ownership of the loader, because it may outlive this coroutine.
    const auto running = std::make_shared<session::ObjectLoader>(std::move(loader));
    if (needsFile) {
        running->readFilesWith(fileReader(services_));
        co_await runOnPool<std::monostate>(services_.loadWorkers, loaderJob(running),
                                           metered_->client()->loadJobQueue(), cost);
    } else if (search) {
        co_await runOnPool<std::monostate>(services_.exportWorkers, loaderJob(running, search->stopToken()),
                                           streams_->jobQueuesOf(by).exports, cost);
    } else {
        co_await runOnPool<std::monostate>(services_.pictureWorkers.workers(), loaderJob(running),
                                           streams_->jobQueuesOf(by).pictures, cost);
    }
    loader = std::move(*running);
    const std::size_t bytes = loader.loadedObjectMemory();
    if (bytes > reservation->size() && !reservation->growTo(bytes)) co_return kTooManyBytes;
    co_return std::nullopt;
}

}  // namespace oval4d::net
