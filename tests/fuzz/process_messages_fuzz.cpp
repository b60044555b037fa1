// Fuzzes the messages between processes. Invalid bytes must be refused with an exception, and no message may take more
// memory than its reader allows. The first letter of the input selects the type of message.

#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <stdexcept>

#include <glm/matrix.hpp>

#include "process/channel.hpp"
#include "raster/rasterizer_messages.hpp"
#include "slicing/object_bytes.hpp"
#include "support.hpp"

using namespace oval4d;
using fuzz::require;

namespace {

void readOrder(std::string_view bytes) {
    raster::DrawRequest order;
    raster::decodeDrawRequest(bytes, order);
    const glm::dmat4 matrix = order.picture.orientation.matrix();
    require(std::abs(glm::determinant(matrix) - 1) < 1e-6, "a draw request has a rotation");
}

void readObject(std::string_view bytes) {
    std::string again;
    slicing::MappedFiles files;
    const slicing::Object object = slicing::decodeObject(bytes);
    slicing::encodeObject(object, again, files);
    // A field is made again from its formulas and arrays, so other bytes are lost.
    require(slicing::fieldIn(object) != nullptr || bytes.starts_with(again), "an object is written as it was read");
}

/// Receives the bytes as a message through a socket. The other end of the socket is then closed.
void receive(std::string_view bytes) {
    constexpr std::size_t kMost = 1000;
    int sockets[2];
    require(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) == 0, "there are sockets");
    const process::Channel channel(sockets[0]);
    const ssize_t sent = send(sockets[1], bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    close(sockets[1]);
    require(bytes.empty() || sent == static_cast<ssize_t>(bytes.size()), "the socket takes it all");
    process::MessageType type{};
    std::string body;
    int file = process::Channel::kNoFile;
    while (channel.receive(type, body, &file, {}, kMost) == process::TransferResult::complete) {
        require(body.size() <= kMost, "no message is longer than allowed");
        require(file == process::Channel::kNoFile, "no file comes where none was sent");
    }
    require(body.capacity() <= 2 * kMost, "nothing is made room for that is not allowed");
}

}  // namespace

OVAL4D_FUZZER(process_messages) {
    if (size == 0) return 0;
    const std::string_view bytes = fuzz::textOf(data + 1, size - 1);
    try {
        if (data[0] == 'o') readOrder(bytes);
        if (data[0] == 'p') readObject(bytes);
        if (data[0] == 'm') receive(bytes);
    } catch (const std::runtime_error& fault) {
        require(*fault.what() != 0, "what is refused says why");
    }
    return 0;
}
