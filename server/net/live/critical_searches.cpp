#include "net/live/critical_searches.hpp"

#include <utility>

namespace oval4d::net {

CriticalValueSearch::CriticalValueSearch(std::weak_ptr<Peer> by, const session::State& state,
                                         std::stop_token workersStop)
    : by_(std::move(by)),
      arguments_(session::criticalSearchArguments(state)),
      whenWorkersStop_(std::move(workersStop), StopRequester{stop_}) {}

std::shared_ptr<CriticalValueSearch> CriticalValueSearches::add(const std::shared_ptr<Peer>& by,
                                                                const session::State& state,
                                                                std::stop_token workersStop) {
    std::erase_if(searches_, [](const auto& each) { return each.expired(); });
    auto search = std::make_shared<CriticalValueSearch>(by, state, std::move(workersStop));
    searches_.push_back(search);
    return search;
}

void CriticalValueSearches::stopSearchesOf(const std::shared_ptr<Peer>& by) {
    for (const auto& search : runningSearches()) {
        if (search->isRequestedBy(by)) search->stop();
    }
}

void CriticalValueSearches::stopUnneededSearches(const session::State& state) {
    if (searches_.empty()) return;
    const session::CriticalSearchArguments needed = session::criticalSearchArguments(state);
    for (const auto& search : runningSearches()) {
        if (search->arguments() != needed) search->stop();
    }
}

std::vector<std::shared_ptr<CriticalValueSearch>> CriticalValueSearches::runningSearches() const {
    std::vector<std::shared_ptr<CriticalValueSearch>> found;
    for (const auto& each : searches_) {
        if (auto search = each.lock()) found.push_back(std::move(search));
    }
    return found;
}

}  // namespace oval4d::net
