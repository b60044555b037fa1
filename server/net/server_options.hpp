#pragma once
// The options of the server, which the command line or environment variables set.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "export/export.hpp"
#include "net/clients.hpp"
#include "net/object_store.hpp"
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

/// The options of the server with their defaults. Sizes are in bytes unless noted.
struct ServerOptions {
    std::vector<std::string> hosts{"127.0.0.1", "::1"};  ///< addresses to listen on
    std::uint16_t port = 8080;                           ///< TCP port to listen on; 0: any free port
    std::string webRoot;                                 ///< folder of the built web client
    int workers = 0;                                     ///< threads that slice and draw; 0: one per processor
    int exportWorkers = 1;                               ///< threads that make exported files
    int loadWorkers = 2;                                 ///< threads that wait for the reading of files (see
                                                         ///< Services::loadWorkers)
    int ioThreads = 1;                                   ///< threads that read and write sockets
    std::string logLevel = "info";                       ///< least severe level to log, by its name in spdlog

    /// allowedHosts are host names that clients may use for the server; allowedOrigins are origins of foreign pages
    /// that may connect (see AccessControl). trustedProxies are networks of proxies whose X-Forwarded-For is trusted
    /// (see IpNetwork).
    std::vector<std::string> allowedHosts, allowedOrigins, trustedProxies;
    std::string token;  ///< secret that clients must send; empty: a random one, but none if all hosts are loopback
    bool open = false;  ///< require no token, even on addresses other than loopback; `token` must be empty then

    std::size_t maxLoadMessageBytes = 8U << 20U;    ///< maximum size of a `load` message or of an uploaded state
    std::size_t maxRequestBytes = 64U << 10U;       ///< maximum size of any other message
    std::size_t maxUpload = 256U << 20U;            ///< maximum size of an uploaded file
    int maxDepth = 32;                              ///< maximum nesting depth of the JSON of a message
    std::size_t maxUnsent = 1U << 20U;              ///< unsent bytes at which the server stops reading from a client
    std::size_t maxSessions = 10'000;               ///< maximum number of stored sessions
    std::size_t maxConnections = 4096;              ///< maximum number of open connections
    ClientLimits client;                            ///< limits of each client
    std::size_t maxBytes = 2U << 30U;               ///< maximum bytes held for all clients together (ByteBudget)
    std::size_t minReadRate = 32U << 10U;           ///< minimum bytes per second that a client must read or upload
    std::string spool;                              ///< folder for unread exports; empty: the system's temporary folder
    int maxRequestsPerSecond = 2000;                ///< maximum messages per second from one connection
    parallel::FairQueue::Limits jobs;               ///< maximum numbers of waiting jobs in each pool of workers
    pipeline::PictureSizeLimits frame;              ///< limits on the size of pictures
    pipeline::PictureWorkLimits picture;            ///< limits on the time and memory that a picture takes
    exports::ExportLimits file;                     ///< limits on exported files
    session::Limits session;                        ///< limits of each session
    std::string store = "memory";                   ///< location of the sessions: see store::StoreOptions::url
    std::size_t storeQuota = store::kDefaultQuota;  ///< maximum total bytes of the sessions in a file or in memory
    std::size_t keptUndo = 100;                     ///< maximum number of undo steps stored with a session
    std::string data;                               ///< folder of arrays that clients may open, or address of an
                                                    ///< object store with them; empty: none
    ObjectStoreLimits dataStore;                    ///< limits on requests to this object store
    std::size_t dataCache = 1024U << 20U;           ///< maximum total memory of the fields from this folder
    std::string fieldCacheFolder;  ///< folder of the field cache (see FieldCacheFiles); empty: /var/tmp
    std::size_t fieldCache = std::size_t{16} << 30U;  ///< maximum total size of the files in the field cache
    std::size_t polytopeCache = 64U << 20U;           ///< maximum total size of the polytopes that the cache keeps
    std::size_t criticalCache = 4U << 20U;            ///< maximum total size of cached critical values of w

    process::SandboxMode sandbox = process::SandboxMode::automatic;
    std::size_t drawMemory = 0;             ///< memory limit of a rasterizer process; 0: derived from other limits
    std::size_t loadMemory = 1024U << 20U;  ///< memory limit of a file reader process

    Seconds sessionExpiry{1800};  ///< time after which a session that no client has open is deleted
    Seconds storeTimeout{1};      ///< maximum time to wait for a reply of Redis
    Seconds drawTimeout{60};      ///< maximum time to draw a picture; a slower rasterizer process is killed
    Seconds loadTimeout{20};      ///< maximum time to read a file; a slower file reader process is killed
    Seconds shownTimeout{1};      ///< time after which a picture that was written to the socket counts as shown
    Seconds writeTimeout{10};     ///< time after which a client that reads nothing is dropped
    Seconds helloTimeout{10};     ///< time after which a new connection is closed if no request or hello arrives
    Seconds idleTimeout{30};      ///< time after which an HTTP connection is closed if no further request arrives
    Seconds pingInterval{30};     ///< time after which a silent client is pinged; it is dropped after twice this time
    Seconds stopTimeout{4};       ///< time that clients have to disconnect after a signal to stop
};

/// Adds the options of the server to `app`. Parsing a command line with `app` then writes the values to `options`. Each
/// option can also be set by an environment variable that begins with OVAL4D_.
void addOptions(CLI::App& app, ServerOptions& options);

/// Returns the limits that clients need to know as a JSON object, for the message `welcome`.
std::string limitsJson(const ServerOptions& options);

}  // namespace oval4d::net
