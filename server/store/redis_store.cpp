#include "store/redis_store.hpp"

#include <hiredis/hiredis.h>
#include <sys/time.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "store/secret.hpp"

namespace oval4d::store {

namespace {

using namespace std::chrono_literals;

// A Redis script that reads a session. KEYS: the two Redis hashes with the session and its objects. Returns {fence,
// whole, head, objects}, or false if there is no such session.
constexpr const char* kRead = R"(#!lua flags=no-writes,allow-oom
local fence, whole, head = unpack(redis.call('HMGET', KEYS[1], 'fence', 'whole', 'head'))
if not whole then return false end
return {tonumber(fence) or 0, whole, head or '', redis.call('HGETALL', KEYS[2])})";

// A Redis script that claims a session for this server. KEYS: as for kRead. ARGV: the name of this server, the expiry
// period in milliseconds, the session's id. Returns the same as kRead, with the new fence. The flag allow-oom lets
// Redis run the script even if its memory is full, so that stored sessions can still be opened.
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

// A Redis script that saves a session. KEYS: as for kRead. ARGV: the name of this server, the expiry period in
// milliseconds, the fence, the hash of the token, the token as plain text (empty if it must not be stored), the head,
// the whole (empty if unchanged), 1 if no client has the session open anymore and else 0, the number of objects to add,
// the key and the bytes of each of them, the keys of the objects to drop. Returns the number of a SaveResult. Two
// servers can have equal fences for a session only if Redis has lost writes. In this case, only the owner in the record
// may save. Saving the head alone does not restart the expiry period, because a save of the whole session follows
// within a second.
constexpr const char* kSave = R"(
local fence, owner = unpack(redis.call('HMGET', KEYS[1], 'fence', 'owner'))
local mine = tonumber(ARGV[3])
if fence then
  fence = tonumber(fence)
  if fence > mine or (fence == mine and owner and owner ~= '' and owner ~= ARGV[1]) then return 1 end
elseif ARGV[7] == '' then return 2 end
local newOwner = ARGV[1]
if ARGV[8] == '1' then newOwner = '' end
redis.call('HSET', KEYS[1], 'fence', mine, 'owner', newOwner, 'head', ARGV[6], 'hash', ARGV[4])
if ARGV[5] ~= '' then redis.call('HSET', KEYS[1], 'token', ARGV[5]) else redis.call('HDEL', KEYS[1], 'token') end
if ARGV[7] ~= '' then
  redis.call('HSET', KEYS[1], 'whole', ARGV[7])
  redis.call('PEXPIRE', KEYS[1], ARGV[2])
  redis.call('PEXPIRE', KEYS[2], ARGV[2])
end
local last = 9 + 2 * tonumber(ARGV[9])
for i = 10, last, 2 do redis.call('HSET', KEYS[2], ARGV[i], ARGV[i + 1]) end
if last > 9 then redis.call('PEXPIRE', KEYS[2], ARGV[2]) end
for i = last + 1, #ARGV do redis.call('HDEL', KEYS[2], ARGV[i]) end
return 0)";

// A Redis script that adds the hash of a token to a session that contains the token as plain text. KEYS: as for kRead.
// ARGV: the token, its hash, 1 to delete the plain text.
constexpr const char* kHash = R"(#!lua flags=allow-oom
if redis.call('HGET', KEYS[1], 'token') == ARGV[1] then
  redis.call('HSET', KEYS[1], 'hash', ARGV[2])
  if ARGV[3] == '1' then redis.call('HDEL', KEYS[1], 'token') end
end)";

// A Redis script that removes a session, unless another server owns it. KEYS: as for kRead. ARGV: the name of this
// server.
constexpr const char* kRemove = R"(#!lua flags=allow-oom
local owner = redis.call('HGET', KEYS[1], 'owner')
if owner and owner ~= '' and owner ~= ARGV[1] then return end
redis.call('DEL', KEYS[1], KEYS[2]))";

