#include "process/channel.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace oval4d::process {

namespace {

struct MessageHeader {
    MessageType type;
    std::uint64_t size;
};

// Memory for the ancillary data with which a message on a Unix socket carries one file descriptor (see unix(7)).
struct alignas(cmsghdr) AncillaryData {
    char bytes[CMSG_SPACE(sizeof(int))];
};

// The interval at which waitFor() checks whether a stop was requested.
constexpr std::chrono::milliseconds kStopCheckInterval{100};

/// Waits until `event`, an event of poll(2), happens at the socket. Returns false if, before this, the time limit is
/// reached or a stop is requested.
bool waitFor(int socket, short event, const WaitLimit& limit) {
    using std::chrono::milliseconds;
    const milliseconds longest =
        limit.stop.stop_possible() ? kStopCheckInterval : milliseconds(std::numeric_limits<int>::max());
    for (pollfd what{socket, event, 0};;) {
        const auto left = std::chrono::ceil<milliseconds>(limit.until - WaitLimit::Clock::now());
        if (poll(&what, 1, static_cast<int>(std::clamp(left, milliseconds(0), longest).count())) > 0) return true;
        if (left.count() <= 0 || limit.stop.stop_requested()) return false;
    }
}

/// Calls `call`, a nonblocking system call that sends or receives, until it succeeds. Waits for `event` whenever the
/// call would block. On success, sets `moved` to the number of bytes that were sent or received. Otherwise returns why
/// it stopped (see TransferResult).
template <typename Call>
TransferResult transferWhenReady(int socket, short event, const WaitLimit& limit, std::size_t& moved, Call call) {
    for (;;) {
        const ssize_t result = call();
        if (result > 0) {
            moved = static_cast<std::size_t>(result);
            return TransferResult::complete;
        }
        if (result < 0 && errno == EINTR) continue;
        if (result == 0 || errno != EAGAIN) return TransferResult::closed;
        if (!waitFor(socket, event, limit)) return TransferResult::timed_out;
    }
}

}  // namespace

Channel::~Channel() { close(socket_); }

TransferResult Channel::send(MessageType type, std::string_view body, int file, const WaitLimit& limit) const {
    MessageHeader header{type, body.size()};
    std::array parts{iovec{&header, sizeof header}, iovec{const_cast<char*>(body.data()), body.size()}};
    msghdr message{};
    message.msg_iov = parts.data();
    message.msg_iovlen = parts.size();
    AncillaryData ancillary{};
    if (file != kNoFile) {
        message.msg_control = ancillary.bytes;
        message.msg_controllen = sizeof ancillary.bytes;
        cmsghdr* const tag = CMSG_FIRSTHDR(&message);
        tag->cmsg_level = SOL_SOCKET;
        tag->cmsg_type = SCM_RIGHTS;
        tag->cmsg_len = CMSG_LEN(sizeof file);
        std::memcpy(CMSG_DATA(tag), &file, sizeof file);
    }
    const auto call = [&] { return sendmsg(socket_, &message, MSG_NOSIGNAL | MSG_DONTWAIT); };
    for (std::size_t left = sizeof header + body.size(); left > 0;) {
        std::size_t sent = 0;
        const TransferResult transfer = transferWhenReady(socket_, POLLOUT, limit, sent, call);
        if (transfer != TransferResult::complete) return transfer;
        left -= sent;
        message.msg_control = nullptr;
        message.msg_controllen = 0;
        for (iovec& part : parts) {
            const std::size_t taken = std::min(sent, part.iov_len);
            part = {static_cast<char*>(part.iov_base) + taken, part.iov_len - taken};
            sent -= taken;
        }
    }
    return TransferResult::complete;
}

TransferResult Channel::receive(MessageType& type, std::string& body, int* file, const WaitLimit& limit,
                                std::size_t maxBytes) const {
    // Check the limit here, too: transferWhenReady() checks the limit only when it must wait, and so never checks it if
    // the sender is fast.
    if (WaitLimit::Clock::now() > limit.until) return TransferResult::timed_out;
    if (file != nullptr) *file = kNoFile;
    const auto read = [&](void* to, std::size_t size) {
        for (auto* at = static_cast<char*>(to); size > 0;) {
            iovec part{at, size};
            AncillaryData ancillary{};
            msghdr message{};
            message.msg_iov = &part;
            message.msg_iovlen = 1;
            if (file != nullptr) {
                message.msg_control = ancillary.bytes;
                message.msg_controllen = sizeof ancillary.bytes;
            }
            const auto call = [&] { return recvmsg(socket_, &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC); };
            std::size_t got = 0;
            const TransferResult transfer = transferWhenReady(socket_, POLLIN, limit, got, call);
            if (transfer != TransferResult::complete) return transfer;
            if (const cmsghdr* tag = CMSG_FIRSTHDR(&message); tag != nullptr && tag->cmsg_type == SCM_RIGHTS)
                std::memcpy(file, CMSG_DATA(tag), sizeof *file);
            at += got;
            size -= got;
        }
        return TransferResult::complete;
    };
    MessageHeader header{};
    if (const TransferResult transfer = read(&header, sizeof header); transfer != TransferResult::complete)
        return transfer;
    type = header.type;
    if (header.size > maxBytes) throw std::runtime_error("a message between processes is too long");
    body.resize(header.size);
    return read(body.data(), body.size());
}

bool Channel::waitForMessage(const WaitLimit& limit) const { return waitFor(socket_, POLLIN, limit); }

}  // namespace oval4d::process
