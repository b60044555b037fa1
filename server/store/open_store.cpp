#include "store/open_store.hpp"

#include "store/memory_store.hpp"
#include "store/redis_store.hpp"
#include "store/sqlite_store.hpp"

namespace oval4d::store {

std::unique_ptr<Store> openStore(const StoreOptions& options) {
    constexpr std::string_view kSqlite = "sqlite:", kRedis = "redis://";
    const std::string_view url = options.url;
    if (url == "memory") return std::make_unique<MemoryStore>(options.quota);
    if (url.starts_with(kSqlite) && url.size() > kSqlite.size()) {
        return std::make_unique<SqliteStore>(std::string(url.substr(kSqlite.size())), options.quota);
    }
    if (url.starts_with(kRedis)) return std::make_unique<RedisStore>(options);
    throw std::invalid_argument("the store must be memory, sqlite:PATH or redis://host, not '" + options.url + "'");
}

}  // namespace oval4d::store
