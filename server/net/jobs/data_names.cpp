#include "net/jobs/data_names.hpp"

#include <cstddef>
#include <functional>
#include <utility>

#include "net/jobs/run_on_pool.hpp"

namespace oval4d::net {

namespace {

using Names = std::vector<std::string>;

constexpr Seconds kListing{0.002};  // a rough estimate of the time to read the folder

std::function<Names(std::size_t worker)> listJob(const DataFolder& data) {
    return [&data](std::size_t /*worker*/) { return data.names(); };
}

}  // namespace

boost::asio::awaitable<Names> dataNames(Services services, AddressAccountPtr client) {
    if (auto known = services.data.knownNames()) co_return *std::move(known);
    co_return co_await runOnPool<Names>(services.loadWorkers, listJob(services.data), client->loadJobQueue(), kListing);
}

}  // namespace oval4d::net
