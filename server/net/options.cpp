#include "net/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <map>
#include <nlohmann/json.hpp>

namespace oval4d::net {

namespace {

/// "--max-message" → "OVAL4D_MAX_MESSAGE"
std::string variableFor(const std::string& option) {
    std::string name = "OVAL4D_" + option.substr(2);
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return c == '-' ? '_' : std::toupper(c); });
    return name;
}

template <typename T>
CLI::Option* add(CLI::App& app, const std::string& name, T& value, const std::string& help) {
    return app.add_option(name, value, help)->envname(variableFor(name))->capture_default_str();
}

/// Durations are given in seconds; fractions are allowed.
void addSeconds(CLI::App& app, const std::string& name, Seconds& value, const std::string& help) {
    app.add_option_function<double>(
           name, [&value](double given) { value = Seconds(given); }, help)
        ->envname(variableFor(name))
        ->default_str(CLI::detail::to_string(value.count()))
        ->type_name("SECONDS")
        ->check(CLI::Range(0.001, 1e9));
}

/// A power of 1024 may follow: 512k, 8M.
void addBytes(CLI::App& app, const std::string& name, std::size_t& value, const std::string& help) {
    add(app, name, value, help)->transform(CLI::AsSizeValue(false))->type_name("BYTES");
}

void addPlace(CLI::App& app, Options& options) {
    add(app, "--host", options.host, "Address to listen at; any but a loopback address asks clients for a token");
    add(app, "--port", options.port, "TCP port; 0 for any free one, which the first line of the log names");
    add(app, "--web-root", options.webRoot, "Folder of the built page");
    add(app, "--workers", options.workers,
        "Threads that slice and draw; 0 for one a processor, within the CPU quota of the container")
        ->check(CLI::Range(0, 1024));
    add(app, "--file-workers", options.fileWorkers, "Threads that make files; pictures do not wait for them")
        ->check(CLI::Range(1, 1024));
    add(app, "--io-threads", options.ioThreads, "Threads that read and write sockets")->check(CLI::Range(1, 64));
    add(app, "--log-level", options.logLevel, "How much is logged")
        ->check(CLI::IsMember({"trace", "debug", "info", "warning", "error", "critical", "off"}));
}

void addAccess(CLI::App& app, Options& options) {
    add(app, "--allow-host", options.allowedHosts,
        "Host name by which clients may call the server, * for any; may be repeated. "
        "Without it: the loopback names on a loopback address, else any")
        ->delimiter(',');
    add(app, "--allow-origin", options.allowedOrigins,
        "Origin (https://example.org) of a foreign page that may connect, * for any; may be repeated. "
        "The server's own page always may")
        ->delimiter(',');
    add(app, "--token", options.token,
        "Secret that clients must give: once as ?token=… in the page's address, or as a bearer token. "
        "Made up and printed where it is needed and not given");
    app.add_flag("--open", options.open, "Ask for no token, though the address is not a loopback one")
        ->envname("OVAL4D_OPEN");
}

void addStore(CLI::App& app, Options& options) {
    add(app, "--store", options.store,
        "Where sessions are kept: memory; sqlite:PATH, a file in which they outlive the server; or "
        "redis://[user:password@]host[:port][/database], by which other servers can go on with them");
    add(app, "--kept-undo", options.keptUndo, "Steps that can be undone in a session that was kept");
    addSeconds(app, "--store-timeout", options.storeTimeout,
               "A Redis that does not answer for this long counts as lost");
}

