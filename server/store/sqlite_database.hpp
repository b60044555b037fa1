#pragma once
// RAII wrappers of SQLite's connection, statements and transactions, which throw StoreError.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "store/store.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace oval4d::store {

/// The file is corrupt, or is not an SQLite database.
class CorruptDatabase : public StoreError {
  public:
    using StoreError::StoreError;
};

/// A connection to a database file, with an exclusive lock from the first read on. Its SQL has two additional
/// functions, hash_of(token) and digest_of(part, …), which are hashOf and digestOf of secret.hpp.
class Database {
  public:
    /// Throws StoreError if there is no such file. Does not read the file: the first statement does.
    explicit Database(std::string path);
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;
    ~Database();

    const std::string& path() const { return path_; }
    /// Executes statements without results. Like every function of a query, throws NotWritable if the disk is full,
    /// CorruptDatabase, or else StoreError.
    void run(const char* sql);
    /// Returns the first value of the first row, or 0 if there are no rows.
    std::int64_t number(const char* sql);
    /// Keeps the write-ahead log when the connection closes, because it belongs to a file that is to be set aside.
    void keepWriteAheadLog();

  private:
    friend class Query;
    friend class Transaction;
    [[noreturn]] void fail(const char* what) const;

    const std::string path_;
    sqlite3* handle_ = nullptr;
};

/// A prepared statement, executed once. Bound values must outlive it.
class Query {
  public:
    Query(Database& database, const char* sql);
    Query(const Query&) = delete;
    Query& operator=(const Query&) = delete;
    ~Query();

    Query& text(std::string_view value);
    Query& blob(std::string_view value);
    Query& number(std::int64_t value);

    /// Advances to the next row; returns false if there is none.
    bool row();
    std::string bytesAt(int column) const;
    std::int64_t numberAt(int column) const;
    /// The number of rows that the statement changed.
    std::size_t changes() const;

  private:
    Query& bound(int status);

    Database& database_;
    sqlite3_stmt* statement_ = nullptr;
    int bound_ = 0;
};

/// A transaction, rolled back unless committed.
class Transaction {
  public:
    explicit Transaction(Database& database);
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    ~Transaction();
    void commit();

  private:
    Database& database_;
    bool committed_ = false;
};

}  // namespace oval4d::store
