#include "net/server_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "session/load.hpp"
#include "text/message_text.hpp"

namespace oval4d::net {

namespace {

constexpr std::size_t kMinQuota = std::size_t{1} << 20U;

/// Returns the name of the environment variable for an option: "OVAL4D_MAX_MESSAGE" for "--max-message".
std::string environmentVariableFor(const std::string& option) {
    std::string name = "OVAL4D_" + option.substr(2);
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return c == '-' ? '_' : std::toupper(c); });
    return name;
}

template <typename T>
CLI::Option* addOption(CLI::App& app, const std::string& name, T& value, const std::string& help) {
    return app.add_option(name, value, help)->envname(environmentVariableFor(name))->capture_default_str();
}

/// Adds an option for a duration in seconds; fractions are allowed.
void addSecondsOption(CLI::App& app, const std::string& name, Seconds& value, const std::string& help) {
    app.add_option_function<double>(
           name, [&value](double given) { value = Seconds(given); }, help)
        ->envname(environmentVariableFor(name))
        ->default_str(CLI::detail::to_string(value.count()))
        ->type_name("SECONDS")
        ->check(CLI::Range(0.001, 1e9));
}

/// Adds an option for a size in bytes. A suffix stands for a power of 1024, as in 512k or 8M.
CLI::Option* addBytesOption(CLI::App& app, const std::string& name, std::size_t& value, const std::string& help) {
    return addOption(app, name, value, help)->transform(CLI::AsSizeValue(false))->type_name("BYTES");
}

/// A validator for CLI11. Returns an error message if the text is not a network, else an empty string.
std::string checkNetwork(const std::string& text) {
    try {
        (void)IpNetwork(text);
        return {};
    } catch (const std::invalid_argument& fault) {
        return fault.what();
    }
}

void addServingOptions(CLI::App& app, ServerOptions& options) {
    addOption(
        app, "--host", options.hosts,
        "Address or name to listen on; may be repeated. With any address other than loopback, clients need a token")
        ->delimiter(',');
    addOption(app, "--port", options.port, "TCP port; 0 for any free port, which the first line of the log shows");
    addOption(app, "--web-root", options.webRoot, "Folder of the built web client");
    addOption(app, "--workers", options.workers,
              "Threads that slice and draw; 0 for one per processor, within the CPU quota of the container")
        ->check(CLI::Range(0, 1024));
    addOption(app, "--file-workers", options.exportWorkers,
              "Threads that make files, separate from those that make pictures")
        ->check(CLI::Range(1, 1024));
    addOption(app, "--load-workers", options.loadWorkers,
              "Files that are read concurrently, each by its own process; further ones are queued")
        ->check(CLI::Range(1, 1024));
    addOption(app, "--io-threads", options.ioThreads, "Threads that read and write sockets")->check(CLI::Range(1, 64));
    addOption(app, "--log-level", options.logLevel, "Least severe messages that are logged")
        ->check(CLI::IsMember({"trace", "debug", "info", "warning", "error", "critical", "off"}));
}

void addAccessOptions(CLI::App& app, ServerOptions& options) {
    addOption(app, "--allow-host", options.allowedHosts,
              "Host name that clients may use for the server, * for any; may be repeated. "
              "Default: the loopback names on a loopback address, otherwise any")
        ->delimiter(',');
    addOption(app, "--allow-origin", options.allowedOrigins,
              "Origin (https://example.org) of a foreign page that may connect, * for any; may be repeated. "
              "The server's own page may always connect")
        ->delimiter(',');
    addOption(app, "--trusted-proxy", options.trustedProxies,
              "Address or network (10.0.0.0/8) of a proxy whose X-Forwarded-For is trusted; may be repeated")
        ->delimiter(',')
        ->check(checkNetwork);
    addOption(app, "--token", options.token,
              "Secret that clients must send: once as ?token=… in the page's address, or as a bearer token. "
              "If one is required and none is given, a random one is printed at startup");
    app.add_flag("--open", options.open, "Require no token, even on addresses other than loopback; not with --token")
        ->envname("OVAL4D_OPEN");
}

