#include "store/sqlite_schema.hpp"

#include <cstddef>
#include <fstream>
#include <ios>
#include <string_view>

#include "store/store.hpp"

namespace oval4d::store {

namespace {

constexpr std::size_t kFirstPageSize = 4096;  // the size of the first page of a store's file, in bytes

// The bytes of application_id in the header of an SQLite file, and their offset from the start of the file.
constexpr std::string_view kApplicationId = "ov4d";
constexpr std::size_t kApplicationIdAt = 68;

}  // namespace

void refuseForeignFile(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::string start(kFirstPageSize, '\0');
    file.read(start.data(), static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<std::size_t>(file.gcount()));
    constexpr std::string_view kMagic("SQLite format 3\0", 16);  // 16 bytes, with the terminating zero
    constexpr std::size_t kTableCount = 103;  // offset of two bytes on page 1: the number of rows of sqlite_schema
    const bool isDatabase = start.starts_with(kMagic);
    const bool hasNoTables =
        isDatabase && start.size() == kFirstPageSize && start.compare(kTableCount, 2, std::string_view("\0\0", 2)) == 0;
    const bool hasOurNumber =
        start.size() > kApplicationIdAt && std::string_view(start).substr(kApplicationIdAt).starts_with(kApplicationId);
    if (start.empty() || hasNoTables || hasOurNumber || start.find("CREATE TABLE session") != std::string::npos) return;
    throw StoreError(path +
                     (isDatabase ? " is the database of another program, or its first page is damaged"
                                 : " is not a database of SQLite") +
                     "; it was not changed: move it away, or give another path");
}

}  // namespace oval4d::store
