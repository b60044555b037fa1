#pragma once

#include "parallel/fork_join.hpp"
#include "process/heap.hpp"
#include "process/sandbox.hpp"

namespace oval4d::raster {

/// The subcommand that runs the program as a rasterizer process.
inline constexpr const char* kRasterizerCommand = "draw";

/// The main function of a rasterizer process: draws the orders that arrive over `socket` until the other end closes it.
/// Sandboxes the process once everything that drawing needs is loaded.
void serveRasterizer(int socket, const process::Confinement& confinement, parallel::ForkJoin& forkJoin,
                     process::Heap& heap);

}  // namespace oval4d::raster
