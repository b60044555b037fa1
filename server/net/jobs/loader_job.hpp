#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <utility>
#include <variant>

#include "session/object_loader.hpp"

namespace oval4d::net {

/// Returns a job that does the work that `loader` has deferred (see ObjectLoader::completePending()). If the work is a
/// search for critical values of w, a stop request through `stop` ends it early.
inline std::function<std::monostate(std::size_t worker)> loaderJob(const std::shared_ptr<session::ObjectLoader>& loader,
                                                                   std::stop_token stop = {}) {
    return [loader, stop = std::move(stop)](std::size_t /*worker*/) {
        loader->completePending(stop);
        return std::monostate{};
    };
}

}  // namespace oval4d::net
