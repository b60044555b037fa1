#include "store/sqlite_database.hpp"

#include <sqlite3.h>

#include <cerrno>
#include <system_error>
#include <vector>

#include "store/secret.hpp"

namespace oval4d::store {

namespace {

std::string_view bytesOf(sqlite3_value* value) {
    const void* bytes = sqlite3_value_blob(value);
    const auto size = static_cast<std::size_t>(sqlite3_value_bytes(value));
    return bytes == nullptr ? std::string_view() : std::string_view(static_cast<const char*>(bytes), size);
}

/// Calls `make`, and reports its exceptions to SQLite, because exceptions must not pass through SQLite's C code.
template <typename Make>
void callReportingErrors(sqlite3_context* context, Make make) {
    try {
        make();
    } catch (const std::exception& fault) {
        sqlite3_result_error(context, fault.what(), -1);
    }
}

void hashFunction(sqlite3_context* context, int /*count*/, sqlite3_value** values) {
    callReportingErrors(context, [&] {
        const std::string hash = hashToken(bytesOf(values[0]));
        sqlite3_result_text64(context, hash.data(), hash.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
    });
}

void digestFunction(sqlite3_context* context, int count, sqlite3_value** values) {
    callReportingErrors(context, [&] {
        std::vector<std::string_view> parts;
        for (int i = 0; i < count; ++i) parts.push_back(bytesOf(values[i]));
        const std::string digest = recordDigest(parts);
        sqlite3_result_blob64(context, digest.data(), digest.size(), SQLITE_TRANSIENT);
    });
}

}  // namespace

Database::Database(std::string path) : path_(std::move(path)) {
    try {
        if (sqlite3_open_v2(path_.c_str(), &handle_, SQLITE_OPEN_READWRITE, nullptr) != SQLITE_OK)
            throwDatabaseError("opening it");
        sqlite3_extended_result_codes(handle_, 1);
        sqlite3_busy_timeout(handle_, 2000);  // maximum wait for a lock, in ms, because a killed server may still be
                                              // exiting
        constexpr int kFlags = SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_DIRECTONLY;
        sqlite3_create_function(handle_, "hash_of", 1, kFlags, nullptr, hashFunction, nullptr, nullptr);
        sqlite3_create_function(handle_, "digest_of", -1, kFlags, nullptr, digestFunction, nullptr, nullptr);
        // The file may be damaged or forged: do not trust its schema.
        sqlite3_db_config(handle_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
        sqlite3_db_config(handle_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
        // These statements do not read the file, so they succeed even if the file is damaged. The caller needs the open
        // database to copy the intact sessions.
        execute(
            "PRAGMA locking_mode = EXCLUSIVE; PRAGMA cell_size_check = ON;"
            "PRAGMA secure_delete = ON; PRAGMA foreign_keys = ON");
    } catch (...) {
        sqlite3_close(handle_);
        throw;
    }
}

Database::~Database() { sqlite3_close(handle_); }

void Database::throwDatabaseError(const char* what) const {
    const int code = sqlite3_errcode(handle_) & 0xFF;
    const std::string message = sqlite3_errmsg(handle_);
    const int cause = sqlite3_system_errno(handle_);
    switch (code) {
        case SQLITE_BUSY:
        case SQLITE_LOCKED:
            throw StoreError(path_ + " is in use by another server; each server needs its own file");
        case SQLITE_CORRUPT:
        case SQLITE_NOTADB:
            throw CorruptDatabase(path_ + ": " + message);
        case SQLITE_FULL:
            throw StoreNotWritable(path_ + ": no space is left on the disk or within the quota");
        case SQLITE_READONLY:
            throw StoreNotWritable(path_ + " cannot be written: " + message);
        case SQLITE_IOERR:
        case SQLITE_CANTOPEN: {
            const std::string why = message + (cause == 0 ? "" : ": " + std::generic_category().message(cause));
            const int extended = sqlite3_extended_errcode(handle_);
            const bool isWriting = extended == SQLITE_IOERR_WRITE || extended == SQLITE_IOERR_FSYNC ||
                                   extended == SQLITE_IOERR_TRUNCATE || cause == ENOSPC || cause == EDQUOT ||
                                   cause == EROFS;
            if (isWriting) throw StoreNotWritable(path_ + " cannot be written: " + why);
            throw StoreError(path_ + ": " + why);
        }
        default:
            throw StoreError(path_ + ": " + message + " (" + what + ")");
    }
}

void Database::execute(const char* sql) {
    if (sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr) != SQLITE_OK) throwDatabaseError(sql);
}

std::int64_t Database::queryNumber(const char* sql) {
    Statement statement(*this, sql);
    return statement.step() ? statement.numberAt(0) : 0;
}

void Database::keepWriteAheadLogOnClose() { sqlite3_db_config(handle_, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr); }

Statement::Statement(Database& database, const char* sql) : database_(database) {
    if (sqlite3_prepare_v2(database.handle_, sql, -1, &statement_, nullptr) != SQLITE_OK)
        database.throwDatabaseError(sql);
}

Statement::~Statement() { sqlite3_finalize(statement_); }

Statement& Statement::bindText(std::string_view value) {
    return checkBinding(
        sqlite3_bind_text64(statement_, ++bound_, value.data(), value.size(), SQLITE_STATIC, SQLITE_UTF8));
}

Statement& Statement::blob(std::string_view value) {
    // data() of an empty view may be null. SQLite would bind null as NULL, not as an empty blob.
    return checkBinding(
        sqlite3_bind_blob64(statement_, ++bound_, value.empty() ? "" : value.data(), value.size(), SQLITE_STATIC));
}

Statement& Statement::bindNumber(std::int64_t value) {
    return checkBinding(sqlite3_bind_int64(statement_, ++bound_, value));
}

bool Statement::step() {
    const int status = sqlite3_step(statement_);
    if (status != SQLITE_ROW && status != SQLITE_DONE) database_.throwDatabaseError(sqlite3_sql(statement_));
    return status == SQLITE_ROW;
}

std::string Statement::bytesAt(int column) const {
    const void* bytes = sqlite3_column_blob(statement_, column);
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, column));
    return bytes == nullptr ? std::string() : std::string(static_cast<const char*>(bytes), size);
}

std::int64_t Statement::numberAt(int column) const { return sqlite3_column_int64(statement_, column); }

std::size_t Statement::changedRowCount() const { return static_cast<std::size_t>(sqlite3_changes(database_.handle_)); }

Statement& Statement::checkBinding(int status) {
    if (status != SQLITE_OK) database_.throwDatabaseError("binding a value");
    return *this;
}

Transaction::Transaction(Database& database) : database_(database) { database_.execute("BEGIN IMMEDIATE"); }

Transaction::~Transaction() {
    if (!committed_) sqlite3_exec(database_.handle_, "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() {
    database_.execute("COMMIT");
    committed_ = true;
}

}  // namespace oval4d::store
