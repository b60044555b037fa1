// The tests that all stores must pass, and those of single stores.

#include <gtest/gtest.h>
#include <hiredis/hiredis.h>
#include <netinet/in.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <random>

#include "hang_limit.hpp"
#include "store/memory_store.hpp"
#include "store/open_store.hpp"
#include "store/redis_store.hpp"
#include "store/secret.hpp"
#include "store/sqlite_store.hpp"
#include "unit/parallel/virtual_clock.hpp"

namespace oval4d::store {
namespace {

using namespace std::chrono_literals;

/// A temporary folder.
class Folder {
  public:
    Folder() {
        std::string pattern = std::filesystem::temp_directory_path() / "oval4d-store-XXXXXX";
        path = mkdtemp(pattern.data());
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { std::filesystem::remove_all(path); }
    std::filesystem::path path;
};

/// A port on which only programs of this test listen. While a socket is bound to a port but does not listen, the system
/// gives the port to no program that asks for a free one, but programs that set SO_REUSEADDR, such as Redis, can listen
/// on it.
class Port {
  public:
    Port() : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        const int on = 1;
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        auto* const generic = reinterpret_cast<sockaddr*>(&address);
        if (setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 || bind(socket_, generic, size) != 0 ||
            getsockname(socket_, generic, &size) != 0)
            throw std::runtime_error("no port is free");
        number = ntohs(address.sin_port);
    }
    Port(const Port&) = delete;
    Port& operator=(const Port&) = delete;
    ~Port() { close(socket_); }
    int number = 0;

  private:
    int socket_;
};

/// A redis-server process for one test.
class Redis {
  public:
    Redis() { start(); }
    Redis(const Redis&) = delete;
    Redis& operator=(const Redis&) = delete;
    ~Redis() { stop(); }

    void start() {
        std::string text = std::to_string(port_.number), folder = folder_.path;
        std::vector<std::string> words{
            "redis-server", "--port", text,        "--bind",        "127.0.0.1",   "--save", "",
            "--dir",        folder,   "--logfile", folder + "/log", "--maxmemory", "100mb"};
        std::vector<char*> arguments;
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        if (posix_spawnp(&process_, "redis-server", nullptr, nullptr, arguments.data(), environ) != 0) process_ = 0;
    }
    void stop() {
        if (process_ == 0) return;
        kill(process_, SIGKILL);
        waitpid(std::exchange(process_, 0), nullptr, 0);
    }

    /// Returns a store that is connected to this Redis, or null if that is not possible.
    std::unique_ptr<Store> connect(Milliseconds expiry = 1h) const {
        StoreOptions options;
        options.url = "redis://127.0.0.1:" + std::to_string(port_.number);
        options.expiry = expiry;
        options.timeout = support::hangLimit();
        auto store = std::make_unique<RedisStore>(options);
        const auto answers = [&] {
            try {
                store->pollClaims();
                return true;
            } catch (const StoreError&) {
                return false;
            }
        };
        return process_ != 0 && support::eventually(answers) ? std::move(store) : nullptr;
    }

    /// Returns the time after which Redis deletes a key; a negative number if it never does or has no such key.
    Milliseconds expiryOf(const std::string& key) const {
        const std::unique_ptr<redisContext, decltype(&redisFree)> context(redisConnect("127.0.0.1", port_.number),
                                                                          redisFree);
        const std::unique_ptr<redisReply, decltype(&freeReplyObject)> reply(
            static_cast<redisReply*>(redisCommand(context.get(), "PTTL %s", key.c_str())), freeReplyObject);
        return Milliseconds(reply ? reply->integer : -1);
    }

  private:
    const Folder folder_;
    const Port port_;
    pid_t process_ = 0;
};

class AnyStore : public testing::TestWithParam<std::string> {
  protected:
    void SetUp() override {
        if (GetParam() == "memory")
            store = std::make_unique<MemoryStore>(kDefaultQuota, clock.now<MemoryStore::Clock>());
        if (GetParam() == "sqlite")
            store = std::make_unique<SqliteStore>(folder.path / "sessions.sqlite", kDefaultQuota,
                                                  clock.now<SqliteStore::Clock>());
        if (GetParam() == "redis") {
            redis = std::make_unique<Redis>();
            store = redis->connect();
        }
        ASSERT_TRUE(store) << "is redis-server installed?";
    }

