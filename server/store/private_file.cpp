#include "store/private_file.hpp"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <system_error>

#include "store/store.hpp"

namespace oval4d::store {

namespace {

constexpr mode_t kFileMode = S_IRUSR | S_IWUSR;
constexpr mode_t kFolderMode = S_IRWXU;
constexpr mode_t kPermissions = 07777;

[[noreturn]] void throwStoreError(const std::string& path, const std::string& what) {
    throw StoreError(path + ": " + what + ": " + std::generic_category().message(errno));
}

/// An owner of a file descriptor, which the destructor closes.
class FileDescriptor {
  public:
    explicit FileDescriptor(int number) : number_(number) {}
    FileDescriptor(const FileDescriptor&) = delete;
    FileDescriptor& operator=(const FileDescriptor&) = delete;
    ~FileDescriptor() {
        if (number_ >= 0) ::close(number_);
    }
    int descriptor() const { return number_; }
    bool isValid() const { return number_ >= 0; }
    /// Returns a path to the open file. The path stays valid if the file is renamed.
    std::string name() const { return "/proc/self/fd/" + std::to_string(number_); }

  private:
    int number_;
};

const char* describeFileType(mode_t mode) {
    if (S_ISLNK(mode)) return "a symbolic link; give the path that it points to";
    if (S_ISDIR(mode)) return "a folder, not a regular file";
    if (S_ISFIFO(mode)) return "a pipe, not a regular file";
    if (S_ISSOCK(mode)) return "a socket, not a regular file";
    return "a device, not a regular file";
}

void createFolders(const std::filesystem::path& folder) {
    std::filesystem::path made;
    for (const auto& part : folder) {
        made /= part;
        // Ignore errors here: opening the file then fails and reports them. chmod() is needed because mkdir() applies
        // the umask to the mode.
        if (mkdir(made.c_str(), kFolderMode) == 0) chmod(made.c_str(), kFolderMode);
    }
}

enum class PermissionHandling : std::uint8_t { leave, tighten };

/// Checks a file as requireOwnRegularFileIfExists() does. If `permissions` is `tighten`, also sets the mode of the file
/// to 0600. Returns whether the file exists.
bool checkFile(const std::string& path, PermissionHandling permissions) {
    // Open the file with O_PATH: closing such a descriptor keeps the locks of this process on the file, whereas closing
    // an ordinary descriptor releases them all.
    const FileDescriptor file(open(path.c_str(), O_PATH | O_NOFOLLOW | O_CLOEXEC));
    if (!file.isValid()) {
        if (errno == ENOENT) return false;
        throwStoreError(path, "unable to open it");
    }
    struct stat status{};
    if (fstat(file.descriptor(), &status) != 0) throwStoreError(path, "unable to read its status");
    if (!S_ISREG(status.st_mode)) throw StoreError(path + " is " + describeFileType(status.st_mode));
    if (status.st_uid != geteuid()) {
        throw StoreError(path + " belongs to user " + std::to_string(status.st_uid) + ", and the server runs as user " +
                         std::to_string(geteuid()) + ": change its owner, or give another path");
    }
    const mode_t mode = status.st_mode & kPermissions;
    if (permissions == PermissionHandling::leave || mode == kFileMode) return true;
    if (chmod(file.name().c_str(), kFileMode) != 0) throwStoreError(path, "unable to set its mode to 0600");
    spdlog::warn("store file mode changed, so that only the server can use it file={} mode={:04o} now=0600", path,
                 mode);
    return true;
}

}  // namespace

void ensurePrivateFile(const std::string& path) {
    if (checkFile(path, PermissionHandling::tighten)) return;
    createFolders(std::filesystem::path(path).parent_path());
    {
        const FileDescriptor file(open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kFileMode));
        if (file.isValid() && fchmod(file.descriptor(), kFileMode) != 0)
            throwStoreError(path, "unable to set its mode to 0600");
        if (!file.isValid() && errno != EEXIST) throwStoreError(path, "unable to open it");
    }
    // Another server may have created the file in the meantime, with another mode.
    checkFile(path, PermissionHandling::tighten);
}

void makePrivateIfExists(const std::string& path) { checkFile(path, PermissionHandling::tighten); }

void requireOwnRegularFileIfExists(const std::string& path) { checkFile(path, PermissionHandling::leave); }

std::string fileIdentity(const std::string& path) {
    struct stat status{};
    if (lstat(path.c_str(), &status) != 0) return {};
    return std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
}

}  // namespace oval4d::store
