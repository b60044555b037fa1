#include "file_reading/folder_access.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fields/array/mapped_file.hpp"

namespace oval4d::file_reading {

int openFileWithin(int folder, const std::string& path) {
    constexpr int kFlags = O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
    int within = dup(folder);
    for (std::size_t begin = 0; within >= 0;) {
        const fields::FileHandle parent(within);
        const std::size_t end = path.find('/', begin);
        const std::string name = path.substr(begin, end - begin);
        if (name.empty() || name == "." || name == ".." || name.find('\0') != std::string::npos) return -1;
        within = openat(parent.descriptor(), name.c_str(), kFlags | (end == std::string::npos ? 0 : O_DIRECTORY));
        if (end == std::string::npos) break;
        begin = end + 1;
    }
    struct stat status{};
    if (within >= 0 && (fstat(within, &status) != 0 || !S_ISREG(status.st_mode))) {
        close(within);
        return -1;
    }
    return within;
}

}  // namespace oval4d::file_reading