void addStoreOptions(CLI::App& app, ServerOptions& options) {
    addOption(app, "--store", options.store,
              "Where sessions are stored: memory; sqlite:PATH, a file that outlives the server; or "
              "redis://[user:password@]host[:port][/database], from which other servers can resume them");
    addBytesOption(
        app, "--store-quota", options.storeQuota,
        "Total size of sessions in a file or in memory, at least 1M; beyond it, sessions that nobody has open are "
        "deleted: first those never changed, then those unused for the longest time")
        ->check(CLI::Range(kMinQuota, std::numeric_limits<std::size_t>::max()));
    addOption(app, "--kept-undo", options.keptUndo, "Undo steps that are stored with a session");
    addSecondsOption(app, "--store-timeout", options.storeTimeout,
                     "Redis counts as failed if it does not answer within this time");
}

void addDataFolderOptions(CLI::App& app, ServerOptions& options) {
    addOption(
        app, "--data", options.data,
        "Folder of arrays (" + text::commaSeparated(session::arrayFormatNames()) +
            ", zarr) that all clients may open; a folder in it is a series with one moment in each file. Or the "
            "address, http://… or https://…, of an object store with Zarr arrays, of which only the needed chunks are "
            "read");
    addBytesOption(
        app, "--data-cache", options.dataCache,
        "Memory for fields from the data folder, which sessions share; beyond it, those unused for the longest "
        "time are dropped, and a client must wait if sessions use all of it");
    addBytesOption(
        app, "--field-cache", options.fieldCache,
        "Disk space for fields from the data folder that are larger than --max-field-bytes and must be converted; "
        "beyond it, those unused for the longest time are dropped");
    addSecondsOption(app, "--data-connect-timeout", options.dataStore.connectTimeout,
                     "Maximum time to connect to the object store of --data");
    addSecondsOption(app, "--data-timeout", options.dataStore.timeout,
                     "Maximum time of one request to the object store of --data, including the connection");
    addBytesOption(app, "--max-data-object", options.dataStore.objectBytes,
                   "Maximum size of an object, or of a part of one, that is read from the object store of --data");
    addOption(app, "--field-cache-folder", options.fieldCacheFolder,
              "Folder for these fields, on a disk; if empty, /var/tmp is used");
}

