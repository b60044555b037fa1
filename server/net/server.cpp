#include "net/server.hpp"

#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <csignal>
#include <thread>
#include <utility>
#include <variant>

#include "geometry/catalogue.hpp"
#include "net/awaited.hpp"
#include "net/http_session.hpp"
#include "net/processors.hpp"
#include "net/readiness.hpp"
#include "picture/drawer.hpp"
#include "store/secret.hpp"

namespace oval4d::net {

namespace asio = boost::asio;
using asio::ip::tcp;
using namespace std::chrono_literals;

namespace {

constexpr std::size_t kTokenBytes = 20;

/// As many files as the system lets one process have: each connection is one.
void raiseFileLimit() {
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_NOFILE, &limit);
}

store::StoreOptions storeOptions(const Options& options) {
    return {options.store, std::chrono::duration_cast<store::Milliseconds>(options.sessionExpiry),
            std::chrono::duration_cast<store::Milliseconds>(options.storeTimeout)};
}

std::string addressFor(const tcp::endpoint& endpoint) {
    // Where it listens at all addresses, one that a browser on this machine can open.
    const bool all = endpoint.address().is_unspecified();
    const std::string address = all ? "localhost" : endpoint.address().to_string();
    const std::string host = endpoint.address().is_v6() && !all ? "[" + address + "]" : address;
    return "http://" + host + ":" + std::to_string(endpoint.port()) + "/";
}

class Server {
  public:
    explicit Server(Options options);
    void run();

  private:
    static tcp::acceptor bound(asio::io_context& io, const Options& options);
    std::string tokenNeeded() const;
    void drawingLost(const picture::Loss& loss);
    asio::awaitable<void> listen();
    asio::awaitable<void> stopOnSignal();

