// What all stores have in common, on each of them.

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <functional>
#include <memory>
#include <thread>

#include "store/memory_store.hpp"
#include "store/redis_store.hpp"
#include "store/sqlite_store.hpp"

namespace oval4d::store {
namespace {

using namespace std::chrono_literals;

/// A folder for one test.
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

/// A port that was free a moment ago.
int freePort() {
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    (void)bind(socket, generic, size);
    (void)getsockname(socket, generic, &size);
    (void)close(socket);
    return ntohs(address.sin_port);
}

/// A redis-server of the test's own.
class Redis {
  public:
    explicit Redis(int port) : port_(port) {
        std::string text = std::to_string(port_), folder = folder_.path;
        std::vector<std::string> words{
            "redis-server", "--port", text,        "--bind",        "127.0.0.1",   "--save", "",
            "--dir",        folder,   "--logfile", folder + "/log", "--maxmemory", "100mb"};
        std::vector<char*> arguments;
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        if (posix_spawnp(&process_, "redis-server", nullptr, nullptr, arguments.data(), environ) != 0) process_ = 0;
    }
    Redis(const Redis&) = delete;
    Redis& operator=(const Redis&) = delete;
    ~Redis() {
        if (process_ == 0) return;
        kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
    }
    StoreOptions options() const {
        StoreOptions options;
        options.place = "redis://127.0.0.1:" + std::to_string(port_);
        options.expiry = 300ms;
        return options;
    }

  private:
    Folder folder_;
    int port_;
    pid_t process_ = 0;
};

std::unique_ptr<Store> answering(const StoreOptions& options) {
    for (int i = 0; i < 500; ++i) {
        auto store = std::make_unique<RedisStore>(options);
        try {
            store->pulse();
            return store;
        } catch (const Outage&) {
            std::this_thread::sleep_for(20ms);
        }
    }
    return nullptr;
}

class AnyStore : public testing::TestWithParam<std::string> {
  protected:
    void SetUp() override {
        if (GetParam() == "memory") store = std::make_unique<MemoryStore>();
        if (GetParam() == "sqlite") store = std::make_unique<SqliteStore>(folder.path / "sessions.sqlite");
        if (GetParam() == "redis") {
            redis = std::make_unique<Redis>(freePort());
            store = answering(redis->options());
        }
        ASSERT_TRUE(store) << "is redis-server installed?";
    }

    Saving whole(Fence fence, const std::string& bytes, const std::string& id = "one") const {
        return {{id, "secret of " + id}, fence, "", bytes, {}, {}, false};
    }
    Saving head(Fence fence, const std::string& bytes) const {
        return {{"one", "secret of one"}, fence, bytes, "", {}, {}, false};
    }
    Saved save(const Saving& saving) { return store->save({&saving, 1}).at(0); }

