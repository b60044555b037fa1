#pragma once

#include <memory>

#include "store/store.hpp"

namespace oval4d::store {

/// Opens the session store at `options.url`. Throws std::invalid_argument if the URL is malformed. Throws StoreError if
/// the file of an SQLite store cannot be used. A Redis server need not be reachable yet.
std::unique_ptr<Store> openStore(const StoreOptions& options);

}  // namespace oval4d::store
