#pragma once
// A store in Redis: servers that use the same Redis share their sessions.

#include <chrono>
#include <memory>

#include "store/store.hpp"

struct redisContext;  // NOLINT(readability-identifier-naming)
struct redisReply;    // NOLINT(readability-identifier-naming)

namespace oval4d::store {

/// Stores each session in one Redis hash and its objects in another; Redis itself expires both. Operations that must be
/// atomic are Lua scripts, such as a claim, which increments the fence, and a save, which compares the fence. Each
/// server has a Redis list, to which other servers add the ids of the sessions that they claim from this server. If
/// this server has claimed a session back in the meantime, the id in its list is out of date; the fence in the record
/// shows that. Requires Redis 7 or later.
class RedisStore final : public Store {
  public:
    using Clock = std::chrono::steady_clock;

    /// Does not connect; the first operation connects. Throws std::invalid_argument unless `options.url` is
    /// redis://[user:password@]host[:port][/database]. The password is not percent-decoded.
    explicit RedisStore(const StoreOptions& options, ClockFunction<Clock> now = Clock::now);
    ~RedisStore() override;

    WritePolicy writePolicy() const override { return WritePolicy::at_once; }
    std::string name() const override;
    std::optional<std::string> tokenHash(const std::string& id) override;
    std::optional<SessionRecord> read(const std::string& id) override;
    std::optional<SessionRecord> claim(const std::string& id) override;
    std::vector<SaveResult> save(std::span<const RecordUpdate> updates) override;
    /// Does nothing and returns 0: Redis has its own quota, `maxmemory`.
    std::size_t evict(std::span<const RecordUpdate> /*updates*/, const IsPinned& /*isPinned*/) override { return 0; }
    void remove(std::span<const std::string> ids) override;
    void restartExpiry(std::span<const std::string> ids) override;
    std::size_t expire(Milliseconds /*age*/) override { return 0; }
    std::vector<TakenOverSession> pollTakenOverSessions() override;
    std::size_t size() const override { return size_; }

  private:
    struct RedisDeleter {
        void operator()(redisContext* context) const;
        void operator()(redisReply* reply) const;
    };
    using Reply = std::unique_ptr<redisReply, RedisDeleter>;
    using CommandWords = std::vector<std::string>;

    void connect();
    [[noreturn]] void fail();
    void send(const CommandWords& command);
    Reply receiveAny();
    Reply receive();
    Reply ask(const CommandWords& command);
    Reply ask(const std::string& script, const std::string& id, const CommandWords& arguments);
    void updatePlainTokenDeadline();
    bool alsoStoresPlainTokens() const;

    std::string host_, user_, password_, database_;
    int port_ = 6379;
    const Milliseconds expiry_, timeout_;
    const std::string self_;  // random name of this server in Redis
    const ClockFunction<Clock> now_;
    std::unique_ptr<redisContext, RedisDeleter> context_;
    // SHA-1 digests of the loaded scripts.
    std::string readScript_, claimScript_, saveScript_, hashScript_, removeScript_, pollScript_;
    // Until this time, tokens are also stored as plain text, for oval4d servers of version 0.1.0 on the same Redis.
    Clock::time_point plainUntil_;
    std::size_t size_ = 0;
};

}  // namespace oval4d::store
