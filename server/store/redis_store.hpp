#pragma once
// Sessions kept in Redis: any server that uses the same can go on with them.

#include <memory>

#include "store/store.hpp"

struct redisContext;  // NOLINT(readability-identifier-naming)
struct redisReply;    // NOLINT(readability-identifier-naming)

namespace oval4d::store {

/// A session is a hash, and its polytopes are another; both expire by Redis's own clock. What has to happen all at once
/// (raising the fence with a claim, comparing it with a save) is a script there. A server whose session is claimed by
/// another finds its id in a list of its own. Needs Redis 7 or later.
class RedisStore final : public Store {
  public:
    /// Connects at first use. Throws std::invalid_argument unless `options.place` is
    /// redis://[user:password@]host[:port][/database], the password as it is.
    explicit RedisStore(const StoreOptions& options);
    ~RedisStore() override;

    Pace pace() const override { return Pace::at_once; }
    std::string name() const override;
    std::optional<std::string> token(const std::string& id) override;
    std::optional<Record> claim(const std::string& id) override;
    std::vector<Saved> save(std::span<const Saving> savings) override;
    void touch(std::span<const std::string> ids) override;
    std::size_t expire(Milliseconds /*age*/) override { return 0; }
    std::vector<std::string> pulse() override;
    std::size_t size() const override { return size_; }

  private:
    struct Closer {
        void operator()(redisContext* context) const;
        void operator()(redisReply* reply) const;
    };
    using Reply = std::unique_ptr<redisReply, Closer>;
    using Words = std::vector<std::string>;

    void connect();
    [[noreturn]] void fail();
    void send(const Words& words);
    Reply receive();
    Reply ask(const Words& words);

    std::string host_, user_, password_, database_;
    int port_ = 6379;
    const Milliseconds expiry_, timeout_;
    const std::string self_;  ///< this server's name
    std::unique_ptr<redisContext, Closer> context_;
    std::string claimScript_, saveScript_;  ///< their digests
    std::size_t size_ = 0;
};

}  // namespace oval4d::store
