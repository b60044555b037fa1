#pragma once
// The number of processors that this process can use.

#include <cstddef>
#include <filesystem>

namespace oval4d::net {

/// The number of processors that this process can keep busy: the hardware threads that it may run on, limited by the
/// CPU quotas of its control group and of all parent groups (cgroup v2 cpu.max, or v1 cpu.cfs_quota_us), rounded up. At
/// least 1. `root` is the folder that contains proc and sys.
std::size_t processors(const std::filesystem::path& root = "/");

}  // namespace oval4d::net
