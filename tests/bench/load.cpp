// Measures a running server under load. Measures the time from a key to its picture and from a point to the element
// there, with many sessions, a flood of keys, and a client that never reads. Prints a line of JSON for each
// measurement.
//   oval4d --port 8080 --max-requests 1000000 --session-expiry 2 &  bench_load [port] [seconds]

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <thread>

#include "load_client.hpp"

namespace {

namespace asio = boost::asio;
using asio::use_awaitable;
using load::Client;
using load::Clock;
using load::Endpoint;
using load::Latencies;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// A group of coroutines that run at the same time. run() returns when all have ended, and rethrows their first
/// exception.
class CoroutineGroup {
  public:
    asio::io_context io;

    void spawn(asio::awaitable<void> act) {
        asio::co_spawn(io, std::move(act), [this](std::exception_ptr fault) {
            if (fault && !fault_) fault_ = fault;
        });
    }
    void run() {
        io.restart();
        io.run();
        if (fault_) std::rethrow_exception(std::exchange(fault_, nullptr));
    }

  private:
    std::exception_ptr fault_;
};

void say(const std::string& what, const std::string& members) {
    std::printf(R"({"what":"%s",%s})"
                "\n",
                what.c_str(), members.c_str());
    std::fflush(stdout);
}

template <typename... Numbers>
std::string text(const char* format, Numbers... numbers) {
    char line[200];
    std::snprintf(line, sizeof line, format, numbers...);
    return line;
}

void row(const std::string& what, Latencies latencies) {
    std::ranges::sort(latencies);
    const auto at = [&latencies](double part) {
        return latencies.empty() ? 0 : 1e3 * latencies[static_cast<std::size_t>(part * double(latencies.size() - 1))];
    };
    say(what, text(R"("pictures":%zu,"median":%.3f,"p95":%.3f,"p99":%.3f,"worst":%.3f)", latencies.size(), at(0.5),
                   at(0.95), at(0.99), at(1)));
}

std::string helloFor(const std::string& stream) { return R"({"type":"hello","stream":")" + stream + "\"}"; }
std::string setPolytope(const std::string& name) { return R"({"type":"set","polytope":")" + name + "\"}"; }

/// Opens a session with this polytope. A new session already has the 5-cell, so that one need not be set.
asio::awaitable<void> openWith(Client& client, std::string hello, std::string polytope) {
    co_await client.open(std::move(hello), true);
    if (polytope == "5-cell") co_return;
    co_await client.send(setPolytope(polytope));
    co_await client.picture(1);
}

/// Repeatedly presses a key and waits for its picture, for `seconds` seconds.
asio::awaitable<void> pressing(CoroutineGroup& group, Endpoint server, std::string hello, std::string polytope,
                               double seconds, Latencies& latencies) {
    Client client(group.io, server);
    co_await openWith(client, hello, polytope);
    for (int i = 0; i < 20; ++i) co_await client.key('r');  // warm-up
    for (const auto start = Clock::now(); since(start) < seconds;) {
        const auto pressed = Clock::now();
        co_await client.key(latencies.size() % 3 == 0 ? 'y' : latencies.size() % 3 == 1 ? 'r' : 't');
        latencies.push_back(since(pressed));
    }
    co_await client.close();
}

/// Returns a number from 0 to `size` − 1. For i = 0, 1, 2, … and an irrational `step`, these numbers are evenly spread.
int spread(int i, double step, int size) { return static_cast<int>(size * std::fmod(i * step, 1.0)); }

/// A client of a session with frames. It asks what its picture shows at many points, one after another. Before every
/// tenth point the object turns, so that the server cannot answer all questions from its cache.
asio::awaitable<void> pointing(CoroutineGroup& group, Endpoint server, std::string polytope, int points,
                               Latencies& latencies) {
    constexpr int kWidth = 1280, kHeight = 720;  // the size of frames unless `hello` states another one
    // These steps spread points evenly in a square (M. Roberts, "The unreasonable effectiveness of quasirandom
    // sequences").
    constexpr double kStepX = 0.7548776662466927, kStepY = 0.5698402909980532;
    Client client(group.io, server);
    co_await openWith(client, helloFor("frames"), polytope);
    for (int i = 0; i < points; ++i) {
        if (i % 10 == 0) co_await client.key('y');
        const auto asked = Clock::now();
        co_await client.pointAt(spread(i, kStepX, kWidth), spread(i, kStepY, kHeight));
        latencies.push_back(since(asked));
    }
    co_await client.close();
}

