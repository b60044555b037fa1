#pragma once
// The options of the server.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "export/export.hpp"
#include "net/clients.hpp"
#include "parallel/fair_queue.hpp"
#include "pipeline/frame_limits.hpp"
#include "pipeline/pipeline.hpp"
#include "process/sandbox.hpp"
#include "session/session.hpp"
#include "store/store.hpp"

namespace CLI {
class App;
}

namespace oval4d::net {

using Seconds = std::chrono::duration<double>;

/// The options of the server, with their defaults. Sizes are in bytes unless noted.
struct Options {
    std::vector<std::string> hosts{"127.0.0.1", "::1"};  ///< addresses to listen on
    std::uint16_t port = 8080;                           ///< 0: any free port
    std::string webRoot;                                 ///< folder of the built web client
    int workers = 0;                                     ///< threads that slice and draw; 0: one per processor
    int fileWorkers = 1;                                 ///< threads that make files
    int loadWorkers = 2;                                 ///< processes that read files concurrently
    int ioThreads = 1;
    std::string logLevel = "info";

    std::vector<std::string> allowedHosts, allowedOrigins, trustedProxies;
    std::string token;
    bool open = false;  ///< require no token, on any address

    std::size_t maxMessage = 8U << 20U;        ///< largest `load` message
    std::size_t maxRequestBytes = 64U << 10U;  ///< largest message of any other type
    int maxDepth = 32;                         ///< deepest nesting of JSON
    std::size_t maxUnsent = 1U << 20U;         ///< unsent bytes at which the server stops reading from a client
    std::size_t maxSessions = 10'000;
    std::size_t maxConnections = 4096;
    ClientLimits client;
    std::size_t maxBytes = 2U << 30U;      ///< held for all clients together (ByteBudget)
    std::size_t minReadRate = 32U << 10U;  ///< bytes per second that a client must read, at least
    std::string spool;                     ///< folder for unread files; empty: the system's temporary folder
    int maxRequests = 2000;                ///< per second and connection
    parallel::FairQueue::Limits jobs;
    pipeline::FrameLimits frame;
    std::size_t maxFill = pipeline::Pipeline::kFillSteps;
    exports::Limits file;
    session::Limits session;
    std::string store = "memory";                   ///< the location, as in store::StoreOptions::url
    std::size_t storeQuota = store::kDefaultQuota;  ///< largest total size of the sessions in a file or in memory
    std::size_t keptUndo = 100;                     ///< undo steps of a session that the store keeps
    std::size_t polytopeCache = 64U << 20U;         ///< largest total size of cached polytopes not in use

    process::SandboxMode sandbox = process::SandboxMode::automatic;
    std::size_t drawMemory = 0;             ///< memory limit of a rasterizer process; 0: derived from `frame`
    std::size_t loadMemory = 1024U << 20U;  ///< memory limit of a reader process

    Seconds sessionExpiry{1800};
    Seconds storeTimeout{1};
    Seconds drawTimeout{60};
    Seconds loadTimeout{20};
    Seconds shownTimeout{1};
    Seconds writeTimeout{10};
    Seconds helloTimeout{10};
    Seconds idleTimeout{30};
    Seconds pingInterval{30};
    Seconds stopTimeout{4};
};

/// Adds every option to `app`; each can also be set by an environment variable OVAL4D_….
void addOptions(CLI::App& app, Options& options);

/// The limits that clients need to know, as the text of the JSON object in `welcome`.
std::string limitsText(const Options& options);

}  // namespace oval4d::net
