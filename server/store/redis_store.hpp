#pragma once
// A session store in Redis. Servers that use the same Redis share their sessions.

#include <chrono>
#include <memory>

#include "store/store.hpp"

struct redisContext;  // NOLINT(readability-identifier-naming)
struct redisReply;    // NOLINT(readability-identifier-naming)

namespace oval4d::store {

/// A session store in Redis. The record of a session is one Redis hash, and its objects are another; Redis itself
/// deletes both when they expire. Operations that must be atomic are Lua scripts: for example, a claim increments the
/// fence (the number of the claim), and a save compares the fence. Each server has a Redis list of the ids of sessions
/// that other servers have claimed from it. If the server has claimed a session back since then, the id in its list is
/// out of date; the fence in the session's record shows this. Requires Redis 7 or later.
class RedisStore final : public Store {
  public:
    using Clock = std::chrono::steady_clock;

    /// Does not connect; the first operation connects. Throws std::invalid_argument unless `options.url` has the form
    /// redis://[user:password@]host[:port][/database]. The password is not percent-decoded.
    explicit RedisStore(const StoreOptions& options, ClockFunction<Clock> now = Clock::now);
    ~RedisStore() override;

    WriteTiming writeTiming() const override { return WriteTiming::at_once; }
    std::string name() const override;
    std::optional<std::string> tokenHash(const std::string& id) override;
    std::optional<SessionRecord> read(const std::string& id) override;
    std::optional<SessionRecord> claim(const std::string& id) override;
    std::vector<SaveResult> save(std::span<const RecordUpdate> updates) override;
    /// Does nothing and returns 0, because Redis has a quota of its own, `maxmemory`.
    std::size_t evict(std::span<const RecordUpdate> /*updates*/, const PinnedPredicate& /*isPinned*/) override {
        return 0;
    }
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
    [[noreturn]] void disconnectAndThrow();
    void send(const CommandWords& command);
    Reply receiveReplyOrError();
    Reply receive();
    Reply sendAndReceive(const CommandWords& command);
    Reply sendAndReceive(const std::string& script, const std::string& id, const CommandWords& arguments);
    void updatePlainTokenDeadline();
    bool alsoStoresPlainTokens() const;

    std::string host_, user_, password_, database_;
    int port_ = 6379;
    const Milliseconds expiry_, timeout_;
    const std::string self_;  // a random name that identifies this server in Redis
    const ClockFunction<Clock> now_;
    std::unique_ptr<redisContext, RedisDeleter> context_;
    // The SHA-1 digests of the Lua scripts, by which this server calls the scripts in Redis.
    std::string readScript_, claimScript_, saveScript_, hashScript_, removeScript_, pollScript_;
    // Until this time, tokens are also stored as plain text, because oval4d servers of version 0.1.0 use the same
    // Redis.
    Clock::time_point plainUntil_;
    std::size_t size_ = 0;
};

}  // namespace oval4d::store
