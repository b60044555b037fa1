#pragma once

#include <memory>

#include "store/store.hpp"

namespace oval4d::store {

/// Opens the store that `options.url` names. Throws std::invalid_argument if `url` is malformed, StoreError if a
/// file cannot be used. A store on the network need not be reachable yet.
std::unique_ptr<Store> openStore(const StoreOptions& options);

}  // namespace oval4d::store