    RecordUpdate whole(Fence fence, const std::string& bytes, const std::string& id = "one") const {
        return {{id, "secret of " + id}, fence, "", bytes, {}, {}, false};
    }
    RecordUpdate head(Fence fence, const std::string& bytes) const {
        return {{"one", "secret of one"}, fence, bytes, "", {}, {}, false};
    }
    SaveResult save(const RecordUpdate& update) { return store->save({&update, 1}).at(0); }

    support::VirtualClock clock;
    Folder folder;
    std::unique_ptr<Redis> redis;
    std::unique_ptr<Store> store;
};

INSTANTIATE_TEST_SUITE_P(Stores, AnyStore, testing::Values("memory", "sqlite", "redis"),
                         [](const auto& kind) { return kind.param; });

/// A store that must be asked to remove expired sessions.
class ExpiringStore : public AnyStore {};

INSTANTIATE_TEST_SUITE_P(Stores, ExpiringStore, testing::Values("memory", "sqlite"),
                         [](const auto& kind) { return kind.param; });

// Records may contain any bytes.
const std::string kBytes("a\0b\r\n\xff", 6);

TEST_P(AnyStore, ReturnsSavedRecords) {
    EXPECT_FALSE(store->tokenHash("one"));
    EXPECT_FALSE(store->claim("one"));
    EXPECT_EQ(save(whole(1, kBytes)), SaveResult::saved);
    EXPECT_EQ(store->tokenHash("one"), hashToken("secret of one"));
    auto record = store->claim("one");
    ASSERT_TRUE(record);
    EXPECT_EQ(record->whole, kBytes);
    EXPECT_EQ(record->head, "");
    EXPECT_EQ(record->fence, 2U);
    EXPECT_EQ(save(head(2, "newer")), SaveResult::saved);
    record = store->claim("one");
    EXPECT_EQ(record->whole + "|" + record->head, kBytes + "|newer");
    EXPECT_EQ(save(whole(3, "newest")), SaveResult::saved);
    record = store->claim("one");
    EXPECT_EQ(record->whole + "|" + record->head, "newest|") << "the head is replaced";
    store->pollClaims();
    EXPECT_EQ(store->size(), 1U);
}

TEST_P(AnyStore, RefusesUpdatesWithAnOldFence) {
    EXPECT_EQ(save(whole(1, "first")), SaveResult::saved);
    EXPECT_EQ(store->claim("one")->fence, 2U);
    EXPECT_EQ(save(whole(1, "late")), SaveResult::claimed);
    EXPECT_EQ(save(head(1, "late")), SaveResult::claimed);
    EXPECT_EQ(save(head(2, "in time")), SaveResult::saved);
    const auto record = store->claim("one");
    EXPECT_EQ(record->whole + record->head, "firstin time");
}

TEST_P(AnyStore, SaveReturnsAResultForEachUpdate) {
    EXPECT_EQ(save(whole(1, "a")), SaveResult::saved);
    store->claim("one");
    RecordUpdate headless = head(1, "x");
    headless.credentials.id = "three";
    const std::vector<RecordUpdate> updates{whole(1, "late"), whole(1, "b", "two"), headless};
    EXPECT_EQ(store->save(updates), (std::vector{SaveResult::claimed, SaveResult::saved, SaveResult::missing}));
    EXPECT_EQ(store->claim("two")->whole, "b");
    EXPECT_FALSE(store->claim("three"));
}

TEST_P(AnyStore, StoresThePolytopesOfASession) {
    RecordUpdate update = whole(1, "s");
    update.objects = {{"p", kBytes}, {"q", "bytes of q"}};
    EXPECT_EQ(save(update), SaveResult::saved);
    EXPECT_EQ(save(whole(1, "other", "two")), SaveResult::saved);
    auto polytopes = store->claim("one")->objects;
    std::ranges::sort(polytopes);
    EXPECT_EQ(polytopes, update.objects);
    EXPECT_TRUE(store->claim("two")->objects.empty());
    update = whole(2, "s");
    update.objects = {{"r", "bytes of r"}};
    update.dropped = {"p", "q"};
    EXPECT_EQ(save(update), SaveResult::saved);
    EXPECT_EQ(store->claim("one")->objects, update.objects);
}

TEST_P(ExpiringStore, ExpiresUntouchedSessions) {
    save(whole(1, "old"));
    save(whole(1, "open", "two"));
    save(whole(1, "claimed", "three"));
    clock.advance(1h - 1ms);
    const std::vector<std::string> open{"two"};
    store->touch(open);
    store->claim("three");
    EXPECT_EQ(store->expire(1h), 0U);
    clock.advance(2ms);
    EXPECT_EQ(store->expire(1h), 1U);
    EXPECT_FALSE(store->tokenHash("one"));
    EXPECT_TRUE(store->tokenHash("two"));
    EXPECT_TRUE(store->tokenHash("three"));
    store->pollClaims();
    EXPECT_EQ(store->size(), 2U);
    clock.advance(1h);
    EXPECT_EQ(store->expire(1h), 2U);
}

TEST_P(AnyStore, RemovesSessionsWithTheirPolytopes) {
    RecordUpdate update = whole(1, "s");
    update.objects = {{"p", "bytes of p"}};
    update.closed = true;
    save(update);
    save(whole(1, "other", "two"));
    const std::vector<std::string> ids{"one", "nobody"};
    store->remove(ids);
    EXPECT_FALSE(store->claim("one"));
    EXPECT_TRUE(store->claim("two"));
    EXPECT_EQ(save(whole(1, "again")), SaveResult::saved);
    EXPECT_TRUE(store->claim("one")->objects.empty());
}

/// Checks which sessions a store with a quota of 1 MiB evicts first.
void expectEvictionOrder(Store& store, support::VirtualClock& clock, std::size_t bytes) {
    const auto saved = [&](const std::string& id, bool changed, std::size_t size) {
        const RecordUpdate update{{id, "secret"}, 1, "", std::string(size, 'x'), {}, {}, true, changed};
        store.save({&update, 1});
        clock.advance(1ms);
    };
    saved("changed, old", true, 100'000);
    saved("held", false, 100'000);
    saved("as created", false, 100'000);
    saved("changed, new", true, 100'000);
    const RecordUpdate large{{"large", "secret"}, 1, "", std::string(bytes, 'x'), {}, {}, false, true};
    const RecordUpdate largest{{"largest", "secret"}, 1, "", std::string(2'000'000, 'x'), {}, {}, false, true};
    const auto isPinned = [](const std::string& id) { return id == "held" || id == "large"; };
    for (int i = 0; i < 10; ++i) saved("filler " + std::to_string(i), i > 0, 20'000);
    EXPECT_THROW(store.save({&large, 1}), NotWritable);
    EXPECT_FALSE(store.tokenHash("large"));
    EXPECT_GT(store.evict({&large, 1}, isPinned), 0U);
    EXPECT_TRUE(store.tokenHash("held"));
    EXPECT_FALSE(store.tokenHash("as created"));
    EXPECT_TRUE(store.tokenHash("changed, new"));
    EXPECT_TRUE(store.tokenHash("filler 9"));
    EXPECT_EQ(store.save({&large, 1}).at(0), SaveResult::saved);
    EXPECT_THROW(store.save({&largest, 1}), NotWritable);
    store.evict({&largest, 1}, isPinned);
    EXPECT_THROW(store.save({&largest, 1}), NotWritable);
    EXPECT_TRUE(store.tokenHash("held") && store.tokenHash("large")) << "pinned sessions stay, whatever does not fit";
    EXPECT_FALSE(store.tokenHash("changed, new"));
}

TEST(MemoryStore, EvictsInOrder) {
    support::VirtualClock clock;
    MemoryStore store(1U << 20U, clock.now<MemoryStore::Clock>());
    expectEvictionOrder(store, clock, 500'000);
}

TEST(SqliteStore, EvictsInOrder) {
    const Folder folder;
    support::VirtualClock clock;
    SqliteStore store(folder.path / "sessions", 1U << 20U, clock.now<SqliteStore::Clock>());
    expectEvictionOrder(store, clock, 250'000);
}

std::uintmax_t bytesIn(const std::filesystem::path& folder) {
    std::uintmax_t bytes = 0;
    for (const auto& file : std::filesystem::directory_iterator(folder)) bytes += file.file_size();
    return bytes;
}

TEST(SqliteStore, StaysWithinItsQuotaAndReleasesFreePages) {
    const Folder folder;
    constexpr std::size_t kQuota = 2U << 20U;
    {
        support::VirtualClock clock;
        SqliteStore store(folder.path / "sessions", kQuota, clock.now<SqliteStore::Clock>());
        std::mt19937 random(1);
        std::uintmax_t most = 0;
        for (int i = 0; i < 3000; ++i) {
            const RecordUpdate update{{"session " + std::to_string(random()), "secret"},
                                      1,
                                      "",
                                      std::string(random() % (i % 10 == 0 ? 60'000 : 3'000) + 1, 'x'),
                                      {},
                                      {},
                                      true,
                                      true};
            try {
                store.save({&update, 1});
            } catch (const NotWritable&) {
                EXPECT_GT(store.evict({&update, 1}, [](const std::string&) { return false; }), 0U);
                store.save({&update, 1});
            }
            most = std::max(most, bytesIn(folder.path));
        }
        EXPECT_LT(most, kQuota);
        EXPECT_GT(most, kQuota / 2);
        clock.advance(1ms);
        store.expire(0ms);
        for (int i = 0; i < 10; ++i) store.pollClaims();
        EXPECT_EQ(store.size(), 0U);
    }
    EXPECT_LT(bytesIn(folder.path), kQuota / 4);
}

unsigned modeOf(const std::filesystem::path& path) {
    return static_cast<unsigned>(std::filesystem::status(path).permissions()) & 07777U;
}

TEST(SqliteStore, FilesArePrivate) {
    const Folder folder;
    const std::filesystem::path path = folder.path / "a" / "b" / "sessions";
    for (const mode_t mask : {0U, 0022U, 0777U}) {
        const mode_t before = umask(mask);
        {
            const SqliteStore store(path);
            for (const char* beside : {"", "-wal"}) EXPECT_EQ(modeOf(path.string() + beside), 0600U) << beside << mask;
            EXPECT_EQ(modeOf(folder.path / "a"), 0700U);
            EXPECT_EQ(modeOf(folder.path / "a" / "b"), 0700U);
        }
        umask(before);
        std::filesystem::permissions(path, std::filesystem::perms(0644));
        {
            const SqliteStore store(path);
        }
        EXPECT_EQ(modeOf(path), 0600U);
        std::filesystem::remove_all(folder.path / "a");
    }
}

/// Claims a session, twice if the first attempt finds damage: the second one repairs it first.
std::optional<Record> claimed(SqliteStore& store, const std::string& id) {
    try {
        return store.claim(id);
    } catch (const CorruptDatabase&) {
        return store.claim(id);
    }
}

/// Flips bits of the file, or truncates it: every session that can be claimed is unchanged, and the damaged file is
/// kept under another name.
TEST(SqliteStore, SalvagesIntactSessionsOfADamagedFile) {
    std::mt19937 random(3);
    const auto bytesOfSession = [](int number) {
        return "session " + std::to_string(number) +
               std::string(static_cast<std::size_t>(100 + 37 * number % 9000), static_cast<char>('a' + number % 26));
    };
    constexpr int kSessions = 60;
    const Folder whole;
    {
        SqliteStore store(whole.path / "sessions");
        for (int i = 0; i < kSessions; ++i) {
            const RecordUpdate update{
                {"id" + std::to_string(i), "secret"}, 1, "", bytesOfSession(i), {}, {}, true, true};
            store.save({&update, 1});
        }
    }
    std::ifstream file(whole.path / "sessions", std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    int keptAll = 0, salvages = 0;
    for (int round = 0; round < 60; ++round) {
        const Folder folder;
        const std::string path = folder.path / "sessions";
        std::string damaged = bytes;
        for (unsigned i = 0; i < 1 + random() % 3; ++i)
            damaged[100 + random() % (damaged.size() - 100)] ^= static_cast<char>(1U << random() % 8);
        if (round % 5 == 0) damaged.resize(100 + random() % (damaged.size() - 100));
        std::ofstream(path, std::ios::binary) << damaged;
        SqliteStore store(path);
        int kept = 0;
        for (int i = 0; i < kSessions; ++i) {
            const auto record = claimed(store, "id" + std::to_string(i));
            if (!record || !record->damage.empty()) continue;
            EXPECT_EQ(record->whole, bytesOfSession(i)) << "round " << round;
            ++kept;
        }
        keptAll += kept == kSessions ? 1 : 0;
        std::filesystem::path aside;
        for (const auto& entry : std::filesystem::directory_iterator(folder.path)) {
            if (entry.path().string().find(".damaged-") != std::string::npos) aside = entry.path();
        }
        if (aside.empty()) {
            EXPECT_GE(kept, kSessions - 3) << "only records were damaged, round " << round;
        } else {
            ++salvages;
            std::ifstream set(aside, std::ios::binary);
            EXPECT_TRUE(std::string(std::istreambuf_iterator<char>(set), {}) == damaged)
                << "the damaged file is unchanged";
            EXPECT_EQ(modeOf(aside), 0600U);
        }
        const RecordUpdate update{{"new", "secret"}, 1, "", "new", {}, {}, true, true};
        EXPECT_EQ(store.save({&update, 1}).at(0), SaveResult::saved);
    }
    EXPECT_GT(salvages, 10);
    EXPECT_GT(keptAll, 0);
}

TEST(SqliteStore, SessionsSurviveARestart) {
    const Folder folder;
    const std::string path = folder.path / "new folder" / "sessions.sqlite";
    const RecordUpdate update{{"one", "secret"}, 1, "", "whole", {{"p", "bytes"}}, {}, true};
    SqliteStore(path).save({&update, 1});
    SqliteStore store(path);
    EXPECT_EQ(store.size(), 1U);
    EXPECT_EQ(store.tokenHash("one"), hashToken("secret"));
    const auto record = store.claim("one");
    EXPECT_EQ(record->whole, "whole");
    EXPECT_EQ(record->objects, update.objects);
}

TEST(SqliteStore, ErrorsTellWhyAFileCannotBeUsed) {
    const Folder folder;
    const auto errorOf = [](const std::string& path) -> std::string {
        try {
            const SqliteStore store(path);
            return "none";
        } catch (const StoreError& fault) {
            return fault.what();
        }
    };
    const std::string path = folder.path / "sessions.sqlite";
    const SqliteStore first(path);
    EXPECT_NE(errorOf(path).find("in use by another server"), std::string::npos) << errorOf(path);
    std::FILE* const file = std::fopen((folder.path / "text").c_str(), "w");
    std::fputs(std::string(5000, 'x').c_str(), file);
    std::fclose(file);
    EXPECT_NE(errorOf(folder.path / "text").find("not a database"), std::string::npos) << errorOf(folder.path / "text");
    std::filesystem::create_directory(folder.path / "folder");
    EXPECT_NE(errorOf(folder.path / "folder").find("is a folder"), std::string::npos)
        << errorOf(folder.path / "folder");
    std::filesystem::create_symlink(folder.path / "elsewhere", folder.path / "link");
    EXPECT_NE(errorOf(folder.path / "link").find("symbolic link"), std::string::npos) << errorOf(folder.path / "link");
    EXPECT_FALSE(std::filesystem::exists(folder.path / "elsewhere"));
    mkfifo((folder.path / "pipe").c_str(), 0600);
    EXPECT_NE(errorOf(folder.path / "pipe").find("is a pipe"), std::string::npos) << errorOf(folder.path / "pipe");
    const std::ofstream log(folder.path / "log");
    std::filesystem::create_symlink(folder.path / "elsewhere", folder.path / "log-wal");
    EXPECT_NE(errorOf(folder.path / "log").find("log-wal is a symbolic link"), std::string::npos);
    EXPECT_NE(errorOf("/proc/nowhere/x").find("unable to open"), std::string::npos) << errorOf("/proc/nowhere/x");
}

TEST(RedisStore, ExpiresUntouchedSessions) {
    const Redis redis;
    const auto brief = redis.connect(1h), lasting = redis.connect(3h);
    ASSERT_TRUE(brief && lasting);
    const auto expectExpiry = [&](Milliseconds longest) {
        for (const char* key : {"oval4d:{id}", "oval4d:{id}:polytopes"}) {
            EXPECT_GT(redis.expiryOf(key), longest - 1h) << key;
            EXPECT_LE(redis.expiryOf(key), longest) << key;
        }
    };
    const RecordUpdate update{{"id", "secret"}, 1, "", "whole", {{"p", "bytes"}}, {}, false};
    EXPECT_EQ(brief->save({&update, 1}).at(0), SaveResult::saved);
    expectExpiry(1h);
    const std::vector<std::string> ids{"id"};
    lasting->touch(ids);
    expectExpiry(3h);
    brief->claim("id");
    expectExpiry(1h);
    EXPECT_TRUE(lasting->claim("id"));
    expectExpiry(3h);
}

TEST(RedisStore, PollReturnsSessionsClaimedByOthers) {
    const Redis redis;
    const auto one = redis.connect(), two = redis.connect();
    ASSERT_TRUE(one && two);
    const RecordUpdate update{{"id", "secret"}, 1, "", "whole", {}, {}, false};
    EXPECT_EQ(one->save({&update, 1}).at(0), SaveResult::saved);
    EXPECT_TRUE(one->pollClaims().empty());
    EXPECT_EQ(two->claim("id")->fence, 2U);
    EXPECT_EQ(one->pollClaims(), std::vector<std::string>{"id"});
    EXPECT_TRUE(one->pollClaims().empty()) << "returned only once";
    EXPECT_EQ(one->save({&update, 1}).at(0), SaveResult::claimed);
    const RecordUpdate last{{"id", "secret"}, 2, "", "whole", {}, {}, true};
    EXPECT_EQ(two->save({&last, 1}).at(0), SaveResult::saved);
    EXPECT_EQ(one->claim("id")->fence, 3U);
    EXPECT_TRUE(two->pollClaims().empty()) << "the server had closed the session itself";
}

TEST(RedisStore, RemovesOnlyItsOwnSessions) {
    const Redis redis;
    const auto one = redis.connect(), two = redis.connect();
    ASSERT_TRUE(one && two);
    const RecordUpdate update{{"id", "secret"}, 1, "", "whole", {{"p", "q"}}, {}, false, true};
    one->save({&update, 1});
    const std::vector<std::string> ids{"id"};
    two->remove(ids);
    EXPECT_TRUE(one->tokenHash("id"));
    one->remove(ids);
    EXPECT_FALSE(one->tokenHash("id"));
}

TEST(RedisStore, RecoversWhenRedisHasLostAllData) {
    Redis redis;
    const auto one = redis.connect(), two = redis.connect();
    ASSERT_TRUE(one && two);
    const RecordUpdate first{{"id", "secret"}, 1, "", "whole", {}, {}, false};
    EXPECT_EQ(one->save({&first, 1}).at(0), SaveResult::saved);
    redis.stop();
    EXPECT_THROW(one->save({&first, 1}), StoreError);
    EXPECT_THROW(one->pollClaims(), StoreError);
    EXPECT_THROW(two->pollClaims(), StoreError);
    redis.start();
    ASSERT_TRUE(redis.connect());
    const RecordUpdate head{{"id", "secret"}, 1, "head", "", {}, {}, false};
    EXPECT_EQ(one->save({&head, 1}).at(0), SaveResult::missing);
    EXPECT_EQ(one->save({&first, 1}).at(0), SaveResult::saved);
    // Another server with the same fence, from before the loss.
    EXPECT_EQ(two->save({&first, 1}).at(0), SaveResult::claimed);
}

TEST(OpenStore, ParsesPlaces) {
    StoreOptions options;
    const auto named = [&](const std::string& url) {
        options.url = url;
        return openStore(options)->name();
    };
    EXPECT_EQ(named("memory"), "memory");
    EXPECT_EQ(named("redis://host"), "redis://host:6379/");
    EXPECT_EQ(named("redis://user:pass@word@host:7000/3"), "redis://host:7000/3") << "without the password";
    EXPECT_EQ(named("redis://[::1]:7000"), "redis://::1:7000/");
    for (const char* wrong :
         {"", "disk", "sqlite:", "redis://", "redis://host:x", "redis://host:0", "redis://host/x"}) {
        EXPECT_THROW(named(wrong), std::invalid_argument) << wrong;
    }
}

}  // namespace
}  // namespace oval4d::store
