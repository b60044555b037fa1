// Orders, polytopes and pixels from one process to another.

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>
#include <stop_token>
#include <string>
#include <system_error>
#include <thread>
#include <tuple>

#include "geometry/catalogue.hpp"
#include "picture/drawing_channel.hpp"
#include "picture/shared_pixels.hpp"

namespace oval4d::picture {
namespace {

using namespace std::chrono_literals;

std::pair<int, int> socketPair() {
    int sockets[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) != 0) throw std::runtime_error("no sockets");
    return {sockets[0], sockets[1]};
}

Patience soon() { return {Patience::Clock::now() + 5ms, {}}; }

session::PolytopePtr catalogued(const char* name) { return geometry::polytopeOf(*geometry::findEntry(name)); }

TEST(DrawingChannel, PolytopesComeAsTheyWere) {
    for (const char* name : {"5-cell", "24-cell", "120-cell"}) {
        const auto sent = catalogued(name);
        std::string bytes;
        encodePolytope(*sent, bytes);
        geometry::Polytope got = *catalogued("8-cell");  // to be overwritten
        decodePolytope(bytes, got);
        EXPECT_EQ(got.name, sent->name);
        EXPECT_EQ(got.serial, sent->serial);
        EXPECT_EQ(got.vertices, sent->vertices);
        EXPECT_EQ(got.edges, sent->edges);
        EXPECT_EQ(got.faces, sent->faces);
        EXPECT_EQ(got.faceEdges, sent->faceEdges);
        EXPECT_EQ(got.edgeFaces, sent->edgeFaces);
        EXPECT_EQ(got.cells, sent->cells);
        EXPECT_EQ(got.cellSigns, sent->cellSigns);
        EXPECT_EQ(got.faceCells, sent->faceCells);
        EXPECT_EQ(got.cellKinds, sent->cellKinds);
        EXPECT_EQ(got.kinds, sent->kinds);
        EXPECT_EQ(std::tie(got.convexFaces, got.convex, got.circumradius),
                  std::tie(sent->convexFaces, sent->convex, sent->circumradius));
    }
}

TEST(DrawingChannel, OrdersComeAsTheyWere) {
    session::State state = session::initialState();
    state.orientation = geometry::Rotation(geometry::Turn{geometry::Plane::xw, 0.3, 0.2});
    state.slices = {31, 0.125, -2};
    state.look.view = scene::View::single;
    state.look.orbit = {0.5, 0.25, 2};
    state.look.kinds = {{1, 3}, {2}};
    std::string bytes;
    encodeOrder(state, {640, 360}, {7, 8}, bytes);
    Order order;
    decodeOrder(bytes, order);
    EXPECT_EQ(order.polytope, state.polytope->serial);
    EXPECT_EQ(order.state.orientation, state.orientation);
    EXPECT_EQ(order.state.slices, state.slices);
    EXPECT_EQ(order.state.look, state.look);
    EXPECT_EQ(order.viewport, (scene::Viewport{640, 360}));
    EXPECT_EQ(order.limits.fillSteps, 7U);
    EXPECT_EQ(order.limits.polytopeBytes, 8U);
}

TEST(DrawingChannel, BytesCutShortAreRefused) {
    std::string bytes;
    encodePolytope(*catalogued("5-cell"), bytes);
    geometry::Polytope polytope;
    for (std::size_t size = 0; size < bytes.size(); size += 7)
        EXPECT_THROW(decodePolytope(std::string_view(bytes).substr(0, size), polytope), std::runtime_error);
    encodeOrder(session::initialState(), {640, 360}, {}, bytes);
    Order order;
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_THROW(decodeOrder(std::string_view(bytes).substr(0, size), order), std::runtime_error);
}

TEST(DrawingChannel, LongMessagesArriveWholeWithTheirFile) {
    const auto [here, there] = socketPair();
    const DrawingChannel sender(here), receiver(there);
    SharedPixels pixels;
    const auto written = pixels.take(1'000'000);
    written[999'999] = 42;
    const std::string text(5'000'000, 'x');  // many times what a socket holds
    std::thread sending([&] {
        EXPECT_EQ(sender.send(Said::order, text, pixels.file()), Passage::whole);
        EXPECT_EQ(sender.send(Said::ready), Passage::whole);
    });
    Said said{};
    std::string body;
    int file = DrawingChannel::kNoFile;
    EXPECT_EQ(receiver.receive(said, body, &file), Passage::whole);
    sending.join();
    EXPECT_EQ(said, Said::order);
    EXPECT_EQ(body, text);
    ASSERT_NE(file, DrawingChannel::kNoFile);
    SharedPixels seen(file);
    EXPECT_EQ(seen.number(), pixels.number());
    EXPECT_EQ(seen.see(1'000'000)[999'999], 42);
    EXPECT_EQ(receiver.receive(said, body, &file), Passage::whole);
    EXPECT_EQ(said, Said::ready);
    EXPECT_TRUE(body.empty());
    EXPECT_EQ(file, DrawingChannel::kNoFile);
}

TEST(DrawingChannel, KnowsWhenNobodyIsThere) {
    const auto [here, there] = socketPair();
    const DrawingChannel channel(here);
    EXPECT_FALSE(channel.wait(soon()));
    close(there);
    EXPECT_TRUE(channel.wait(soon()));
    Said said{};
    std::string body;
    EXPECT_EQ(channel.receive(said, body), Passage::closed);
    EXPECT_EQ(channel.send(Said::ready), Passage::closed);
}

TEST(DrawingChannel, WaitsForNoneThatHangs) {
    const auto [here, there] = socketPair();
    const DrawingChannel channel(here), hanging(there);
    Said said{};
    std::string body;
    EXPECT_EQ(channel.receive(said, body, nullptr, soon()), Passage::late);
    // It reads nothing of what does not fit into the socket.
    const std::string text(5'000'000, 'x');
    EXPECT_EQ(channel.send(Said::polytope, text, DrawingChannel::kNoFile, soon()), Passage::late);
    // It hangs amid a message: the other end has its head, and the first of its bytes.
    EXPECT_EQ(hanging.receive(said, body, nullptr, soon()), Passage::late);
    EXPECT_EQ(said, Said::polytope);
}

TEST(DrawingChannel, WaitsNoLongerWhenAskedToStop) {
    const auto [here, there] = socketPair();
    const DrawingChannel channel(here), hanging(there);
    std::stop_source stop;
    std::thread stopping([&] {
        std::this_thread::sleep_for(20ms);
        stop.request_stop();
    });
    Said said{};
    std::string body;
    EXPECT_EQ(channel.receive(said, body, nullptr, {Patience::Clock::time_point::max(), stop.get_token()}),
              Passage::late);
    stopping.join();
}

TEST(DrawingChannel, FilesThatNobodyWantsAreDropped) {
    const auto [here, there] = socketPair();
    const DrawingChannel sender(here), receiver(there);
    Said said{};
    std::string body;
    const int before = dup(0);
    close(before);
    SharedPixels pixels;
    EXPECT_EQ(sender.send(Said::order, "1", pixels.file()), Passage::whole);
    EXPECT_EQ(receiver.receive(said, body), Passage::whole);
    EXPECT_EQ(body, "1");
    const int after = dup(0);  // the lowest number that is free
    EXPECT_EQ(after, before + 1);
    close(after);
}

TEST(SharedPixels, AreSeenThroughAllSizes) {
    SharedPixels pixels;
    SharedPixels other(dup(pixels.file()));
    for (const std::size_t size : {100U, 100'000U, 100U, 5'000'000U, 64U}) {
        const auto written = pixels.take(size);
        ASSERT_EQ(written.size(), size);
        written[size - 1] = static_cast<std::uint8_t>(size % 251);
        EXPECT_EQ(other.see(size)[size - 1], size % 251);
    }
    EXPECT_THROW(other.see(1'000'000'000), std::system_error);
}

}  // namespace
}  // namespace oval4d::picture
