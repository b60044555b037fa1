#include "net/unnamed_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>

namespace oval4d::net {

int openUnnamedFile(const std::filesystem::path& folder) {
    constexpr mode_t kOwnersOnly = 0600;
    const int file = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kOwnersOnly);
    if (file >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != ENOENT)) return file;
    std::string name = folder / "oval4d-XXXXXX";  // without O_TMPFILE, create a named file and delete the name
    const int named = mkostemp(name.data(), O_CLOEXEC);
    if (named >= 0) unlink(name.c_str());
    return named;
}

}  // namespace oval4d::net
