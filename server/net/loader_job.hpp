#pragma once

#include <functional>
#include <memory>
#include <variant>

#include "session/object_loader.hpp"

namespace oval4d::net {

/// A job for a worker pool that carries out the loader's order.
inline std::function<std::monostate(std::size_t worker)> loaderJob(
    const std::shared_ptr<session::ObjectLoader>& loader) {
    return [loader](std::size_t /*worker*/) {
        loader->loadPending();
        return std::monostate{};
    };
}

}  // namespace oval4d::net
