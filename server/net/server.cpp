#include "net/server.hpp"

#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/strand.hpp>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <utility>
#include <variant>

#include "file_reading/file_reader_pool.hpp"
#include "net/confinement.hpp"
#include "net/coroutine_helpers.hpp"
#include "net/http/http_connection.hpp"
#include "net/pause.hpp"
#include "net/processor_count.hpp"
#include "net/readiness.hpp"
#include "polytopes/catalogue/polytope_cache.hpp"
#include "raster/worker_rasterizer.hpp"
#include "store/open_store.hpp"
#include "store/secret.hpp"
#include "text/percent_encoding.hpp"

namespace oval4d::net {

namespace asio = boost::asio;
using asio::ip::tcp;
using namespace std::chrono_literals;

namespace {

constexpr std::size_t kTokenBytes = 20;
constexpr auto kWorkerStopTimeout = 500ms;
// File reader processes end after this time without a file to read. Until then, a client that loads another file need
// not wait for a process to start.
constexpr Seconds kReaderIdleTimeout{10};

/// Raises the process's limit of open files to the maximum, because each connection uses a file descriptor.
void raiseFileLimit() {
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_NOFILE, &limit);
}

store::StoreOptions storeOptions(const ServerOptions& options) {
    return {options.store, std::chrono::duration_cast<store::Milliseconds>(options.sessionExpiry),
            std::chrono::duration_cast<store::Milliseconds>(options.storeTimeout), options.storeQuota};
}

/// Returns the URL of the server at this endpoint. If the endpoint's address stands for all interfaces, the host in the
/// URL is localhost, which a browser on this machine can open.
std::string urlFor(const tcp::endpoint& endpoint) {
    const bool all = endpoint.address().is_unspecified();
    const std::string address = all ? "localhost" : endpoint.address().to_string();
    const std::string host = endpoint.address().is_v6() && !all ? "[" + address + "]" : address;
    return "http://" + host + ":" + std::to_string(endpoint.port()) + "/";
}

tcp::acceptor bindAcceptor(asio::io_context& io, const tcp::endpoint& endpoint) {
    tcp::acceptor acceptor(asio::make_strand(io));
    acceptor.open(endpoint.protocol());
    acceptor.set_option(asio::socket_base::reuse_address(true));
    // The socket of a specific IPv6 address accepts no IPv4 connections, whatever the system's setting bindv6only is.
    if (endpoint.address().is_v6() && !endpoint.address().is_unspecified())
        acceptor.set_option(asio::ip::v6_only(true));
    acceptor.bind(endpoint);
    acceptor.listen();
    return acceptor;
}

/// Returns one acceptor for each address, all with the same port. Skips addresses that this machine does not have, such
/// as ::1 if IPv6 is off. Throws std::runtime_error if no address is left, or if an address cannot be used for any
/// other reason.
std::vector<tcp::acceptor> bindAcceptors(asio::io_context& io, const ServerOptions& options) {
    constexpr int kAttempts = 20;  // attempts to find a port that is free at every address, if options.port is 0
    for (int attempt = 1;; ++attempt) {
        std::vector<tcp::acceptor> acceptors;
        std::uint16_t port = options.port;
        bool taken = false;
        std::string failure;
        for (const std::string& host : options.hosts) {
            try {
                for (const auto& found :
                     tcp::resolver(io).resolve(host, std::to_string(port), tcp::resolver::passive)) {
                    acceptors.push_back(bindAcceptor(io, {found.endpoint().address(), port}));
                    port = acceptors.back().local_endpoint().port();
                }
            } catch (const boost::system::system_error& fault) {
                const auto code = fault.code();
                const bool absent = code == asio::error::address_family_not_supported ||
                                    code == boost::system::errc::address_not_available;
                taken = code == asio::error::address_in_use && options.port == 0 && !acceptors.empty();
                failure = "cannot listen on " + host + ", port " + std::to_string(port) + ": " + code.message();
                if (taken) break;
                if (!absent) throw std::runtime_error(failure);
            }
        }
        if (taken && attempt < kAttempts) continue;
        if (acceptors.empty() || taken) throw std::runtime_error(failure);
        return acceptors;
    }
}

/// The server. It owns all services, and runs them until a signal stops it.
class Server {
  public:
    Server(ServerOptions options, parallel::ForkJoin& forkJoin, process::ProcessHeap& heap);
    void run();

  private:
    bool listensOnlyOnLoopback() const;
    std::string requiredToken() const;
    void onRasterizerLost(const process::ProcessLoss& loss);
    void onReaderLost(const process::ProcessLoss& loss);
    asio::awaitable<void> acceptConnections(tcp::acceptor& acceptor);
    asio::awaitable<void> stopOnSignal();
    void stopWorkers();

