#include "net/processor_count.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

namespace oval4d::net {

namespace fs = std::filesystem;

namespace {

/// Returns the CPU quota of a control group as a number of processors: 2 for the cpu.max "200000 100000". Returns an
/// empty optional if there is no quota ("max 100000") or no such file.
std::optional<double> cpuQuotaOf(const fs::path& group) {
    double quota = 0, period = 0;
    if (std::ifstream(group / "cpu.max") >> quota >> period && period > 0) return quota / period;
    if (std::ifstream(group / "cpu.cfs_quota_us") >> quota && quota > 0 &&
        std::ifstream(group / "cpu.cfs_period_us") >> period && period > 0) {
        return quota / period;
    }
    return std::nullopt;
}

}  // namespace

std::size_t usableProcessorCount(const fs::path& root) {
    double most = std::max(1U, std::thread::hardware_concurrency());
    std::ifstream groups(root / "proc/self/cgroup");  // lines such as "0::/path" (v2) or "4:cpu,cpuacct:/path" (v1)
    for (std::string line; std::getline(groups, line);) {
        const auto first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        if (!controllers.empty() && controllers != "cpu" && controllers != "cpu,cpuacct") continue;
        const fs::path mount = root / "sys/fs/cgroup" / controllers;
        // In a container, the line may contain the path of the group on the host, although the container sees only its
        // own group, at `mount`. Therefore the path and all its parents up to `mount` are tried. cpuQuotaOf() skips
        // missing files.
        for (fs::path path = line.substr(second + 2);; path = path.parent_path()) {
            if (const auto quota = cpuQuotaOf(mount / path)) most = std::min(most, *quota);
            if (path.empty()) break;
        }
    }
    return static_cast<std::size_t>(std::max(1.0, std::ceil(most)));
}

}  // namespace oval4d::net
