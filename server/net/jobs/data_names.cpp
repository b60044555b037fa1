#include "net/jobs/data_names.hpp"

#include <cstddef>
#include <functional>
#include <utility>

#include "net/jobs/run_on_pool.hpp"

namespace oval4d::net {

namespace {

using DataNames = std::vector<std::string>;

constexpr Seconds kListing{0.002};  // the estimated time to list the data folder, for the worker pool

std::function<DataNames(std::size_t worker)> listNamesJob(const DataFolder& data) {
    return [&data](std::size_t /*worker*/) { return data.entryNames(); };
}

}  // namespace

boost::asio::awaitable<DataNames> dataFolderNames(Services services, ClientAccountPtr client) {
    if (auto known = services.data.cachedNames()) co_return *std::move(known);
    co_return co_await runOnPool<DataNames>(services.loadWorkers, listNamesJob(services.data), client->loadJobQueue(),
                                            kListing);
}

}  // namespace oval4d::net