// A Redis script that reads and empties the list of sessions that other servers have claimed from this server. KEYS:
// the key of the list. Returns {number of keys in Redis, id, fence, id, fence, …}. Each fence is the one in the record
// of the session before it, or 0 if there is no record.
constexpr const char* kPoll = R"(#!lua flags=allow-oom
local reply = {redis.call('DBSIZE')}
for _, id in ipairs(redis.call('LRANGE', KEYS[1], 0, -1)) do
  reply[#reply + 1] = id
  reply[#reply + 1] = redis.call('HGET', 'oval4d:{' .. id .. '}', 'fence') or '0'
end
redis.call('DEL', KEYS[1])
return reply)";

// Constants to find out whether servers of version 0.1.0 use this Redis. kOlderSave is the SHA-1 of the save script of
// version 0.1.0; if Redis knows this script, there are such servers. kHashedSince is a key in Redis. Its value is the
// time, in milliseconds of Redis's clock, at which a later version first noticed such servers. kNoteSince is a script
// that sets this value to ARGV[1] if it is not set, and returns it.
constexpr const char* kOlderSave = "3f542d461100cccfdf5dc6b4716be03d88d48eae";
constexpr const char* kHashedSince = "oval4d:tokens_hashed_since";
constexpr const char* kNoteSince = R"(#!lua flags=allow-oom
redis.call('SET', KEYS[1], ARGV[1], 'NX')
return redis.call('GET', KEYS[1]))";

constexpr auto kConnectTimeout = 1000ms;

// The part in braces, a hash tag of Redis, is the same in both keys of a session, so that a Redis cluster keeps them on
// one node.
std::string sessionKey(const std::string& id) { return "oval4d:{" + id + "}"; }
std::string objectsKey(const std::string& id) { return sessionKey(id) + ":polytopes"; }

timeval asTimeval(Milliseconds time) {
    return {static_cast<time_t>(time.count() / 1000), static_cast<suseconds_t>(time.count() % 1000 * 1000)};
}

std::string replyText(const redisReply& reply) {
    return reply.str == nullptr ? std::string() : std::string(reply.str, reply.len);
}

// Returns the session record in a reply to kRead or kClaim, or an empty optional if the reply says that there is no
// session.
std::optional<SessionRecord> sessionRecordFrom(const redisReply& reply) {
    if (reply.type != REDIS_REPLY_ARRAY || reply.elements != 4) return std::nullopt;
    SessionRecord record{replyText(*reply.element[1]),
                         replyText(*reply.element[2]),
                         {},
                         static_cast<FencingToken>(reply.element[0]->integer),
                         {}};
    const redisReply& objects = *reply.element[3];
    for (std::size_t i = 0; i + 1 < objects.elements; i += 2)
        record.objects.emplace_back(replyText(*objects.element[i]), replyText(*objects.element[i + 1]));
    return record;
}

// Returns whether an error means that Redis lacks memory for a write, or that a key has a value of the wrong type.
// After such an error, the connection can still be used.
bool isRefusedWrite(std::string_view error) { return error.starts_with("OOM ") || error.starts_with("WRONGTYPE "); }

template <typename Number>
Number parseNumberInRange(std::string_view text, const std::string& what, Number least, Number most) {
    Number value{};
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (fault != std::errc{} || end != text.data() + text.size() || value < least || value > most) {
        throw std::invalid_argument("the Redis " + what + " must be a number from " + std::to_string(least) + " to " +
                                    std::to_string(most) + ", not '" + std::string(text) + "'");
    }
    return value;
}

}  // namespace

void RedisStore::RedisDeleter::operator()(redisContext* context) const { redisFree(context); }
void RedisStore::RedisDeleter::operator()(redisReply* reply) const { freeReplyObject(reply); }

RedisStore::RedisStore(const StoreOptions& options, ClockFunction<Clock> now)
    : expiry_(options.expiry), timeout_(options.timeout), self_(randomName(10)), now_(std::move(now)) {
    std::string_view rest = options.url;
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
        if (!database_.empty()) parseNumberInRange(database_, "database", 0, 1'000'000);
        rest = rest.substr(0, slash);
    }
    if (const auto colon = rest.rfind(':'); colon != std::string_view::npos && rest.back() != ']') {
        port_ = parseNumberInRange(rest.substr(colon + 1), "port", 1, 65535);
        rest = rest.substr(0, colon);
    }
    // Remove the brackets of an IPv6 address.
    if (rest.size() > 2 && rest.front() == '[') rest = rest.substr(1, rest.size() - 2);
    host_ = rest;
    if (host_.empty()) throw std::invalid_argument("redis:// must be followed by a host");
}

RedisStore::~RedisStore() = default;

