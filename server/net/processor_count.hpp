#pragma once
// The number of processors that this process can use.

#include <cstddef>
#include <filesystem>

namespace oval4d::net {

/// Returns the number of processors that this process can keep busy, at least 1: the number of hardware threads that it
/// may use, limited by the CPU quotas of its control group and of all parent groups (cgroup v2 cpu.max, or v1
/// cpu.cfs_quota_us), rounded up. `root`: the folder that contains proc and sys.
std::size_t usableProcessorCount(const std::filesystem::path& root = "/");

}  // namespace oval4d::net
