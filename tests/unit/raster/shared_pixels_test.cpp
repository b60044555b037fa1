// Tests of pixels in memory that two processes share.

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "process/channel.hpp"
#include "raster/shared_pixels.hpp"

namespace oval4d::raster {
namespace {

using process::Channel;
using process::MessageType;
using process::TransferResult;

std::pair<int, int> socketPair() {
    int sockets[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) != 0) throw std::runtime_error("no sockets");
    return {sockets[0], sockets[1]};
}

TEST(Channel, LongMessagesArriveWholeWithTheirFile) {
    const auto [here, there] = socketPair();
    const Channel sender(here), receiver(there);
    SharedPixels pixels;
    const auto written = pixels.resize(1'000'000);
    written[999'999] = 42;
    const std::string text(5'000'000, 'x');  // much more than the buffer of a socket can hold
    std::thread sending([&] {
        EXPECT_EQ(sender.send(MessageType::draw, text, pixels.file()), TransferResult::complete);
        EXPECT_EQ(sender.send(MessageType::ready), TransferResult::complete);
    });
    MessageType type{};
    std::string body;
    int file = Channel::kNoFile;
    EXPECT_EQ(receiver.receive(type, body, &file), TransferResult::complete);
    sending.join();
    EXPECT_EQ(type, MessageType::draw);
    EXPECT_EQ(body, text);
    ASSERT_NE(file, Channel::kNoFile);
    SharedPixels seen(file);
    EXPECT_EQ(seen.inode(), pixels.inode());
    EXPECT_EQ(seen.remapIfResized(1'000'000)[999'999], 42);
    EXPECT_EQ(receiver.receive(type, body, &file), TransferResult::complete);
    EXPECT_EQ(type, MessageType::ready);
    EXPECT_TRUE(body.empty());
    EXPECT_EQ(file, Channel::kNoFile);
}

TEST(Channel, FilesThatNobodyWantsAreDropped) {
    const auto [here, there] = socketPair();
    const Channel sender(here), receiver(there);
    MessageType type{};
    std::string body;
    const int before = dup(0);
    close(before);
    SharedPixels pixels;
    EXPECT_EQ(sender.send(MessageType::draw, "1", pixels.file()), TransferResult::complete);
    EXPECT_EQ(receiver.receive(type, body), TransferResult::complete);
    EXPECT_EQ(body, "1");
    const int after = dup(0);  // the lowest free descriptor; it is greater if a descriptor has leaked
    EXPECT_EQ(after, before + 1);
    close(after);
}

TEST(SharedPixels, AreSeenThroughAllSizes) {
    SharedPixels pixels;
    SharedPixels other(dup(pixels.file()));
    for (const std::size_t size : {100U, 100'000U, 100U, 5'000'000U, 64U}) {
        const auto written = pixels.resize(size);
        ASSERT_EQ(written.size(), size);
        written[size - 1] = static_cast<std::uint8_t>(size % 251);
        EXPECT_EQ(other.remapIfResized(size)[size - 1], size % 251);
    }
    EXPECT_THROW(other.remapIfResized(1'000'000'000), std::system_error);
}

}  // namespace
}  // namespace oval4d::raster
