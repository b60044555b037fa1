#pragma once
// The number of processors that this process can use.

#include <cstddef>
#include <filesystem>

namespace oval4d::net {

/// Returns how many processors this process can keep busy, rounded up; at least 1. This is the number of hardware
/// threads, limited by the CPU quotas of the process's control group and all parent groups (cpu.max in cgroup v2,
/// cpu.cfs_quota_us in v1). `root` is the folder that contains proc and sys.
std::size_t usableProcessorCount(const std::filesystem::path& root = "/");

}  // namespace oval4d::net