    Folder folder;
    std::unique_ptr<Redis> redis;
    std::unique_ptr<Store> store;
};

INSTANTIATE_TEST_SUITE_P(Stores, AnyStore, testing::Values("memory", "sqlite", "redis"),
                         [](const auto& kind) { return kind.param; });

// All bytes occur in records.
const std::string kBytes("a\0b\r\n\xff", 6);

TEST_P(AnyStore, GivesBackWhatItKept) {
    EXPECT_FALSE(store->token("one"));
    EXPECT_FALSE(store->claim("one"));
    EXPECT_EQ(save(whole(1, kBytes)), Saved::yes);
    EXPECT_EQ(store->token("one"), "secret of one");
    auto record = store->claim("one");
    ASSERT_TRUE(record);
    EXPECT_EQ(record->whole, kBytes);
    EXPECT_EQ(record->head, "");
    EXPECT_EQ(record->fence, 2U);
    EXPECT_EQ(save(head(2, "newer")), Saved::yes);
    record = store->claim("one");
    EXPECT_EQ(record->whole + "|" + record->head, kBytes + "|newer");
    EXPECT_EQ(save(whole(3, "newest")), Saved::yes);
    record = store->claim("one");
    EXPECT_EQ(record->whole + "|" + record->head, "newest|") << "the head is forgotten";
    store->pulse();
    EXPECT_EQ(store->size(), 1U);
}

TEST_P(AnyStore, RefusesWhoWasOvertaken) {
    EXPECT_EQ(save(whole(1, "first")), Saved::yes);
    EXPECT_EQ(store->claim("one")->fence, 2U);
    EXPECT_EQ(save(whole(1, "late")), Saved::taken);
    EXPECT_EQ(save(head(1, "late")), Saved::taken);
    EXPECT_EQ(save(head(2, "in time")), Saved::yes);
    const auto record = store->claim("one");
    EXPECT_EQ(record->whole + record->head, "firstin time");
}

TEST_P(AnyStore, ASavingOfManyAnswersForEach) {
    EXPECT_EQ(save(whole(1, "a")), Saved::yes);
    store->claim("one");
    Saving headless = head(1, "x");
    headless.ticket.id = "three";
    const std::vector<Saving> savings{whole(1, "late"), whole(1, "b", "two"), headless};
    EXPECT_EQ(store->save(savings), (std::vector{Saved::taken, Saved::yes, Saved::missing}));
    EXPECT_EQ(store->claim("two")->whole, "b");
    EXPECT_FALSE(store->claim("three"));
}

TEST_P(AnyStore, KeepsPolytopesBesideTheirSession) {
    Saving saving = whole(1, "s");
    saving.polytopes = {{"p", kBytes}, {"q", "bytes of q"}};
    EXPECT_EQ(save(saving), Saved::yes);
    EXPECT_EQ(save(whole(1, "other", "two")), Saved::yes);
    auto polytopes = store->claim("one")->polytopes;
    std::ranges::sort(polytopes);
    EXPECT_EQ(polytopes, saving.polytopes);
    EXPECT_TRUE(store->claim("two")->polytopes.empty());
    saving = whole(2, "s");
    saving.polytopes = {{"r", "bytes of r"}};
    saving.dropped = {"p", "q"};
    EXPECT_EQ(save(saving), Saved::yes);
    EXPECT_EQ(store->claim("one")->polytopes, saving.polytopes);
}

TEST_P(AnyStore, ForgetsWhatNobodyTouched) {
    save(whole(1, "old"));
    save(whole(1, "open", "two"));
    for (int i = 0; i < 6; ++i) {
        std::this_thread::sleep_for(100ms);
        const std::vector<std::string> open{"two"};
        store->touch(open);
        store->expire(300ms);
    }
    EXPECT_FALSE(store->token("one"));
    EXPECT_TRUE(store->token("two"));
    store->pulse();
    EXPECT_EQ(store->size(), 1U);
}

TEST(SqliteStore, OutlivesItsServer) {
    const Folder folder;
    const std::string path = folder.path / "new folder" / "sessions.sqlite";
    const Saving saving{{"one", "secret"}, 1, "", "whole", {{"p", "bytes"}}, {}, true};
    SqliteStore(path).save({&saving, 1});
    SqliteStore store(path);
    EXPECT_EQ(store.size(), 1U);
    EXPECT_EQ(store.token("one"), "secret");
    const auto record = store.claim("one");
    EXPECT_EQ(record->whole, "whole");
    EXPECT_EQ(record->polytopes, saving.polytopes);
}

TEST(SqliteStore, SaysWhyAFileCannotBeUsed) {
    const Folder folder;
    const auto complaint = [](const std::string& path) -> std::string {
        try {
            const SqliteStore store(path);
            return "none";
        } catch (const Outage& fault) {
            return fault.what();
        }
    };
    const std::string path = folder.path / "sessions.sqlite";
    const SqliteStore first(path);
    EXPECT_NE(complaint(path).find("in use by another server"), std::string::npos) << complaint(path);
    std::FILE* const file = std::fopen((folder.path / "text").c_str(), "w");
    std::fputs(std::string(5000, 'x').c_str(), file);
    std::fclose(file);
    EXPECT_NE(complaint(folder.path / "text").find("not a database"), std::string::npos)
        << complaint(folder.path / "text");
    EXPECT_NE(complaint("/proc/nowhere/x").find("unable to open"), std::string::npos) << complaint("/proc/nowhere/x");
}

TEST(RedisStore, TellsWhoseSessionWasTaken) {
    const Redis redis(freePort());
    const auto one = answering(redis.options()), two = answering(redis.options());
    ASSERT_TRUE(one && two);
    const Saving saving{{"id", "secret"}, 1, "", "whole", {}, {}, false};
    EXPECT_EQ(one->save({&saving, 1}).at(0), Saved::yes);
    EXPECT_TRUE(one->pulse().empty());
    EXPECT_EQ(two->claim("id")->fence, 2U);
    EXPECT_EQ(one->pulse(), std::vector<std::string>{"id"});
    EXPECT_TRUE(one->pulse().empty()) << "told once";
    EXPECT_EQ(one->save({&saving, 1}).at(0), Saved::taken);
    const Saving last{{"id", "secret"}, 2, "", "whole", {}, {}, true};
    EXPECT_EQ(two->save({&last, 1}).at(0), Saved::yes);
    EXPECT_EQ(one->claim("id")->fence, 3U);
    EXPECT_TRUE(two->pulse().empty()) << "it had closed the session itself";
}

TEST(RedisStore, GoesOnWhereARedisHasLostEverything) {
    const int port = freePort();
    auto redis = std::make_unique<Redis>(port);
    const auto one = answering(redis->options()), two = answering(redis->options());
    ASSERT_TRUE(one && two);
    const Saving first{{"id", "secret"}, 1, "", "whole", {}, {}, false};
    EXPECT_EQ(one->save({&first, 1}).at(0), Saved::yes);
    redis.reset();
    EXPECT_THROW(one->save({&first, 1}), Outage);
    EXPECT_THROW(one->pulse(), Outage);
    EXPECT_THROW(two->pulse(), Outage);
    redis = std::make_unique<Redis>(port);
    ASSERT_TRUE(answering(redis->options()));
    const Saving head{{"id", "secret"}, 1, "head", "", {}, {}, false};
    EXPECT_EQ(one->save({&head, 1}).at(0), Saved::missing);
    EXPECT_EQ(one->save({&first, 1}).at(0), Saved::yes);
    // Another with the same number, given out by what was lost.
    EXPECT_EQ(two->save({&first, 1}).at(0), Saved::taken);
}

TEST(Places, AreToldApart) {
    StoreOptions options;
    const auto named = [&](const std::string& place) {
        options.place = place;
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
