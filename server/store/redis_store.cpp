#include "store/redis_store.hpp"

#include <hiredis/hiredis.h>
#include <sys/time.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "store/secret.hpp"

namespace oval4d::store {

namespace {

using namespace std::chrono_literals;

// KEYS: the session, its polytopes. ARGV: this server, expiry in milliseconds, the session's id. A full Redis allows it
// too: what can be read can be gone on with.
constexpr const char* kClaim = R"(#!lua flags=allow-oom
local owner, whole, head = unpack(redis.call('HMGET', KEYS[1], 'owner', 'whole', 'head'))
if not whole then return false end
if owner and owner ~= '' and owner ~= ARGV[1] then
  redis.call('RPUSH', 'oval4d:taken:' .. owner, ARGV[3])
  redis.call('PEXPIRE', 'oval4d:taken:' .. owner, 60000)
end
local fence = redis.call('HINCRBY', KEYS[1], 'fence', 1)
redis.call('HSET', KEYS[1], 'owner', ARGV[1])
redis.call('PEXPIRE', KEYS[1], ARGV[2])
redis.call('PEXPIRE', KEYS[2], ARGV[2])
return {fence, whole, head or '', redis.call('HGETALL', KEYS[2])})";

// KEYS: the same. ARGV: this server, expiry, fence, token, head, whole, 1 for the last saving, how many polytopes to
// add, their keys and bytes, the keys of those to drop. Of equal fences, which only a Redis that has lost writes gives
// out, the owner's is the right one. After a head comes the whole within a second, and it puts off the expiry.
constexpr const char* kSave = R"(
local fence, owner = unpack(redis.call('HMGET', KEYS[1], 'fence', 'owner'))
local mine = tonumber(ARGV[3])
if fence then
  fence = tonumber(fence)
  if fence > mine or (fence == mine and owner and owner ~= '' and owner ~= ARGV[1]) then return 1 end
elseif ARGV[6] == '' then return 2 end
local keeper = ARGV[1]
if ARGV[7] == '1' then keeper = '' end
redis.call('HSET', KEYS[1], 'fence', mine, 'owner', keeper, 'head', ARGV[5])
if ARGV[6] ~= '' then
  redis.call('HSET', KEYS[1], 'token', ARGV[4], 'whole', ARGV[6])
  redis.call('PEXPIRE', KEYS[1], ARGV[2])
  redis.call('PEXPIRE', KEYS[2], ARGV[2])
end
local last = 8 + 2 * tonumber(ARGV[8])
for i = 9, last, 2 do redis.call('HSET', KEYS[2], ARGV[i], ARGV[i + 1]) end
if last > 8 then redis.call('PEXPIRE', KEYS[2], ARGV[2]) end
for i = last + 1, #ARGV do redis.call('HDEL', KEYS[2], ARGV[i]) end
return 0)";

constexpr auto kConnectTimeout = 1000ms;

// In braces is what a cluster would choose the node by: a session's keys are together.
std::string sessionKey(const std::string& id) { return "oval4d:{" + id + "}"; }
std::string polytopesKey(const std::string& id) { return sessionKey(id) + ":polytopes"; }

timeval asTimeval(Milliseconds time) {
    return {static_cast<time_t>(time.count() / 1000), static_cast<suseconds_t>(time.count() % 1000 * 1000)};
}

std::string textOf(const redisReply& reply) {
    return reply.str == nullptr ? std::string() : std::string(reply.str, reply.len);
}

template <typename Number>
Number numberIn(std::string_view text, const std::string& what, Number least, Number most) {
    Number value{};
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (fault != std::errc{} || end != text.data() + text.size() || value < least || value > most) {
        throw std::invalid_argument("the " + what + " of a Redis is a number from " + std::to_string(least) + " to " +
                                    std::to_string(most) + ", not '" + std::string(text) + "'");
    }
    return value;
}

}  // namespace

void RedisStore::Closer::operator()(redisContext* context) const { redisFree(context); }
void RedisStore::Closer::operator()(redisReply* reply) const { freeReplyObject(reply); }

RedisStore::RedisStore(const StoreOptions& options)
    : expiry_(options.expiry), timeout_(options.timeout), self_(randomName(10)) {
    std::string_view rest = options.place;
    rest.remove_prefix(std::string_view("redis://").size());
    if (const auto at = rest.rfind('@'); at != std::string_view::npos) {
        const std::string_view login = rest.substr(0, at);
        const auto colon = login.find(':');
        user_ = login.substr(0, colon);
        if (colon != std::string_view::npos) password_ = login.substr(colon + 1);
        rest.remove_prefix(at + 1);
    }
    if (const auto slash = rest.find('/'); slash != std::string_view::npos) {
        database_ = rest.substr(slash + 1);
        if (!database_.empty()) numberIn(database_, "database", 0, 1'000'000);
        rest = rest.substr(0, slash);
    }
    if (const auto colon = rest.rfind(':'); colon != std::string_view::npos && rest.back() != ']') {
        port_ = numberIn(rest.substr(colon + 1), "port", 1, 65535);
        rest = rest.substr(0, colon);
    }
    if (rest.size() > 2 && rest.front() == '[') rest = rest.substr(1, rest.size() - 2);  // an address of IPv6
    host_ = rest;
    if (host_.empty()) throw std::invalid_argument("redis:// must be followed by a host");
}

