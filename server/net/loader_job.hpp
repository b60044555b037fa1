#pragma once

#include <functional>
#include <memory>
#include <variant>

#include "session/object_loader.hpp"

namespace oval4d::net {

/// Returns a job for a worker pool that builds or reads the object for which the loader is pending.
inline std::function<std::monostate(std::size_t worker)> loaderJob(
    const std::shared_ptr<session::ObjectLoader>& loader) {
    return [loader](std::size_t /*worker*/) {
        loader->loadPendingObject();
        return std::monostate{};
    };
}

}  // namespace oval4d::net