    Options options_;
    Registry registry_;  // before the context, for coroutines that end with it have their places here
    asio::io_context io_;
    tcp::acceptor acceptor_;
    Metrics metrics_;
    WebFiles files_;
    std::size_t workers_;
    Readiness readiness_;
    picture::Studio studio_;
    WorkerPool pool_, fileMakers_;
    Services services_;
    std::shared_ptr<Hub> hub_;
    std::string token_;
    Access access_;
    Routes routes_;
};

Server::Server(Options options)
    : options_(std::move(options)),
      acceptor_(bound(io_, options_)),
      files_(options_.webRoot),
      workers_(options_.workers > 0 ? static_cast<std::size_t>(options_.workers) : processors()),
      readiness_(workers_),
      studio_(processors(),
              {{options_.maxFill, options_.polytopeCache},
               options_.drawTimeout,
               [this](const picture::Loss& loss) { drawingLost(loss); }},
              [this] { return pool_.waiting() > 0; }),
      pool_(workers_,
            [this](picture::Painter& painter) {
                painter.limitFill(options_.maxFill);
                painter.leaveDrawingTo(std::make_unique<picture::Drawer>(studio_, pool_.stopToken()));
                readiness_.warmUp(painter);
            }),
      fileMakers_(static_cast<std::size_t>(options_.fileWorkers), [](picture::Painter&) {}),
      services_{options_, io_, pool_, fileMakers_, metrics_},
      hub_(std::make_shared<Hub>(services_, store::openStore(storeOptions(options_)))),
      token_(tokenNeeded()),
      access_(options_.allowedHosts, options_.allowedOrigins, token_,
              acceptor_.local_endpoint().address().is_loopback()),
      routes_(services_, files_, readiness_, *hub_) {}

tcp::acceptor Server::bound(asio::io_context& io, const Options& options) {
    const std::string port = std::to_string(options.port);
    try {
        const auto found = tcp::resolver(io).resolve(options.host, port, tcp::resolver::passive);
        return {asio::make_strand(io), found.begin()->endpoint()};
    } catch (const boost::system::system_error& fault) {
        throw std::runtime_error("cannot listen at " + options.host + ", port " + port + ": " + fault.code().message());
    }
}

/// Who can reach a loopback address is on this machine; anybody else has to know a secret.
std::string Server::tokenNeeded() const {
    if (options_.open || !options_.token.empty()) return options_.open ? std::string() : options_.token;
    return acceptor_.local_endpoint().address().is_loopback() ? std::string() : store::randomName(kTokenBytes);
}

void Server::drawingLost(const picture::Loss& loss) {
    (loss.hung ? metrics_.drawingHangs : metrics_.drawingDeaths).Increment();
    spdlog::error("a process that draws was lost how=\"{}\"", loss.how);
}

void Server::run() {
    const std::string query = token_.empty() ? "" : "?token=" + token_;
    spdlog::info("listening url={}{}", addressFor(acceptor_.local_endpoint()), query);
    asio::co_spawn(acceptor_.get_executor(), listen(), asio::detached);
    asio::co_spawn(acceptor_.get_executor(), stopOnSignal(), asio::detached);
    std::vector<std::thread> others;
    for (int i = 1; i < options_.ioThreads; ++i) others.emplace_back([this] { io_.run(); });
    io_.run();
    for (std::thread& thread : others) thread.join();
    pool_.stop();
    fileMakers_.stop();
    hub_->stop(options_.stopTimeout);
    spdlog::info("stopped");
}

asio::awaitable<void> Server::listen() {
    const Front front{services_, access_, routes_, hub_, registry_};
    for (;;) {
        tcp::socket socket(asio::make_strand(io_));
        const auto [fault] = co_await acceptor_.async_accept(socket, kQuietly);
        if (fault == asio::error::operation_aborted) co_return;
        if (fault) {
            // Out of files, most likely: it passes when a connection ends.
            spdlog::warn("cannot accept fault=\"{}\"", fault.message());
            asio::steady_timer pause(io_, 100ms);
            co_await pause.async_wait(kQuietly);
            continue;
        }
        const bool full = registry_.size() >= options_.maxConnections;
        const auto executor = socket.get_executor();
        asio::co_spawn(executor, serve(std::move(socket), front, full), asio::detached);
    }
}

asio::awaitable<void> Server::stopOnSignal() {
    asio::signal_set signals(acceptor_.get_executor(), SIGINT, SIGTERM);
    const auto [fault, number] = co_await signals.async_wait(kQuietly);
    spdlog::info("stopping signal={} connections={}", number, registry_.size());
    signals.clear();  // a second signal ends the program at once
    readiness_.stop();
    acceptor_.close();
    const auto limit = std::chrono::steady_clock::now() + steady(options_.stopTimeout);
    asio::steady_timer poll(acceptor_.get_executor());
    // What clients have seen is in the store before they are sent to other servers.
    auto saving = std::make_shared<std::monostate>();
    hub_->saveAll(saving);
    const std::weak_ptr<std::monostate> saved = std::exchange(saving, nullptr);
    do {
        poll.expires_after(2ms);
        co_await poll.async_wait(kQuietly);
    } while (!saved.expired() && std::chrono::steady_clock::now() < limit - steady(options_.stopTimeout) / 2);
    registry_.stopAll();
    while ((registry_.size() > 0 || hub_->open() > 0) && std::chrono::steady_clock::now() < limit) {
        poll.expires_after(10ms);
        co_await poll.async_wait(kQuietly);
    }
    if (registry_.size() > 0) spdlog::warn("clients left behind count={}", registry_.size());
    io_.stop();
}

}  // namespace

void runServer(Options options) {
    raiseFileLimit();
    std::signal(SIGPIPE, SIG_IGN);  // hiredis writes to sockets that may have closed
    std::signal(SIGCHLD, SIG_DFL);  // where it is ignored, the number of a process that has ended may be another's
    geometry::keepPolytopes(options.polytopeCache);
    Server(std::move(options)).run();
}

}  // namespace oval4d::net
