#include "net/live/object_loading.hpp"

#include <utility>
#include <variant>

#include "net/jobs/file_reader.hpp"
#include "net/jobs/loader_job.hpp"
#include "net/jobs/run_on_pool.hpp"

namespace oval4d::net {

namespace asio = boost::asio;

std::shared_ptr<session::ObjectLoader> ObjectLoading::makeLoader() const {
    const session::CriticalSearchOptions search{&services_.critical, services_.options.file.time};
    return std::make_shared<session::ObjectLoader>(services_.options.session, services_.polytopes,
                                                   session::ObjectLoader::Mode::deferred, fileReader(services_),
                                                   search);
}

std::shared_ptr<CriticalSearchHandle> ObjectLoading::registerSearch(const std::shared_ptr<Peer>& peer) {
    return searches_.add(peer, metered_->value.current, services_.exportWorkers.stopToken());
}

asio::awaitable<std::optional<Error>> ObjectLoading::completePending(AddressAccountPtr by,
                                                                     std::shared_ptr<session::ObjectLoader> loader,
                                                                     std::shared_ptr<CriticalSearchHandle> search) {
    auto reservation = metered_->client()->byteAccount().reserve(loader->memoryNeeded());
    if (!reservation) co_return kTooManyBytes;
    if (loader->pendingNeedsFile()) {
        co_await runOnPool<std::monostate>(services_.loadWorkers, loaderJob(loader), metered_->client()->loadJobQueue(),
                                           loader->estimatedDuration());
    } else if (search) {
        co_await runOnPool<std::monostate>(services_.exportWorkers, loaderJob(loader, search->stopToken()),
                                           streams_->jobQueuesOf(by).exports, loader->estimatedDuration());
    } else {
        co_await runOnPool<std::monostate>(services_.pictureWorkers.workers(), loaderJob(loader),
                                           streams_->jobQueuesOf(by).pictures, loader->estimatedDuration());
    }
    const std::size_t bytes = loader->loadedObjectMemory();
    if (bytes > reservation->size() && !reservation->growTo(bytes)) co_return kTooManyBytes;
    co_return std::nullopt;
}

}  // namespace oval4d::net
