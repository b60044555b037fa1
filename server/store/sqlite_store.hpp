#pragma once
// Sessions kept in a file of SQLite: they outlive the server.

#include <string_view>

#include "store/store.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace oval4d::store {

/// One server's file. What is saved is safe from the process being killed at any moment: a commit is in the
/// write-ahead log, which the system keeps. It is not flushed to the disk each time (synchronous = NORMAL), so that a
/// power failure may lose the last moments; it does not damage the file.
class SqliteStore final : public Store {
  public:
    /// Opens or makes the file. Throws Outage where that cannot be, or where another server uses it.
    explicit SqliteStore(std::string path);
    ~SqliteStore() override;

    Pace pace() const override { return Pace::soon; }
    std::string name() const override { return "sqlite:" + path_; }
    std::optional<std::string> token(const std::string& id) override;
    std::optional<Record> claim(const std::string& id) override;
    std::vector<Saved> save(std::span<const Saving> savings) override;
    void touch(std::span<const std::string> ids) override;
    std::size_t expire(Milliseconds age) override;
    std::vector<std::string> pulse() override;
    std::size_t size() const override { return size_; }

  private:
    class Query;
    class Transaction;
    [[noreturn]] void fail(const std::string& what) const;
    void run(const char* sql);
    Saved saveOne(const Saving& saving);
    std::int64_t now() const;

    const std::string path_;
    sqlite3* database_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace oval4d::store
