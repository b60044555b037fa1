#pragma once
// How many threads are worth having.

#include <cstddef>
#include <filesystem>

namespace oval4d::net {

/// The processors that this process can keep busy: those that it may run on, and not more than its control group and
/// the groups around it have the time of (cpu.max, or cpu.cfs_quota_us of version 1), rounded up. At least 1.
/// `root` is where /proc and /sys are looked for.
std::size_t processors(const std::filesystem::path& root = "/");

}  // namespace oval4d::net
