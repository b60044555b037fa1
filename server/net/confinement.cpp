#include "net/confinement.hpp"

namespace oval4d::net {

namespace {

using process::SandboxMode;

// The number of file descriptors that every child process may have: for the standard streams, the channel to the
// server, a descriptor that arrives over this channel, and descriptors that libraries keep open.
constexpr std::size_t kOwnFiles = 16;

/// Returns the memory limit, in bytes, of a rasterizer process, which draws pictures outside the server. If
/// `options.drawMemory` is 0, the limit is an upper bound of what pictures within the other limits need. Most of that
/// memory is never touched.
std::size_t rasterizerMemoryLimit(const ServerOptions& options) {
    if (options.drawMemory > 0) return options.drawMemory;
    // These constants are in bytes. kOwn is for llvmpipe (the software renderer) and the C library, with a heap for
    // each thread. kEachPixel covers sixteen buffers of four bytes. kEachSliceEdge covers an edge of the slices and the
    // shapes that are drawn for it; measurements gave at most 260 bytes.
    constexpr std::size_t kOwn = std::size_t{3} << 30U, kEachPixel = 64, kEachSliceEdge = 512;
    const auto pixels = static_cast<std::size_t>(options.frame.maxPixels);
    return kOwn + kEachPixel * pixels + kEachSliceEdge * options.picture.sliceEdges + options.polytopeCache;
}

bool filtersSystemCalls(const ServerOptions& options) {
    std::string why;
    return process::shouldSandbox(options.sandbox, why);
}

}  // namespace

std::vector<std::string> childEnvironment(const ServerOptions& options, std::size_t workers, std::string& warning) {
    std::string why;
    const bool sandboxed = process::shouldSandbox(options.sandbox, why);
    if (!sandboxed && options.sandbox == SandboxMode::automatic)
        warning = "the rasterizer and file reader processes are not in a sandbox reason=\"" + why + "\"";
    return {std::string("OVAL4D_SANDBOX=") + (sandboxed ? "required" : "off"),
            "OVAL4D_DRAW_MEMORY=" + std::to_string(rasterizerMemoryLimit(options)),
            "OVAL4D_LOAD_MEMORY=" + std::to_string(options.loadMemory), "OVAL4D_WORKERS=" + std::to_string(workers)};
}

process::Confinement rasterizerConfinement(const ServerOptions& options) {
    // Besides kOwnFiles, a rasterizer process needs one descriptor for each worker: the shared memory for the worker's
    // pictures.
    return {filtersSystemCalls(options), rasterizerMemoryLimit(options),
            kOwnFiles + static_cast<std::size_t>(options.workers)};
}

process::Confinement fileReaderConfinement(const ServerOptions& options) {
    return {filtersSystemCalls(options), options.loadMemory, kOwnFiles};
}

}  // namespace oval4d::net
