// Tests of the channel, which carries messages between processes.

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "hang_limit.hpp"
#include "process/channel.hpp"

namespace oval4d::process {
namespace {

using namespace std::chrono_literals;

std::pair<int, int> socketPair() {
    int sockets[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) != 0) throw std::runtime_error("no sockets");
    return {sockets[0], sockets[1]};
}

WaitLimit soon() { return {WaitLimit::Clock::now() + 5ms, {}}; }

/// Returns a limit that ends an operation only if the operation would wait.
WaitLimit stopped() {
    std::stop_source stop;
    stop.request_stop();
    return {WaitLimit::Clock::time_point::max(), stop.get_token()};
}

/// Returns whether the main thread of this process waits for a system call.
bool mainThreadWaits() {
    std::ifstream file("/proc/self/stat");
    const std::string stat(std::istreambuf_iterator<char>(file), {});
    return stat.at(stat.rfind(')') + 2) == 'S';  // the state follows the process name in parentheses (proc(5))
}

TEST(Channel, KnowsWhenNobodyIsThere) {
    const auto [here, there] = socketPair();
    const Channel channel(here);
    EXPECT_FALSE(channel.waitForMessage(soon()));
    close(there);
    EXPECT_TRUE(channel.waitForMessage(soon()));
    MessageType type{};
    std::string body;
    EXPECT_EQ(channel.receive(type, body), TransferResult::closed);
    EXPECT_EQ(channel.send(MessageType::ready), TransferResult::closed);
}

TEST(Channel, WaitsForNoneThatHangs) {
    const auto [here, there] = socketPair();
    const Channel channel(here), hanging(there);
    MessageType type{};
    std::string body;
    EXPECT_EQ(channel.receive(type, body, nullptr, soon()), TransferResult::timed_out);
    // A message that does not fit into the socket's buffer times out if the receiver does not read.
    const std::string text(5'000'000, 'x');
    EXPECT_EQ(channel.send(MessageType::object, text, Channel::kNoFile, soon()), TransferResult::timed_out);
    // The sender has stopped in the middle of the message, so the receiver gets the header and only some of the bytes.
    EXPECT_EQ(hanging.receive(type, body, nullptr, stopped()), TransferResult::timed_out);
    EXPECT_EQ(type, MessageType::object);
}

TEST(Channel, WaitsNoLongerWhenAskedToStop) {
    const auto [here, there] = socketPair();
    const Channel channel(here), hanging(there);
    std::stop_source stop;
    std::thread stopping([&] {
        EXPECT_TRUE(support::eventually(mainThreadWaits));  // the main thread waits in receive()
        stop.request_stop();
    });
    MessageType type{};
    std::string body;
    EXPECT_EQ(channel.receive(type, body, nullptr, {WaitLimit::Clock::time_point::max(), stop.get_token()}),
              TransferResult::timed_out);
    stopping.join();
}

TEST(Channel, MessagesThatAreTooLongAreRefused) {
    const auto [here, there] = socketPair();
    const Channel sender(here), receiver(there);
    MessageType type{};
    std::string body;
    EXPECT_EQ(sender.send(MessageType::failed, "12345"), TransferResult::complete);
    EXPECT_EQ(receiver.receive(type, body, nullptr, {}, 5), TransferResult::complete);
    EXPECT_EQ(sender.send(MessageType::failed, "123456"), TransferResult::complete);
    EXPECT_THROW((void)receiver.receive(type, body, nullptr, {}, 5), std::runtime_error);
}

}  // namespace
}  // namespace oval4d::process