void addExportLimitOptions(CLI::App& app, exports::ExportLimits& limits) {
    addOption(app, "--max-file-triangles", limits.triangles, "Maximum number of triangles in a file")
        ->check(CLI::Range(1, 1'000'000'000));
    addBytesOption(app, "--max-file-bytes", limits.bytes, "Maximum size of a file");
    addSecondsOption(app, "--max-file-time", limits.time, "Maximum time to make a file");
}

void addClientLimitOptions(CLI::App& app, ServerOptions& options) {
    const CLI::Range atLeastOne(1, 1'000'000'000);
    ClientLimits& client = options.client;
    addOption(app, "--max-client-connections", client.connections,
              "Maximum number of open connections from one address")
        ->check(atLeastOne);
    addOption(app, "--max-client-sessions", client.sessions,
              "Maximum number of stored sessions opened from one address")
        ->check(atLeastOne);
    addOption(app, "--max-new-sessions", client.newSessionsPerMinute,
              "Maximum number of sessions per minute opened from one address")
        ->check(atLeastOne);
    addOption(
        app, "--max-wrong-tokens", client.wrongTokensPerMinute,
        "Maximum number of wrong tokens per minute from one address; beyond it, the address is refused for a while")
        ->check(atLeastOne);
    addOption(app, "--max-client-requests", client.requestsPerSecond,
              "Messages and HTTP requests per second from one address; further ones are delayed")
        ->check(atLeastOne);
    addBytesOption(app, "--max-byte-rate", client.messageBytesPerSecond,
                   "Bytes of messages per second from one address; further ones are delayed");
    addBytesOption(app, "--max-bytes", options.maxBytes,
                   "Maximum bytes held for all clients: unread files and messages, and their own polytopes");
    addBytesOption(app, "--max-client-bytes", client.bytes, "Maximum bytes held for one address");
    addBytesOption(app, "--min-read-rate", options.minReadRate,
                   "Bytes per second that a client must read, or send of an upload, at least; a slower one is dropped");
    addOption(
        app, "--spool", options.spool,
        "Folder for responses that clients have not yet received; if empty, the system's temporary folder is used");
}

void addSandboxOptions(CLI::App& app, ServerOptions& options) {
    using process::SandboxMode;
    app.add_option(
           "--sandbox", options.sandbox,
           "Whether the processes that draw pictures and read files are sandboxed by a system call filter: auto, if "
           "the system supports it; off; or required, in which case the server does not start without it")
        ->envname("OVAL4D_SANDBOX")
        ->transform(CLI::CheckedTransformer(std::vector<std::pair<std::string, SandboxMode>>{
            {"auto", SandboxMode::automatic}, {"off", SandboxMode::off}, {"required", SandboxMode::required}}))
        ->default_str("auto");
    const CLI::Range enough(std::size_t{64} << 20U, std::size_t{1} << 50U);
    addBytesOption(
        app, "--draw-memory", options.drawMemory,
        "Maximum memory of a process that draws, in addition to what it starts with; 0 for a bound derived from the "
        "limits on pictures and polytopes");
    addBytesOption(app, "--load-memory", options.loadMemory,
                   "Maximum memory of a process that reads a file; at least 64M")
        ->check(enough);
}

void addLimitOptions(CLI::App& app, ServerOptions& options) {
    const CLI::Range atLeastOne(1, 1'000'000'000);
    addBytesOption(app, "--max-message", options.maxLoadMessageBytes,
                   "Maximum size of a `load` message; a larger one closes the connection with code 1009");
    addBytesOption(app, "--max-request-bytes", options.maxRequestBytes,
                   "Maximum size of any other message, and of any message before hello");
    addBytesOption(app, "--max-upload", options.maxUpload, "Maximum size of an uploaded file; 0 to refuse uploads");
    addBytesOption(app, "--max-field-bytes", options.session.maxFieldBytes,
                   "Maximum size of the samples of a field that is read from a file, four bytes each");
    addBytesOption(app, "--first-level-bytes", options.session.maxFirstLevelBytes,
                   "Maximum size of the level of a multiscale image in the data folder that is shown first; finer ones "
                   "follow, up to --max-field-bytes");
    addOption(app, "--max-depth", options.maxDepth, "Maximum nesting depth of the JSON of a message")
        ->check(atLeastOne);
    addBytesOption(app, "--max-unsent", options.maxUnsent,
                   "Unsent bytes of replies at which the server stops reading from a client");
    addOption(app, "--max-sessions", options.maxSessions, "Maximum number of stored sessions")->check(atLeastOne);
    addOption(app, "--max-connections", options.maxConnections,
              "Maximum number of open connections; further ones get status 503")
        ->check(atLeastOne);
    addOption(app, "--max-requests", options.maxRequestsPerSecond,
              "Messages per second from one connection; bursts of twice as many are allowed")
        ->check(atLeastOne);
    addOption(app, "--max-jobs", options.jobs.total,
              "Maximum number of pictures, and of files, that wait for a worker; further requests are refused, and the "
              "streams of sessions retry")
        ->check(atLeastOne);
    addOption(app, "--max-client-jobs", options.jobs.perClient,
              "Maximum number of these waiting jobs of one client (see --max-jobs)")
        ->check(atLeastOne);
    addOption(app, "--min-side", options.frame.minSide, "Minimum width and height of a picture, in pixels")
        ->check(atLeastOne);
    addOption(app, "--max-width", options.frame.maxWidth, "Maximum width of a picture, in pixels")
        ->check(CLI::Range(1, 16'384));
    addOption(app, "--max-height", options.frame.maxHeight, "Maximum height of a picture, in pixels")
        ->check(CLI::Range(1, 16'384));
    addOption(app, "--max-pixels", options.frame.maxPixels, "Maximum number of pixels of a picture")->check(atLeastOne);
    addOption(
        app, "--max-fill", options.picture.fillSteps,
        "Maximum number of steps to fill self-intersecting faces in one picture: at most 2 n² + n·k for a face of n "
        "sides with k crossings. Faces beyond the limit are filled approximately")
        ->check(atLeastOne);
    addOption(
        app, "--max-occlusion", options.picture.occlusionSteps,
        "Maximum number of steps to find what lies behind other cells in the projection of a polytope that is not "
        "convex or has hidden cells: comparisons of a part of an element with a cell or a triangle. Beyond the limit, "
        "only cells turned away from the 4-D eye are left out")
        ->check(atLeastOne);
    addOption(app, "--max-slice-edges", options.picture.sliceEdges,
              "Maximum number of edges of all slices of a picture or a file together")
        ->check(atLeastOne);
    addExportLimitOptions(app, options.file);
    addOption(app, "--max-slices", options.session.maxSlices, "Maximum number of slices of a session")
        ->check(CLI::Range(1, 100'001));
    addOption(app, "--max-undo", options.session.maxUndo, "Maximum number of undo steps of a session");
    addBytesOption(
        app, "--max-undo-bytes", options.session.maxUndoBytes,
        "Maximum bytes of polytopes that a session keeps only for undo; beyond it, the oldest steps are forgotten");
    addOption(app, "--max-loaded", options.session.maxLoaded, "Maximum number of polytopes loaded into a session");
    addOption(
        app, "--max-vertices", options.session.maxVertices,
        "Maximum number of vertices of a loaded polytope, or of one built from a name that the catalogue does not "
        "list");
    addBytesOption(app, "--polytope-cache", options.polytopeCache,
                   "Memory for cached polytopes, from the catalogue or built from names");
    addBytesOption(
        app, "--critical-cache", options.criticalCache,
        "Memory for cached results of searches for critical w; beyond it, those unused for the longest time are "
        "dropped");
    addOption(app, "--max-hull-cells", options.session.maxHullCells,
              "Maximum number of cells of the convex hull of loaded points");
}

void addTimeOptions(CLI::App& app, ServerOptions& options) {
    addSecondsOption(app, "--session-expiry", options.sessionExpiry,
                     "Time after which a session that nobody has open is deleted");
    addSecondsOption(
        app, "--draw-timeout", options.drawTimeout,
        "Maximum time to draw a picture; a process that takes longer is killed, and another one draws the picture");
    addSecondsOption(app, "--load-timeout", options.loadTimeout,
                     "Maximum time to read a file; a file that takes longer is refused");
    addSecondsOption(app, "--shown-timeout", options.shownTimeout,
                     "Time after which a sent picture counts as shown if the client does not acknowledge it");
    addSecondsOption(app, "--write-timeout", options.writeTimeout,
                     "Time after which a client that reads nothing is dropped");
    addSecondsOption(app, "--hello-timeout", options.helloTimeout,
                     "Time after which a new connection that sends no request, or no hello, is closed");
    addSecondsOption(app, "--idle-timeout", options.idleTimeout,
                     "Time after which an HTTP connection without a further request is closed");
    addSecondsOption(app, "--ping-interval", options.pingInterval,
                     "Time after which a silent client is pinged; after twice this time it is dropped");
    addSecondsOption(app, "--stop-timeout", options.stopTimeout,
                     "Time that clients have to disconnect after SIGINT, SIGTERM or SIGHUP");
}

}  // namespace

void addOptions(CLI::App& app, ServerOptions& options) {
    addServingOptions(app, options);
    addAccessOptions(app, options);
    addStoreOptions(app, options);
    addDataFolderOptions(app, options);
    addSandboxOptions(app, options);
    addLimitOptions(app, options);
    addClientLimitOptions(app, options);
    addTimeOptions(app, options);
}

std::string limitsJson(const ServerOptions& options) {
    return nlohmann::json{{"message", options.maxLoadMessageBytes},
                          {"request_bytes", options.maxRequestBytes},
                          {"upload", options.maxUpload},
                          {"field_bytes", options.session.maxFieldBytes},
                          {"depth", options.maxDepth},
                          {"requests_per_second", options.maxRequestsPerSecond},
                          {"min_side", options.frame.minSide},
                          {"max_width", options.frame.maxWidth},
                          {"max_height", options.frame.maxHeight},
                          {"max_pixels", options.frame.maxPixels},
                          {"slice_edges", options.picture.sliceEdges},
                          {"file_triangles", options.file.triangles},
                          {"file_bytes", options.file.bytes},
                          {"file_time", options.file.time.count()},
                          {"slices", options.session.maxSlices},
                          {"shown_timeout", options.shownTimeout.count()}}
        .dump();
}

}  // namespace oval4d::net
