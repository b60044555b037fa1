#pragma once
// What the operator decides.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "export/export.hpp"
#include "picture/frame_limits.hpp"
#include "picture/painter.hpp"
#include "session/session.hpp"

namespace CLI {
class App;
}

namespace oval4d::net {

using Seconds = std::chrono::duration<double>;

struct Options {
    std::string host = "127.0.0.1";
    std::uint16_t port = 8080;  ///< 0: any free one
    std::string webRoot;        ///< the folder of the built page
    int workers = 0;            ///< 0: one a core
    int fileWorkers = 1;        ///< threads that make files
    int ioThreads = 1;
    std::string logLevel = "info";

    std::vector<std::string> allowedHosts, allowedOrigins;
    std::string token;
    bool open = false;  ///< no token, wherever it listens

    std::size_t maxMessage = 8U << 20U;  ///< bytes
    int maxDepth = 32;                   ///< of JSON
    std::size_t maxUnsent = 1U << 20U;   ///< bytes of answers waiting for a client before no more is read from it
    std::size_t maxSessions = 10'000;
    std::size_t maxConnections = 4096;
    int maxRequests = 2000;  ///< a second and connection
    picture::FrameLimits frame;
    std::size_t maxFill = picture::Painter::kFillSteps;
    exports::Limits file;
    session::Limits session;
    std::string store = "memory";            ///< as store::StoreOptions::place has it
    std::size_t keptUndo = 100;              ///< steps of a session's history that a store keeps
    std::size_t polytopeCache = 64U << 20U;  ///< bytes of polytopes kept without being in use

    Seconds sessionExpiry{1800};
    Seconds storeTimeout{1};
    Seconds drawTimeout{60};
    Seconds shownTimeout{1};
    Seconds writeTimeout{10};
    Seconds pingInterval{30};
    Seconds stopTimeout{4};
};

/// Adds every option to `app`, each also as an environment variable OVAL4D_….
void addOptions(CLI::App& app, Options& options);

/// The limits that a client should know, as the JSON object text that `welcome` carries.
std::string limitsText(const Options& options);

}  // namespace oval4d::net