/// One of many clients that press ten keys per second. Latencies count from the scheduled time of a key, even if a late
/// picture delays the key.
asio::awaitable<void> typing(CoroutineGroup& group, Endpoint server, int number, double seconds, Latencies& latencies) {
    Client client(group.io, server);
    co_await client.open(helloFor("geometry"), true);
    asio::steady_timer timer(group.io);
    auto due = Clock::now() + std::chrono::milliseconds(500 + number * 37 % 100);
    for (int i = 0; i < int(seconds * 10); ++i, due += std::chrono::milliseconds(100)) {
        timer.expires_at(due);
        co_await timer.async_wait(use_awaitable);
        co_await client.key('r');
        latencies.push_back(since(due));
    }
    co_await client.close();
}

asio::awaitable<void> flooding(CoroutineGroup& group, Endpoint server, std::string stream, int keys) {
    Client client(group.io, server);
    co_await client.open(helloFor(stream), true);
    const std::uint64_t before = client.pictures();
    const auto start = Clock::now();
    for (int i = 0; i < keys; ++i) co_await client.send(R"({"type":"key","key":"y"})");
    const double sent = since(start);
    co_await client.picture(static_cast<std::uint64_t>(keys));
    say("flood of " + std::to_string(keys) + " keys, " + stream,
        text(R"("pictures":%llu,"sent":%.1f,"seen":%.1f)", static_cast<unsigned long long>(client.pictures() - before),
             1e3 * sent, 1e3 * since(start)));
    co_await client.close();
}

/// Sends many requests but never reads, until the server drops the client.
asio::awaitable<void> neverReading(CoroutineGroup& group, Endpoint server, double seconds) {
    Client client(group.io, server);
    co_await client.open(helloFor("frames"), false);
    co_await client.send(setPolytope("600-cell"));
    for (int i = 0; i < 50; ++i) co_await client.send(R"({"type":"get","what":"slices"})");
    asio::steady_timer timer(group.io,
                             std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds)));
    co_await timer.async_wait(use_awaitable);
}

asio::awaitable<void> memory(CoroutineGroup& group, Endpoint server, double& megabytes) {
    constexpr const char* kName = "\nprocess_resident_memory_bytes ";
    const std::string text = co_await load::get(group.io, server, "/metrics");
    const std::size_t at = text.find(kName);
    megabytes = at == std::string::npos ? 0 : std::atof(text.c_str() + at + std::string(kName).size()) / 1e6;
}

asio::awaitable<void> opening(Client& client) { co_await client.open(helloFor("geometry"), true); }

double memoryOf(CoroutineGroup& group, Endpoint server) {
    double megabytes = 0;
    group.spawn(memory(group, server, megabytes));
    group.run();
    return megabytes;
}

void pressKeys(Endpoint server, const std::string& what, const std::string& hello, const std::string& polytope,
               double seconds) {
    CoroutineGroup group;
    Latencies latencies;
    group.spawn(pressing(group, server, hello, polytope, seconds, latencies));
    group.run();
    row(what, latencies);
}

void pointAtPicture(Endpoint server, const std::string& polytope) {
    constexpr int kPoints = 500;
    CoroutineGroup group;
    Latencies latencies;
    group.spawn(pointing(group, server, polytope, kPoints, latencies));
    group.run();
    row("pointing at frames, " + polytope, latencies);
}

void manySessions(Endpoint server, int count, double seconds) {
    CoroutineGroup group;
    std::vector<Latencies> each(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) group.spawn(typing(group, server, i, seconds, each[static_cast<std::size_t>(i)]));
    group.run();
    Latencies all;
    for (const Latencies& latencies : each) all.insert(all.end(), latencies.begin(), latencies.end());
    row(std::to_string(count) + " sessions at 10 keys/s, slices of the 5-cell", all);
}

void besideOneThatNeverReads(Endpoint server, double seconds) {
    CoroutineGroup group;
    Latencies latencies;
    group.spawn(neverReading(group, server, seconds));
    group.spawn(pressing(group, server, helloFor("geometry"), "5-cell", seconds, latencies));
    group.run();
    row("slices of the 5-cell, beside a client that never reads", latencies);
}

