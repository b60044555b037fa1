#include "picture/drawing_channel.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "picture/bytes.hpp"

// The structured bindings name every member of what they take apart: with a new one they do not compile.

namespace oval4d::picture {

namespace {

template <typename Archive, typename Lists>
void visitLists(Archive& archive, Lists& lists) {
    auto& [begin, items] = lists;
    archive(begin), archive(items);
}

template <typename Archive, typename Polytope>
void visitPolytope(Archive& archive, Polytope& polytope) {
    auto& [name, vertices, edges, faces, faceEdges, edgeFaces, cells, cellSigns, faceCells, cellKinds, kinds, serial,
           convexFaces, convex, circumradius] = polytope;
    archive(name), archive(vertices), archive(edges);
    for (auto* lists : {&faces, &faceEdges, &edgeFaces, &cells}) visitLists(archive, *lists);
    archive(cellSigns), archive(faceCells), archive(cellKinds);
    archive(serial), archive(convexFaces), archive(convex), archive(circumradius);
}

template <typename Archive, typename Look>
void visitLook(Archive& archive, Look& look) {
    auto& [view, parts, orbit, colouring, kinds] = look;
    auto& [hidden, faded] = kinds;
    archive(view), archive(parts), archive(orbit), archive(colouring), archive(hidden), archive(faded);
}

struct Head {
    Said said;
    std::uint64_t size;
};

// Room for one file that travels along with bytes.
struct alignas(cmsghdr) Luggage {
    char bytes[CMSG_SPACE(sizeof(int))];
};

// How long it may take until a stop is noticed.
constexpr std::chrono::milliseconds kNotice{100};

/// Whether `event` came in time.
bool waitFor(int socket, short event, const Patience& patience) {
    using std::chrono::milliseconds;
    const milliseconds longest =
        patience.stop.stop_possible() ? kNotice : milliseconds(std::numeric_limits<int>::max());
    for (pollfd what{socket, event, 0};;) {
        const auto left = std::chrono::ceil<milliseconds>(patience.until - Patience::Clock::now());
        if (poll(&what, 1, static_cast<int>(std::clamp(left, milliseconds(0), longest).count())) > 0) return true;
        if (left.count() <= 0 || patience.stop.stop_requested()) return false;
    }
}

/// Makes a system call that moves bytes, until it has `moved` some.
template <typename Call>
Passage moveSome(int socket, short event, const Patience& patience, std::size_t& moved, Call call) {
    for (;;) {
        const ssize_t result = call();
        if (result > 0) {
            moved = static_cast<std::size_t>(result);
            return Passage::whole;
        }
        if (result < 0 && errno == EINTR) continue;
        if (result == 0 || errno != EAGAIN) return Passage::closed;
        if (!waitFor(socket, event, patience)) return Passage::late;
    }
}

}  // namespace

void encodeOrder(const session::State& state, scene::Viewport viewport, const DrawingLimits& limits, std::string& out) {
    out.clear();
    BytesOut archive(out);
    archive(state.polytope->serial), archive(state.orientation.left()), archive(state.orientation.right());
    archive(state.slices), visitLook(archive, state.look);
    archive(viewport), archive(limits);
}

void decodeOrder(std::string_view bytes, Order& out) {
    BytesIn archive(bytes);
    glm::dquat left, right;
    archive(out.polytope), archive(left), archive(right);
    archive(out.state.slices), visitLook(archive, out.state.look);
    archive(out.viewport), archive(out.limits);
    const auto orientation = geometry::Rotation::fromQuaternions(left, right);
    if (!orientation) throw std::runtime_error("a message between processes has no rotation");
    out.state.orientation = *orientation;
}

void encodePolytope(const geometry::Polytope& polytope, std::string& out) {
    out.clear();
    BytesOut archive(out);
    visitPolytope(archive, polytope);
    archive(polytope.kinds.size());
    for (const auto& [name, cells] : polytope.kinds) archive(name), archive(cells);
}

void decodePolytope(std::string_view bytes, geometry::Polytope& out) {
    BytesIn archive(bytes);
    visitPolytope(archive, out);
    std::size_t kinds = 0;
    archive(kinds);
    for (out.kinds.clear(); out.kinds.size() < kinds;) {
        auto& [name, cells] = out.kinds.emplace_back();
        archive(name), archive(cells);
    }
}

DrawingChannel::~DrawingChannel() { close(socket_); }

Passage DrawingChannel::send(Said said, std::string_view body, int file, const Patience& patience) const {
    Head head{said, body.size()};
    std::array parts{iovec{&head, sizeof head}, iovec{const_cast<char*>(body.data()), body.size()}};
    msghdr message{};
    message.msg_iov = parts.data();
    message.msg_iovlen = parts.size();
    Luggage luggage{};
    if (file != kNoFile) {
        message.msg_control = luggage.bytes;
        message.msg_controllen = sizeof luggage.bytes;
        cmsghdr* const tag = CMSG_FIRSTHDR(&message);
        tag->cmsg_level = SOL_SOCKET;
        tag->cmsg_type = SCM_RIGHTS;
        tag->cmsg_len = CMSG_LEN(sizeof file);
        std::memcpy(CMSG_DATA(tag), &file, sizeof file);
    }
    const auto call = [&] { return sendmsg(socket_, &message, MSG_NOSIGNAL | MSG_DONTWAIT); };
    for (std::size_t left = sizeof head + body.size(); left > 0;) {
        std::size_t sent = 0;
        const Passage passage = moveSome(socket_, POLLOUT, patience, sent, call);
        if (passage != Passage::whole) return passage;
        left -= sent;
        message.msg_control = nullptr;
        message.msg_controllen = 0;
        for (iovec& part : parts) {
            const std::size_t taken = std::min(sent, part.iov_len);
            part = {static_cast<char*>(part.iov_base) + taken, part.iov_len - taken};
            sent -= taken;
        }
    }
    return Passage::whole;
}

Passage DrawingChannel::receive(Said& said, std::string& body, int* file, const Patience& patience) const {
    if (file != nullptr) *file = kNoFile;
    const auto read = [&](void* to, std::size_t size) {
        for (auto* at = static_cast<char*>(to); size > 0;) {
            iovec part{at, size};
            Luggage luggage{};
            msghdr message{};
            message.msg_iov = &part;
            message.msg_iovlen = 1;
            if (file != nullptr) {
                message.msg_control = luggage.bytes;
                message.msg_controllen = sizeof luggage.bytes;
            }
            const auto call = [&] { return recvmsg(socket_, &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC); };
            std::size_t got = 0;
            const Passage passage = moveSome(socket_, POLLIN, patience, got, call);
            if (passage != Passage::whole) return passage;
            if (const cmsghdr* tag = CMSG_FIRSTHDR(&message); tag != nullptr && tag->cmsg_type == SCM_RIGHTS)
                std::memcpy(file, CMSG_DATA(tag), sizeof *file);
            at += got;
            size -= got;
        }
        return Passage::whole;
    };
    Head head{};
    if (const Passage passage = read(&head, sizeof head); passage != Passage::whole) return passage;
    said = head.said;
    body.resize(head.size);
    return read(body.data(), body.size());
}

bool DrawingChannel::wait(const Patience& patience) const { return waitFor(socket_, POLLIN, patience); }

}  // namespace oval4d::picture
