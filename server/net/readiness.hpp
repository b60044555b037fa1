#pragma once
// The readiness of the server, which the path /readyz reports.

#include <atomic>
#include <cstddef>

#include "pipeline/pipeline.hpp"

namespace oval4d::net {

/// Tracks whether the server is ready. It is ready when every picture worker has drawn its first picture. This picture
/// is slow, because the worker compiles its shaders and builds the initial polytope. The server stays ready until it
/// begins to stop. Thread-safe.
class Readiness {
  public:
    explicit Readiness(std::size_t workers) : missing_(workers) {}

    /// Draws the first picture of a worker. Each worker must call this function once, with its own pipeline, before
    /// other jobs. If the picture cannot be drawn, logs the error and marks the server as broken. A broken server never
    /// becomes ready, but still sends slices that clients draw.
    void warmUpOrMarkBroken(pipeline::Pipeline& pipeline);

    /// Returns whether every worker has drawn its first picture and the server is not stopping.
    bool ready() const { return missing_ == 0 && !stopping_; }
    /// Marks the server as stopping. /readyz then tells load balancers to send no new clients.
    void markStopping() { stopping_ = true; }
    bool stopping() const { return stopping_; }
    /// Returns whether a worker failed to draw its first picture. The server then never becomes ready.
    bool isBroken() const { return broken_; }

  private:
    std::atomic<std::size_t> missing_;  // number of workers that have not drawn their first picture
    std::atomic<bool> broken_ = false;
    std::atomic<bool> stopping_ = false;
};

}  // namespace oval4d::net
