#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

#include "net/processor_count.hpp"

namespace oval4d::net {
namespace {

namespace fs = std::filesystem;

/// A temporary root folder, in which a test writes its own /proc and /sys.
class Processors : public testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = fs::temp_directory_path() / "oval4d-root-XXXXXX";
        root = mkdtemp(pattern.data());
    }
    void TearDown() override { fs::remove_all(root); }
    void write(const std::string& path, const std::string& text) const {
        fs::create_directories((root / path).parent_path());
        std::ofstream(root / path) << text;
    }

    fs::path root;
    const std::size_t all = std::max(1U, std::thread::hardware_concurrency());
};

TEST_F(Processors, CountsAllWithoutAQuota) {
    EXPECT_EQ(usableProcessorCount(root), all);
    write("proc/self/cgroup", "0::/\n");
    write("sys/fs/cgroup/cpu.max", "max 100000\n");
    EXPECT_EQ(usableProcessorCount(root), all);
    write("sys/fs/cgroup/cpu.max", "100000000 100000\n");
    EXPECT_EQ(usableProcessorCount(root), all) << "a quota of 1000 processors";
}

TEST_F(Processors, RoundsTheQuotaUp) {
    write("proc/self/cgroup", "0::/\n");
    write("sys/fs/cgroup/cpu.max", "20000 100000\n");
    EXPECT_EQ(usableProcessorCount(root), 1U);
    write("sys/fs/cgroup/cpu.max", "110000 100000\n");
    EXPECT_EQ(usableProcessorCount(root), std::min<std::size_t>(all, 2));
}

TEST_F(Processors, AppliesQuotasOfParentGroups) {
    write("proc/self/cgroup", "0::/kubepods/pod7/oval4d\n");
    write("sys/fs/cgroup/kubepods/pod7/cpu.max", "50000 100000\n");
    write("sys/fs/cgroup/kubepods/pod7/oval4d/cpu.max", "max 100000\n");
    EXPECT_EQ(usableProcessorCount(root), 1U);
}

TEST_F(Processors, SupportsCgroupVersion1) {
    write("proc/self/cgroup", "5:memory:/a\n4:cpu,cpuacct:/docker/b\n");
    write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "-1\n");
    write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_period_us", "100000\n");
    EXPECT_EQ(usableProcessorCount(root), all);
    write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "90000\n");
    EXPECT_EQ(usableProcessorCount(root), 1U);
}

}  // namespace
}  // namespace oval4d::net
