#pragma once

#include "parallel/fork_join.hpp"
#include "process/process_heap.hpp"
#include "process/sandbox.hpp"

namespace oval4d::raster {

/// The subcommand with which this program runs as a rasterizer process, which draws pictures for the server.
inline constexpr const char* kRasterizerCommand = "draw";

/// Runs a rasterizer process. Loads everything that drawing needs, confines the process to a sandbox, and draws the
/// pictures that the server requests over `socket`, until the server closes its end of the socket. If drawing fails,
/// sends the reason to the server. If no request comes for a while, frees memory and returns it to the operating system
/// through `heap`. Throws std::runtime_error if a draw request is damaged or arrives without the memory to draw into.
void serveRasterizer(int socket, const process::Confinement& confinement, parallel::ForkJoin& forkJoin,
                     process::ProcessHeap& heap);

}  // namespace oval4d::raster
