#include "net/jobs/spool.hpp"

#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "net/unnamed_file.hpp"

namespace oval4d::net {

namespace {

constexpr std::size_t kSpoolThreshold = 1U << 20U;

bool writeAll(int file, std::string_view rest) {
    while (!rest.empty()) {
        const ssize_t written = write(file, rest.data(), rest.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        rest.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

std::filesystem::path folderOrDefault(const std::string& folder) {
    std::error_code fault;
    if (!folder.empty()) return folder;
    const auto temporary = std::filesystem::temp_directory_path(fault);
    return fault ? std::filesystem::path("/tmp") : temporary;
}

}  // namespace

SharedBytes spool(std::string bytes, const std::string& folder) {
    if (bytes.size() < kSpoolThreshold) return SharedBytes(std::move(bytes));
    const int file = openUnnamedFile(folderOrDefault(folder));
    const bool written = file >= 0 && writeAll(file, bytes);
    void* const at = written ? mmap(nullptr, bytes.size(), PROT_READ, MAP_SHARED, file, 0) : MAP_FAILED;
    const int fault = errno;
    if (file >= 0) close(file);  // the mapping keeps the file alive
    if (at == MAP_FAILED) {
        spdlog::warn("a file stays in memory because it cannot be spooled bytes={} reason=\"{}\"", bytes.size(),
                     std::strerror(fault));
        return SharedBytes(std::move(bytes));
    }
    const std::size_t size = bytes.size();
    return {std::string_view(static_cast<const char*>(at), size),
            std::shared_ptr<const void>(at, [size](const void* mapped) { munmap(const_cast<void*>(mapped), size); })};
}

}  // namespace oval4d::net