std::string RedisStore::name() const { return "redis://" + host_ + ":" + std::to_string(port_) + "/" + database_; }

void RedisStore::connect() {
    context_.reset(
        redisConnectWithTimeout(host_.c_str(), port_, asTimeval(std::min(timeout_, Milliseconds(kConnectTimeout)))));
    if (!context_) throw StoreError(name() + ": out of memory");
    if (context_->err != 0) disconnectAndThrow();
    redisSetTimeout(context_.get(), asTimeval(timeout_));
    redisEnableKeepAlive(context_.get());
    if (!password_.empty())
        sendAndReceive(user_.empty() ? CommandWords{"AUTH", password_} : CommandWords{"AUTH", user_, password_});
    if (!database_.empty()) sendAndReceive({"SELECT", database_});
    readScript_ = replyText(*sendAndReceive({"SCRIPT", "LOAD", kRead}));
    claimScript_ = replyText(*sendAndReceive({"SCRIPT", "LOAD", kClaim}));
    saveScript_ = replyText(*sendAndReceive({"SCRIPT", "LOAD", kSave}));
    hashScript_ = replyText(*sendAndReceive({"SCRIPT", "LOAD", kHash}));
    removeScript_ = replyText(*sendAndReceive({"SCRIPT", "LOAD", kRemove}));
    pollScript_ = replyText(*sendAndReceive({"SCRIPT", "LOAD", kPoll}));
    updatePlainTokenDeadline();
}

// Sets plainUntil_, the time until which tokens are also stored as plain text for servers of version 0.1.0: the time at
// which such servers were first noticed, plus the expiry period. If there are no such servers, sets plainUntil_ to a
// time in the past.
void RedisStore::updatePlainTokenDeadline() {
    plainUntil_ = {};
    const Reply known = sendAndReceive({"SCRIPT", "EXISTS", kOlderSave});
    if (known->elements != 1 || known->element[0]->integer == 0) return;
    const Reply time = sendAndReceive({"TIME"});
    const std::int64_t now = std::stoll(replyText(*time->element[0])) * 1000;
    const Reply noted = sendAndReceive({"EVAL", kNoteSince, "1", kHashedSince, std::to_string(now)});
    const std::int64_t since = std::stoll(replyText(*noted));
    plainUntil_ = now_() + Milliseconds(since - now) + expiry_;
}

bool RedisStore::alsoStoresPlainTokens() const { return now_() < plainUntil_; }

/// Closes the connection and throws StoreError. After a failure, replies on the connection can no longer be matched
/// with requests. The next operation opens a new connection.
void RedisStore::disconnectAndThrow() {
    const std::string why = context_->errstr[0] != '\0' ? context_->errstr : "no reply";
    context_.reset();
    throw StoreError(name() + ": " + why);
}

void RedisStore::send(const CommandWords& command) {
    if (!context_) connect();
    std::vector<const char*> starts;
    std::vector<std::size_t> sizes;
    for (const std::string& argument : command) {
        starts.push_back(argument.data());
        sizes.push_back(argument.size());
    }
    if (redisAppendCommandArgv(context_.get(), static_cast<int>(command.size()), starts.data(), sizes.data()) !=
        REDIS_OK) {
        disconnectAndThrow();
    }
}

/// Returns the next reply, which may be an error reply. Throws StoreError if none arrives.
RedisStore::Reply RedisStore::receiveReplyOrError() {
    void* reply = nullptr;
    if (redisGetReply(context_.get(), &reply) != REDIS_OK || reply == nullptr) disconnectAndThrow();
    return Reply(static_cast<redisReply*>(reply));
}

RedisStore::Reply RedisStore::receive() {
    Reply reply = receiveReplyOrError();
    if (reply->type == REDIS_REPLY_ERROR) {
        context_.reset();
        throw StoreError(name() + ": " + replyText(*reply));
    }
    return reply;
}

RedisStore::Reply RedisStore::sendAndReceive(const CommandWords& command) {
    send(command);
    return receive();
}

RedisStore::Reply RedisStore::sendAndReceive(const std::string& script, const std::string& id,
                                             const CommandWords& arguments) {
    CommandWords command{"EVALSHA", script, "2", sessionKey(id), objectsKey(id)};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return sendAndReceive(command);
}