    ServerOptions options_;
    ClientAccounts clients_;
    FieldCacheFiles fieldCacheFiles_;  // outlives all fields; declared before io_, whose handlers may hold fields
    ConnectionRegistry connections_;   // outlives all registrations; declared before io_, whose coroutines own them
    SystemTimerClock clock_;           // outlives all timers; declared before io_, whose handlers own timers
    asio::io_context io_;
    std::vector<tcp::acceptor> acceptors_;
    Metrics metrics_;
    WebFiles files_;
    std::size_t workers_;
    std::string sandboxWarning_;
    std::vector<std::string> childEnvironment_;
    Readiness readiness_;
    raster::SharedRasterizerProcess sharedRasterizer_;
    file_reading::FileReaderPool readers_;
    polytopes::PolytopeCache polytopes_;
    DataFolder data_;
    slicing::CriticalSectionsCache critical_;
    pipeline::PipelinePool pictureWorkers_;
    parallel::WorkerPool exportWorkers_, loadWorkers_;
    Services services_;
    std::shared_ptr<SessionManager> sessions_;
    std::string token_;
    AccessControl access_;
    Routes routes_;
};

Server::Server(ServerOptions options, parallel::ForkJoin& forkJoin, process::ProcessHeap& heap)
    : options_(std::move(options)),
      clients_(options_.client, options_.trustedProxies, options_.maxBytes),
      fieldCacheFiles_(options_.fieldCacheFolder, options_.fieldCache),
      connections_(options_.maxConnections, options_.client.connections),
      acceptors_(bindAcceptors(io_, options_)),
      files_(options_.webRoot),
      workers_(options_.workers > 0 ? static_cast<std::size_t>(options_.workers) : usableProcessorCount()),
      childEnvironment_(childEnvironment(options_, workers_, sandboxWarning_)),
      readiness_(workers_),
      sharedRasterizer_(usableProcessorCount(),
                        {{options_.picture.fillSteps, options_.polytopeCache, options_.picture.occlusionSteps},
                         options_.drawTimeout,
                         [this](const process::ProcessLoss& loss) { onRasterizerLost(loss); },
                         childEnvironment_},
                        [this] { return pictureWorkers_.workers().hasStartableJob(); }),
      readers_({options_.loadTimeout, kReaderIdleTimeout,
                [this](const process::ProcessLoss& loss) { onReaderLost(loss); }, childEnvironment_,
                static_cast<std::size_t>(options_.loadWorkers)}),
      polytopes_(options_.polytopeCache),
      data_(options_.data, options_.dataCache, fieldCacheFiles_, options_.dataStore),
      critical_(options_.criticalCache),
      pictureWorkers_(
          {.threads = workers_,
           .limits = options_.jobs,
           .pictures = options_.picture,
           .makeRasterizer =
               [this](std::stop_token stop) {
                   return std::make_unique<raster::WorkerRasterizer>(sharedRasterizer_, std::move(stop));
               },
           .onThreadStart = [this](pipeline::Pipeline& pipeline) { readiness_.warmUpOrMarkBroken(pipeline); }},
          forkJoin, heap),
      exportWorkers_({.threads = static_cast<std::size_t>(options_.exportWorkers),
                      .limits = options_.jobs,
                      .whenIdle = [&heap](std::size_t /*worker*/) { heap.returnFreeMemory(); }}),
      loadWorkers_({.threads = static_cast<std::size_t>(options_.loadWorkers),
                    .limits = options_.jobs,
                    .whenIdle = [&heap](std::size_t /*worker*/) { heap.returnFreeMemory(); }}),
      services_{options_, io_,        pictureWorkers_, exportWorkers_,   metrics_,  clients_, loadWorkers_,
                readers_, polytopes_, data_,           fieldCacheFiles_, critical_, clock_},
      sessions_(std::make_shared<SessionManager>(services_, store::openStore(storeOptions(options_)))),
      token_(requiredToken()),
      access_(options_.allowedHosts, options_.allowedOrigins, token_, listensOnlyOnLoopback()),
      routes_(services_, files_, readiness_, *sessions_) {}

bool Server::listensOnlyOnLoopback() const {
    return std::ranges::all_of(acceptors_,
                               [](const tcp::acceptor& each) { return each.local_endpoint().address().is_loopback(); });
}

/// Returns the token that clients must send: the configured token or, without one, a random token. Returns an empty
/// string if no token is configured, and either `open` is set or the server listens only on loopback addresses.
std::string Server::requiredToken() const {
    if (!options_.token.empty()) return options_.token;
    return options_.open || listensOnlyOnLoopback() ? std::string() : store::randomName(kTokenBytes);
}

void Server::onRasterizerLost(const process::ProcessLoss& loss) {
    (loss.hung ? metrics_.rasterizerHangs : metrics_.rasterizerDeaths).Increment();
    spdlog::error("a rasterizer process was lost how=\"{}\"", loss.description);
}

void Server::onReaderLost(const process::ProcessLoss& loss) {
    (loss.hung ? metrics_.fileReaderHangs : metrics_.fileReaderDeaths).Increment();
    spdlog::error("a reader process was lost how=\"{}\"", loss.description);
}

void Server::run() {
    const std::string query = token_.empty() ? "" : "?token=" + text::percentEncoded(token_);
    for (tcp::acceptor& acceptor : acceptors_) {
        spdlog::info("listening url={}{}", urlFor(acceptor.local_endpoint()), query);
        asio::co_spawn(acceptor.get_executor(), acceptConnections(acceptor), asio::detached);
    }
    if (!sandboxWarning_.empty()) spdlog::warn(sandboxWarning_);
    asio::co_spawn(acceptors_.front().get_executor(), stopOnSignal(), asio::detached);
    std::vector<std::thread> others;
    for (int i = 1; i < options_.ioThreads; ++i) others.emplace_back([this] { io_.run(); });
    io_.run();
    for (std::thread& thread : others) thread.join();
    sessions_->stop(options_.stopTimeout);
    stopWorkers();
    spdlog::info("stopped");
}

/// Stops the workers. Some jobs cannot be interrupted. If one still runs after kWorkerStopTimeout, ends the program at
/// once. Nothing is lost: no client waits for the job anymore, and the sessions have been written.
void Server::stopWorkers() {
    std::atomic_bool ended = false;
    std::thread watchdog([&ended] {
        const auto limit = std::chrono::steady_clock::now() + kWorkerStopTimeout;
        while (!ended && std::chrono::steady_clock::now() < limit) std::this_thread::sleep_for(1ms);
        if (ended) return;
        spdlog::warn("stopped while a worker was still busy");
        spdlog::shutdown();
        std::_Exit(0);
    });
    pictureWorkers_.workers().stop();
    exportWorkers_.stop();
    loadWorkers_.stop();
    ended = true;
    watchdog.join();
}

asio::awaitable<void> Server::acceptConnections(tcp::acceptor& acceptor) {
    const ServerContext context{services_, access_, routes_, sessions_, connections_};
    for (;;) {
        tcp::socket socket(asio::make_strand(io_));
        const auto [fault] = co_await acceptor.async_accept(socket, kAsTuple);
        if (fault == asio::error::operation_aborted) co_return;
        if (fault) {
            // Most likely, no file descriptor is free. One becomes free when a connection ends, so the loop waits and
            // tries again.
            spdlog::warn("cannot accept fault=\"{}\"", fault.message());
            co_await pauseFor(clock_, acceptor.get_executor(), 100ms);
            continue;
        }
        const auto executor = socket.get_executor();
        asio::co_spawn(executor, serveHttp(std::move(socket), context), asio::detached);
    }
}

asio::awaitable<void> Server::stopOnSignal() {
    const auto executor = acceptors_.front().get_executor();
    asio::signal_set signals(executor, SIGINT, SIGTERM, SIGHUP);
    const auto [fault, number] = co_await signals.async_wait(kAsTuple);
    spdlog::info("stopping signal={} connections={}", number, connections_.size());
    signals.clear();  // a second signal ends the program at once
    readiness_.markStopping();
    for (tcp::acceptor& acceptor : acceptors_) asio::post(acceptor.get_executor(), [&acceptor] { acceptor.close(); });
    const auto limit = clock_.now() + toSteadyDuration(options_.stopTimeout);
    // All sessions are saved before clients reconnect to other servers, so that those servers have the latest changes.
    auto saving = std::make_shared<std::monostate>();
    sessions_->saveAll(saving);
    const std::weak_ptr<std::monostate> saved = std::exchange(saving, nullptr);
    do {
        co_await pauseFor(clock_, executor, 2ms);
    } while (!saved.expired() && clock_.now() < limit - toSteadyDuration(options_.stopTimeout) / 2);
    connections_.stopAll();
    while ((connections_.size() > 0 || sessions_->openSessionCount() > 0) && clock_.now() < limit) {
        co_await pauseFor(clock_, executor, 10ms);
    }
    if (connections_.size() > 0) spdlog::warn("clients still connected at shutdown count={}", connections_.size());
    io_.stop();
}

}  // namespace

void runServer(ServerOptions options, parallel::ForkJoin& forkJoin, process::ProcessHeap& heap) {
    if (options.open && !options.token.empty())
        throw std::invalid_argument(
            "--open (OVAL4D_OPEN) lets everyone in without a token, so --token (OVAL4D_TOKEN) would protect nothing; "
            "set only one of them");
    raiseFileLimit();
    std::signal(SIGPIPE, SIG_IGN);  // otherwise, a write by hiredis to a closed socket ends this process
    std::signal(SIGXFSZ, SIG_IGN);  // a write beyond the file size limit then fails instead of ending this process
    std::signal(SIGCHLD, SIG_DFL);  // if ignored, the ids of ended children could be reused before waitpid()
    Server(std::move(options), forkJoin, heap).run();
}

}  // namespace oval4d::net