/// Measures a session with the 5-cell beside other sessions with a large polytope. All are as fast as possible.
void besideLargeOnes(Endpoint server, const std::string& stream, int others, double seconds) {
    CoroutineGroup group;
    Latencies latencies;
    std::vector<Latencies> large(static_cast<std::size_t>(others));
    for (Latencies& each : large)
        group.spawn(pressing(group, server, helloFor(stream), "omnitruncated 120-cell", seconds + 1, each));
    group.spawn(pressing(group, server, helloFor(stream), "5-cell", seconds, latencies));
    group.run();
    row(stream + " of the 5-cell, beside " + std::to_string(others) + " of the omnitruncated 120-cell", latencies);
    Latencies all;
    for (const Latencies& each : large) all.insert(all.end(), each.begin(), each.end());
    row("those " + std::to_string(others) + ", " + stream, all);
}

/// Measures many sessions at the same time, each as fast as possible.
void allAtOnce(Endpoint server, const std::string& polytope, int count, double seconds) {
    CoroutineGroup group;
    std::vector<Latencies> each(static_cast<std::size_t>(count));
    for (Latencies& latencies : each)
        group.spawn(pressing(group, server, helloFor("frames"), polytope, seconds, latencies));
    group.run();
    Latencies all;
    for (const Latencies& latencies : each) all.insert(all.end(), latencies.begin(), latencies.end());
    const std::string what = "frames of the " + polytope + ", " + std::to_string(count) + " sessions at once";
    say(what + ", all together", text(R"("rate":%.1f)", static_cast<double>(all.size()) / seconds));
    row(what, all);
}

void idle(Endpoint server, int count) {
    CoroutineGroup group;
    const double before = memoryOf(group, server);
    std::vector<std::unique_ptr<Client>> clients;
    for (int i = 0; i < count; ++i) {
        clients.push_back(std::make_unique<Client>(group.io, server));
        group.spawn(opening(*clients.back()));
        if (i % 50 == 49) group.run();
    }
    group.run();
    const double with = memoryOf(group, server);
    say(std::to_string(count) + " idle sessions", text(R"("before":%.1f,"more":%.1f)", before, with - before));
}

}  // namespace

int main(int argc, char** argv) {
    const auto port = static_cast<std::uint16_t>(argc > 1 ? std::atoi(argv[1]) : 8080);
    const double seconds = argc > 2 ? std::atof(argv[2]) : 5;
    const Endpoint server(asio::ip::make_address("127.0.0.1"), port);
    const std::string cbor = R"({"type":"hello","stream":"geometry","encoding":"cbor"})";
    try {
        // This measurement comes first, because it is about the memory of a server that has just started.
        idle(server, 1000);
        for (const char* polytope : {"5-cell", "600-cell"}) {
            const std::string name = polytope;
            pressKeys(server, "key to frame, " + name, helloFor("frames"), name, seconds);
            pressKeys(server, "key to slices as JSON, " + name, helloFor("geometry"), name, seconds);
            pressKeys(server, "key to slices as CBOR, " + name, cbor, name, seconds);
        }
        for (const char* polytope : {"5-cell", "8-cell", "24-cell", "120-cell", "600-cell", "small stellated 120-cell",
                                     "great grand stellated 120-cell"})
            pointAtPicture(server, polytope);
        for (const char* polytope : {"5-cell", "600-cell"}) allAtOnce(server, polytope, 4, seconds);
        manySessions(server, 200, seconds);
        besideOneThatNeverReads(server, seconds);
        for (const char* stream : {"frames", "geometry"}) {
            besideLargeOnes(server, stream, 4, seconds);
            CoroutineGroup group;
            group.spawn(flooding(group, server, stream, 1000));
            group.run();
        }
        // By then, the sessions of departed clients have expired, and idle workers have freed their memory.
        std::this_thread::sleep_for(std::chrono::seconds(6));
        CoroutineGroup group;
        say("memory after all that", text(R"("after":%.1f)", memoryOf(group, server)));
    } catch (const std::exception& fault) {
        std::fprintf(stderr, "bench_load: %s\n", fault.what());
        return 1;
    }
}
