// Tests of what the sandbox allows a process to do.

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "process/sandbox.hpp"

namespace oval4d::process {
namespace {

/// Calls `act` in a sandboxed child process. Returns the child's status as waitpid(2) does: 0 if `act` returns true.
int endOf(SandboxRole role, const Confinement& confinement, const std::function<bool()>& act) {
    const pid_t child = fork();
    if (child == 0) {
        forbidNewPrivileges();
        confine(role, confinement);
        _exit(act() ? 0 : 1);
    }
    int status = -1;
    waitpid(child, &status, 0);
    return status;
}

class Confined : public testing::TestWithParam<SandboxRole> {
  protected:
    void SetUp() override {
        std::string why;
        if (!shouldSandbox(SandboxMode::automatic, why)) GTEST_SKIP() << why;
    }
    static int end(const std::function<bool()>& act) { return endOf(GetParam(), {true, 0, 0}, act); }
};

bool refused(int result) { return result < 0 && errno == EPERM; }

TEST_P(Confined, MayUseMemoryWaitAndLog) {
    EXPECT_EQ(end([] {
                  const std::vector<int> much(10'000'000, 1);
                  timespec pause{0, 1000};
                  return much[777] == 1 && nanosleep(&pause, nullptr) == 0 && write(STDERR_FILENO, "", 0) == 0;
              }),
              0);
}

TEST_P(Confined, MayNotUseFilesOrOtherProcesses) {
    EXPECT_EQ(end([] { return refused(open("/etc/passwd", O_RDONLY)); }), 0);
    EXPECT_EQ(end([] { return refused(open("/tmp", O_TMPFILE | O_RDWR, 0600)); }), 0);
    EXPECT_EQ(end([] { return refused(unlink("/tmp/oval4d-that-is-not-there")); }), 0);
    EXPECT_EQ(end([] { return refused(static_cast<int>(write(STDOUT_FILENO, "x", 1))); }), 0);
    EXPECT_EQ(end([] { return refused(kill(getppid(), 0)); }), 0);
    EXPECT_EQ(end([] { return refused(fork()); }), 0);
}

TEST_P(Confined, IsKilledForCallsOfAnIntruder) {
    const auto killed = [](int status) { return WIFSIGNALED(status) && WTERMSIG(status) == SIGSYS; };
    EXPECT_TRUE(killed(end([] { return socket(AF_INET, SOCK_STREAM, 0) < 0; })));
    EXPECT_TRUE(killed(end([] { return execl("/bin/true", "true", nullptr) < 0; })));
}

TEST_P(Confined, MayExecuteGeneratedCodeOnlyToDraw) {
    EXPECT_EQ(end([] {
                  void* const page = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
                  if (page == MAP_FAILED) return false;
                  return (mprotect(page, 4096, PROT_READ | PROT_EXEC) == 0) == (GetParam() == SandboxRole::draw);
              }),
              0);
}

TEST_P(Confined, MayStartThreadsOnlyToDraw) {
    EXPECT_EQ(end([] {
                  bool ran = false;
                  try {
                      std::thread([&ran] { ran = true; }).join();
                  } catch (const std::system_error&) {
                  }
                  return ran == (GetParam() == SandboxRole::draw);
              }),
              0);
}

INSTANTIATE_TEST_SUITE_P(Sandbox, Confined, testing::Values(SandboxRole::draw, SandboxRole::parse_file));

TEST(Sandbox, LimitsAdditionalMemory) {
    std::string why;
    if (!shouldSandbox(SandboxMode::automatic, why)) GTEST_SKIP() << why;  // builds with sanitizers have no limit
    const auto takes = [](std::size_t bytes) {
        return [bytes] {
            try {
                return std::vector<char>(bytes, 1).data()[bytes / 2] == 1;
            } catch (const std::bad_alloc&) {
                return false;
            }
        };
    };
    const Confinement confinement{false, std::size_t{256} << 20U, 0};
    EXPECT_EQ(endOf(SandboxRole::parse_file, confinement, takes(std::size_t{200} << 20U)), 0);
    EXPECT_NE(endOf(SandboxRole::parse_file, confinement, takes(std::size_t{300} << 20U)), 0);
}

TEST(Sandbox, LimitsFilesAndCoreDumps) {
    std::string why;
    if (!shouldSandbox(SandboxMode::automatic, why)) GTEST_SKIP() << why;
    EXPECT_EQ(endOf(SandboxRole::parse_file, {false, 0, 20},
                    [] {
                        rlimit cores{}, files{};
                        getrlimit(RLIMIT_CORE, &cores), getrlimit(RLIMIT_NOFILE, &files);
                        return cores.rlim_max == 0 && files.rlim_max == 20;
                    }),
              0);
}

TEST(Sandbox, CanBeTurnedOff) {
    std::string why;
    EXPECT_FALSE(shouldSandbox(SandboxMode::off, why));
    EXPECT_TRUE(why.empty());
}

}  // namespace
}  // namespace oval4d::process