std::optional<std::string> RedisStore::tokenHash(const std::string& id) {
    if (!context_) connect();
    const Reply reply = sendAndReceive({"HMGET", sessionKey(id), "hash", "token"});
    const redisReply& hash = *reply->element[0];
    const redisReply& token = *reply->element[1];
    const bool plain = token.type == REDIS_REPLY_STRING;
    if (hash.type == REDIS_REPLY_STRING && (!plain || alsoStoresPlainTokens())) return replyText(hash);
    if (!plain) return std::nullopt;
    std::string made = hashToken(replyText(token));
    sendAndReceive(hashScript_, id, {replyText(token), made, alsoStoresPlainTokens() ? "0" : "1"});
    return made;
}

std::optional<SessionRecord> RedisStore::read(const std::string& id) {
    if (!context_) connect();
    return sessionRecordFrom(*sendAndReceive(readScript_, id, {}));
}

std::optional<SessionRecord> RedisStore::claim(const std::string& id) {
    if (!context_) connect();
    return sessionRecordFrom(*sendAndReceive(claimScript_, id, {self_, std::to_string(expiry_.count()), id}));
}

/// Sends all updates before reading the replies (pipelining), so that the batch takes one round trip. Throws
/// StoreNotWritable if Redis refuses some of the updates (see isRefusedWrite()). All other updates have then been
/// executed.
std::vector<SaveResult> RedisStore::save(std::span<const RecordUpdate> updates) {
    if (!context_) connect();
    for (const RecordUpdate& update : updates) {
        const std::string& id = update.credentials.id;
        CommandWords command{"EVALSHA",
                             saveScript_,
                             "2",
                             sessionKey(id),
                             objectsKey(id),
                             self_,
                             std::to_string(expiry_.count()),
                             std::to_string(update.fence),
                             hashToken(update.credentials.token),
                             alsoStoresPlainTokens() ? update.credentials.token : "",
                             update.head,
                             update.whole,
                             update.closed ? "1" : "0",
                             std::to_string(update.objects.size())};
        for (const auto& [key, bytes] : update.objects) {
            command.push_back(key);
            command.push_back(bytes);
        }
        command.insert(command.end(), update.dropped.begin(), update.dropped.end());
        send(command);
    }
    std::vector<SaveResult> results;
    std::string refusal;
    for (std::size_t i = 0; i < updates.size(); ++i) {
        const Reply reply = receiveReplyOrError();
        if (reply->type != REDIS_REPLY_ERROR) {
            results.push_back(static_cast<SaveResult>(reply->integer));
        } else if (refusal = replyText(*reply); !isRefusedWrite(refusal)) {
            context_.reset();
            throw StoreError(name() + ": " + refusal);
        }
    }
    if (!refusal.empty()) throw StoreNotWritable(name() + ": " + refusal);
    return results;
}

void RedisStore::remove(std::span<const std::string> ids) {
    if (!context_) connect();
    for (const std::string& id : ids) send({"EVALSHA", removeScript_, "2", sessionKey(id), objectsKey(id), self_});
    for (std::size_t i = 0; i < ids.size(); ++i) receive();
}

void RedisStore::restartExpiry(std::span<const std::string> ids) {
    if (!context_) connect();
    const bool hashed = !alsoStoresPlainTokens();  // whether only hashes of tokens may be stored
    for (const std::string& id : ids) {
        send({"PEXPIRE", sessionKey(id), std::to_string(expiry_.count())});
        send({"PEXPIRE", objectsKey(id), std::to_string(expiry_.count())});
        if (hashed) send({"HDEL", sessionKey(id), "token"});
    }
    for (std::size_t i = 0; i < (hashed ? 3 : 2) * ids.size(); ++i) receive();
}

std::vector<TakenOverSession> RedisStore::pollTakenOverSessions() {
    if (!context_) connect();
    const Reply reply = sendAndReceive({"EVALSHA", pollScript_, "1", "oval4d:taken:" + self_});
    std::vector<TakenOverSession> lost;
    if (reply->type != REDIS_REPLY_ARRAY || reply->elements == 0) return lost;
    size_ = static_cast<std::size_t>(reply->element[0]->integer);
    for (std::size_t i = 1; i + 1 < reply->elements; i += 2)
        lost.push_back({replyText(*reply->element[i]), std::stoull(replyText(*reply->element[i + 1]))});
    return lost;
}

}  // namespace oval4d::store