void addFileLimits(CLI::App& app, exports::Limits& limits) {
    add(app, "--max-file-triangles", limits.triangles, "Most triangles of a file")->check(CLI::Range(1, 1'000'000'000));
    addBytes(app, "--max-file-bytes", limits.bytes, "Longest file");
    addSeconds(app, "--max-file-time", limits.time, "A file that takes longer to make is given up");
}

void addLimits(CLI::App& app, Options& options) {
    const CLI::Range atLeastOne(1, 1'000'000'000);
    addBytes(app, "--max-message", options.maxMessage, "Longest message from a client; a longer one closes with 1009");
    add(app, "--max-depth", options.maxDepth, "Deepest nesting of a message's JSON")->check(atLeastOne);
    addBytes(app, "--max-unsent", options.maxUnsent,
             "Answers that may wait for a client to read them before the server stops reading from it");
    add(app, "--max-sessions", options.maxSessions, "Sessions kept at once")->check(atLeastOne);
    add(app, "--max-connections", options.maxConnections, "Connections open at once; a further one is told 503")
        ->check(atLeastOne);
    add(app, "--max-requests", options.maxRequests,
        "Messages a second from one connection; bursts of twice as many are let through")
        ->check(atLeastOne);
    add(app, "--min-side", options.frame.minSide, "Least width and height of a picture, in pixels")->check(atLeastOne);
    add(app, "--max-width", options.frame.maxWidth, "Greatest width of a picture, in pixels")
        ->check(CLI::Range(1, 16'384));
    add(app, "--max-height", options.frame.maxHeight, "Greatest height of a picture, in pixels")
        ->check(CLI::Range(1, 16'384));
    add(app, "--max-pixels", options.frame.maxPixels, "Most pixels of a picture")->check(atLeastOne);
    add(app, "--max-fill", options.maxFill,
        "Steps that a picture may take to fill faces whose sides cross: n² + n·k for n sides that cross at k places. "
        "Faces beyond are filled roughly")
        ->check(atLeastOne);
    addFileLimits(app, options.file);
    add(app, "--max-slices", options.session.maxSlices, "Most slices of a session")->check(CLI::Range(1, 100'001));
    add(app, "--max-undo", options.session.maxUndo, "Steps that can be undone in a session");
    add(app, "--max-loaded", options.session.maxLoaded, "Polytopes that can be loaded into a session");
    add(app, "--max-vertices", options.session.maxVertices,
        "Most vertices of a loaded polytope, or of one built by a name that the catalogue does not list");
    addBytes(app, "--polytope-cache", options.polytopeCache,
             "Memory for polytopes of the catalogue and of names, kept for when they are asked for again");
    add(app, "--max-hull-cells", options.session.maxHullCells, "Most cells of the hull of loaded points");
}

void addTimes(CLI::App& app, Options& options) {
    addSeconds(app, "--session-expiry", options.sessionExpiry,
               "A session that nobody has open is forgotten after this");
    addSeconds(app, "--draw-timeout", options.drawTimeout,
               "A process that takes longer to draw a picture is killed, and the picture drawn by another");
    addSeconds(app, "--shown-timeout", options.shownTimeout,
               "A picture sent counts as shown after this, though the client does not say so");
    addSeconds(app, "--write-timeout", options.writeTimeout, "A client that reads nothing for this long is dropped");
    addSeconds(app, "--ping-interval", options.pingInterval,
               "A silent client is pinged after this, and dropped after twice this");
    addSeconds(app, "--stop-timeout", options.stopTimeout, "On SIGINT or SIGTERM, clients have this long to leave");
}

}  // namespace

void addOptions(CLI::App& app, Options& options) {
    addPlace(app, options);
    addAccess(app, options);
    addStore(app, options);
    addLimits(app, options);
    addTimes(app, options);
}

std::string limitsText(const Options& options) {
    return nlohmann::json{{"message", options.maxMessage},
                          {"depth", options.maxDepth},
                          {"requests_per_second", options.maxRequests},
                          {"min_side", options.frame.minSide},
                          {"max_width", options.frame.maxWidth},
                          {"max_height", options.frame.maxHeight},
                          {"max_pixels", options.frame.maxPixels},
                          {"file_triangles", options.file.triangles},
                          {"file_bytes", options.file.bytes},
                          {"file_time", options.file.time.count()},
                          {"slices", options.session.maxSlices},
                          {"shown_timeout", options.shownTimeout.count()}}
        .dump();
}

}  // namespace oval4d::net
