#pragma once

#include <functional>
#include <memory>
#include <variant>

#include "session/object_loader.hpp"

namespace oval4d::net {

/// Returns a job for a worker pool. The job builds or reads the loader's pending object (see
/// ObjectLoader::loadPendingObject).
inline std::function<std::monostate(std::size_t worker)> loaderJob(
    const std::shared_ptr<session::ObjectLoader>& loader) {
    return [loader](std::size_t /*worker*/) {
        loader->loadPendingObject();
        return std::monostate{};
    };
}

}  // namespace oval4d::net
