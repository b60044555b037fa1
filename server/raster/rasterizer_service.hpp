#pragma once

#include "parallel/fork_join.hpp"
#include "process/heap.hpp"
#include "process/sandbox.hpp"

namespace oval4d::raster {

/// The subcommand of this program that runs it as a rasterizer process.
inline constexpr const char* kRasterizerCommand = "draw";

/// The main function of a rasterizer process: draws the pictures that are requested over `socket` until the other end
/// closes it. Confines the process to a sandbox as soon as everything that drawing needs is loaded.
void serveRasterizer(int socket, const process::Confinement& confinement, parallel::ForkJoin& forkJoin,
                     process::Heap& heap);

}  // namespace oval4d::raster
