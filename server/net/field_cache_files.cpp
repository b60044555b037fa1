#include "net/field_cache_files.hpp"

#include <fcntl.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "net/unnamed_file.hpp"

namespace oval4d::net {

namespace {

/// Sets the size of an open file, and reserves its blocks on the disk if the file system can do so. Returns 0 on
/// success, else an error number (errno).
int allocateFileSpace(int file, std::size_t bytes) {
    const auto size = static_cast<off_t>(bytes);
    if (fallocate(file, 0, 0, size) == 0) return 0;
    if (errno != EOPNOTSUPP && errno != ENOSYS) return errno;
    // This file system cannot reserve blocks, so only the present free space is checked. If the disk becomes full
    // later, the process that writes the file reports an error.
    struct statvfs status{};
    if (fstatvfs(file, &status) != 0) return errno;
    if (status.f_bavail * status.f_frsize < bytes) return ENOSPC;
    return ftruncate(file, size) == 0 ? 0 : errno;
}

}  // namespace

FieldCacheFiles::FieldCacheFiles(const std::string& folder, std::size_t bytes)
    : folder_(folder.empty() ? "/var/tmp" : folder), maxBytes_(bytes) {}

Result<FieldCacheFiles::FilePtr> FieldCacheFiles::allocateFile(std::size_t bytes) {
    if (bytes > maxBytes_) {
        return Error{ErrorCode::too_large, "the samples of this field take " + std::to_string(bytes) +
                                               " bytes on the disk, but the server has " + std::to_string(maxBytes_) +
                                               " for such fields (--field-cache)"};
    }
    std::size_t before = bytes_;
    do {
        if (before > maxBytes_ - bytes) return FilePtr();
    } while (!bytes_.compare_exchange_weak(before, before + bytes));
    const auto close = [this, bytes](const fields::FileHandle* file) {
        delete file;
        bytes_ -= bytes;
    };
    const FilePtr file(new fields::FileHandle(openUnnamedFile(folder_)), close);
    const int fault = file->descriptor() < 0 ? errno : allocateFileSpace(file->descriptor(), bytes);
    if (fault == 0) return file;
    const std::string why = std::generic_category().message(fault);
    if (fault == ENOSPC || fault == EDQUOT)
        return Error{ErrorCode::too_many, "the disk of the server's field cache has no room for this field: " + why};
    return Error{ErrorCode::internal, "the server cannot write to its field cache (--field-cache-folder): " + why};
}

}  // namespace oval4d::net
