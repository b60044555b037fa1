#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <random>
#include <string>

#include "store/secret.hpp"
#include "store/sqlite_store.hpp"
#include "unit/parallel/virtual_clock.hpp"
#include "unit/store/temporary_folder.hpp"

namespace oval4d::store {
namespace {

using namespace std::chrono_literals;

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
            } catch (const StoreNotWritable&) {
                EXPECT_GT(store.evict({&update, 1}, [](const std::string&) { return false; }), 0U);
                store.save({&update, 1});
            }
            most = std::max(most, bytesIn(folder.path));
        }
        EXPECT_LT(most, kQuota);
        EXPECT_GT(most, kQuota / 2);
        clock.advance(1ms);
        store.expire(0ms);
        for (int i = 0; i < 10; ++i) store.pollTakenOverSessions();
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

/// Claims a session. If the first attempt finds damage, makes a second attempt, which repairs the file first.
std::optional<SessionRecord> claimed(SqliteStore& store, const std::string& id) {
    try {
        return store.claim(id);
    } catch (const CorruptDatabase&) {
        return store.claim(id);
    }
}

/// Intact sessions of a damaged file survive. After bits were flipped or the file was truncated, every session that can
/// be claimed is unchanged, and the damaged file has another name.
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

}  // namespace
}  // namespace oval4d::store
