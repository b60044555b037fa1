#pragma once
// A store in Redis: servers that use the same Redis share their sessions.

#include <memory>

#include "store/store.hpp"

struct redisContext;  // NOLINT(readability-identifier-naming)
struct redisReply;    // NOLINT(readability-identifier-naming)

namespace oval4d::store {

/// A session is a Redis hash, and its objects are another; Redis itself expires both. Operations that must be atomic
/// (a claim that increments the fence, a save that compares it) are Lua scripts. The ids of sessions that other servers
/// have claimed from this one are in a Redis list of its own. Requires Redis 7 or later.
class RedisStore final : public Store {
  public:
    /// Connects at first use. Throws std::invalid_argument unless `options.place` is
    /// redis://[user:password@]host[:port][/database], with no percent-encoding in the password.
    explicit RedisStore(const StoreOptions& options);
    ~RedisStore() override;

    WritePolicy writePolicy() const override { return WritePolicy::at_once; }
    std::string name() const override;
    std::optional<std::string> tokenHash(const std::string& id) override;
    std::optional<Record> claim(const std::string& id) override;
    std::vector<SaveResult> save(std::span<const RecordUpdate> updates) override;
    /// Evicts nothing: Redis has its own quota, `maxmemory`.
    std::size_t evict(std::span<const RecordUpdate> /*updates*/, const IsPinned& /*isPinned*/) override { return 0; }
    void remove(std::span<const std::string> ids) override;
    void touch(std::span<const std::string> ids) override;
    std::size_t expire(Milliseconds /*age*/) override { return 0; }
    std::vector<std::string> poll() override;
    std::size_t size() const override { return size_; }

  private:
    struct Closer {
        void operator()(redisContext* context) const;
        void operator()(redisReply* reply) const;
    };
    using Reply = std::unique_ptr<redisReply, Closer>;
    using Arguments = std::vector<std::string>;

    void connect();
    [[noreturn]] void fail();
    void send(const Arguments& command);
    Reply receive();
    Reply ask(const Arguments& command);
    Reply ask(const std::string& script, const std::string& id, const Arguments& arguments);
    void detectOlderServers();
    bool storesPlainTokens() const;

    std::string host_, user_, password_, database_;
    int port_ = 6379;
    const Milliseconds expiry_, timeout_;
    const std::string self_;  ///< random name of this server
    std::unique_ptr<redisContext, Closer> context_;
    std::string claimScript_, saveScript_, hashScript_, removeScript_;  ///< SHA-1 digests, by which Redis knows them
    std::chrono::steady_clock::time_point plainUntil_;  ///< until then, servers of version 0.1.0 may read the tokens
    std::size_t size_ = 0;
};

}  // namespace oval4d::store
