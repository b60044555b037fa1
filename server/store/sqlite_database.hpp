#pragma once
// RAII wrappers of SQLite connections, statements and transactions. They report errors as StoreError.
//
// Why not the library SQLiteCpp? It would replace only Statement and Transaction, about sixty lines. The rest would
// still call SQLite directly: to set options of the connection (sqlite3_db_config), to define functions that a forged
// schema cannot call (SQLITE_DIRECTONLY), and to learn whether the disk is full or read-only (sqlite3_system_errno).
// SQLiteCpp loses this last information if it cannot open a file. Its exceptions would also have to be converted to
// StoreError wherever a statement is executed.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "store/store.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace oval4d::store {

/// An error: a file is damaged, or is not an SQLite database.
class CorruptDatabase : public StoreError {
  public:
    using StoreError::StoreError;
};

/// A connection to a database file. Holds an exclusive lock on the file from the first read on. Defines two SQL
/// functions, hash_of(token) and digest_of(part, …), which call hashToken() and recordDigest() of secret.hpp.
class Database {
  public:
    /// Opens an existing file. Throws StoreError if there is none. Does not read the file, so damage is noticed only by
    /// the first statement that does.
    explicit Database(std::string path);
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;
    ~Database();

    const std::string& path() const { return path_; }
    /// Executes one or more SQL statements and ignores their results. Throws StoreNotWritable if the file cannot be
    /// written, CorruptDatabase if the file is damaged, and StoreError for any other error. All other functions in this
    /// file that prepare or execute statements throw the same errors.
    void execute(const char* sql);
    /// Executes a query and returns the first value of its first row, or 0 if the query returns no rows.
    std::int64_t queryNumber(const char* sql);
    /// Makes the destructor keep the write-ahead log. Without this call, the destructor writes the log to the database
    /// file and deletes the log. Must be called before a damaged file and its log are renamed.
    void keepWriteAheadLogOnClose();

  private:
    friend class Statement;
    friend class Transaction;
    [[noreturn]] void throwDatabaseError(const char* what) const;

    const std::string path_;
    sqlite3* handle_ = nullptr;
};

/// A prepared statement that is executed once. Bound values are not copied; they must outlive the statement.
class Statement {
  public:
    Statement(Database& database, const char* sql);
    Statement(const Statement&) = delete;
    Statement& operator=(const Statement&) = delete;
    ~Statement();

    /// bindText(), blob() and bindNumber() bind a value to the next parameter of the statement.
    Statement& bindText(std::string_view value);
    Statement& blob(std::string_view value);
    Statement& bindNumber(std::int64_t value);

    /// Executes the statement up to its next row. Returns whether there is such a row.
    bool step();
    /// bytesAt() and numberAt() return a value of the current row. Columns count from 0.
    std::string bytesAt(int column) const;
    std::int64_t numberAt(int column) const;
    /// Returns the number of rows that the statement has inserted, changed or deleted.
    std::size_t changedRowCount() const;

  private:
    Statement& checkBinding(int status);

    Database& database_;
    sqlite3_stmt* statement_ = nullptr;
    int bound_ = 0;
};

/// A transaction. The destructor rolls it back, unless commit() was called.
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