RedisStore::~RedisStore() = default;

std::string RedisStore::name() const { return "redis://" + host_ + ":" + std::to_string(port_) + "/" + database_; }

void RedisStore::connect() {
    context_.reset(
        redisConnectWithTimeout(host_.c_str(), port_, asTimeval(std::min(timeout_, Milliseconds(kConnectTimeout)))));
    if (!context_) throw Outage("no memory for a connection");
    if (context_->err != 0) fail();
    redisSetTimeout(context_.get(), asTimeval(timeout_));
    redisEnableKeepAlive(context_.get());
    if (!password_.empty()) ask(user_.empty() ? Words{"AUTH", password_} : Words{"AUTH", user_, password_});
    if (!database_.empty()) ask({"SELECT", database_});
    claimScript_ = textOf(*ask({"SCRIPT", "LOAD", kClaim}));
    saveScript_ = textOf(*ask({"SCRIPT", "LOAD", kSave}));
}

/// Nothing is known of what the connection has still to say: the next call makes a new one.
void RedisStore::fail() {
    const std::string why = context_->errstr[0] != '\0' ? context_->errstr : "no answer";
    context_.reset();
    throw Outage(name() + ": " + why);
}

void RedisStore::send(const Words& words) {
    if (!context_) connect();
    std::vector<const char*> starts;
    std::vector<std::size_t> sizes;
    for (const std::string& word : words) {
        starts.push_back(word.data());
        sizes.push_back(word.size());
    }
    if (redisAppendCommandArgv(context_.get(), static_cast<int>(words.size()), starts.data(), sizes.data()) !=
        REDIS_OK) {
        fail();
    }
}

RedisStore::Reply RedisStore::receive() {
    void* reply = nullptr;
    if (redisGetReply(context_.get(), &reply) != REDIS_OK || reply == nullptr) fail();
    Reply owned(static_cast<redisReply*>(reply));
    if (owned->type == REDIS_REPLY_ERROR) {
        context_.reset();
        throw Outage(name() + ": " + textOf(*owned));
    }
    return owned;
}

RedisStore::Reply RedisStore::ask(const Words& words) {
    send(words);
    return receive();
}

std::optional<std::string> RedisStore::token(const std::string& id) {
    const Reply reply = ask({"HGET", sessionKey(id), "token"});
    return reply->type == REDIS_REPLY_STRING ? std::optional(textOf(*reply)) : std::nullopt;
}

std::optional<Record> RedisStore::claim(const std::string& id) {
    if (!context_) connect();
    const Reply reply = ask(
        {"EVALSHA", claimScript_, "2", sessionKey(id), polytopesKey(id), self_, std::to_string(expiry_.count()), id});
    if (reply->type != REDIS_REPLY_ARRAY || reply->elements != 4) return std::nullopt;
    Record record{
        textOf(*reply->element[1]), textOf(*reply->element[2]), {}, static_cast<Fence>(reply->element[0]->integer)};
    const redisReply& polytopes = *reply->element[3];
    for (std::size_t i = 0; i + 1 < polytopes.elements; i += 2) {
        record.polytopes.emplace_back(textOf(*polytopes.element[i]), textOf(*polytopes.element[i + 1]));
    }
    return record;
}

/// All in one go there and back.
std::vector<Saved> RedisStore::save(std::span<const Saving> savings) {
    if (!context_) connect();
    for (const Saving& saving : savings) {
        const std::string& id = saving.ticket.id;
        Words words{"EVALSHA",
                    saveScript_,
                    "2",
                    sessionKey(id),
                    polytopesKey(id),
                    self_,
                    std::to_string(expiry_.count()),
                    std::to_string(saving.fence),
                    saving.ticket.token,
                    saving.head,
                    saving.whole,
                    saving.last ? "1" : "0",
                    std::to_string(saving.polytopes.size())};
        for (const auto& [key, bytes] : saving.polytopes) {
            words.push_back(key);
            words.push_back(bytes);
        }
        words.insert(words.end(), saving.dropped.begin(), saving.dropped.end());
        send(words);
    }
    std::vector<Saved> said;
    for (std::size_t i = 0; i < savings.size(); ++i) said.push_back(static_cast<Saved>(receive()->integer));
    return said;
}

void RedisStore::touch(std::span<const std::string> ids) {
    for (const std::string& id : ids) {
        send({"PEXPIRE", sessionKey(id), std::to_string(expiry_.count())});
        send({"PEXPIRE", polytopesKey(id), std::to_string(expiry_.count())});
    }
    for (std::size_t i = 0; i < 2 * ids.size(); ++i) receive();
}

std::vector<std::string> RedisStore::pulse() {
    const std::string list = "oval4d:taken:" + self_;
    send({"MULTI"});
    send({"LRANGE", list, "0", "-1"});
    send({"DEL", list});
    send({"DBSIZE"});
    send({"EXEC"});
    for (int i = 0; i < 4; ++i) receive();
    const Reply reply = receive();
    std::vector<std::string> taken;
    if (reply->type != REDIS_REPLY_ARRAY || reply->elements != 3) return taken;
    for (std::size_t i = 0; i < reply->element[0]->elements; ++i)
        taken.push_back(textOf(*reply->element[0]->element[i]));
    size_ = static_cast<std::size_t>(reply->element[2]->integer);
    return taken;
}

}  // namespace oval4d::store
