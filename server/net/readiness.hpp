#pragma once
// The readiness of the server, as /readyz reports it.

#include <atomic>
#include <cstddef>

#include "pipeline/pipeline.hpp"

namespace oval4d::net {

/// The server is ready once every worker has drawn its first picture, so that shaders are compiled and the initial
/// polytope is built. Every function may be called from any thread.
class Readiness {
  public:
    explicit Readiness(std::size_t workers) : missing_(workers) {}

    /// Draws a first picture; the first job of each worker. If frames cannot be drawn at all, logs the error and marks
    /// the server broken: it never becomes ready, although it still serves geometry.
    void warmUp(pipeline::Pipeline& pipeline);

    bool ready() const { return missing_ == 0; }
    /// Marks the server as stopping: load balancers should send it no new clients.
    void stop() { stopping_ = true; }
    bool stopping() const { return stopping_; }
    /// Whether drawing a first picture failed, so that the server will never be ready.
    bool broken() const { return broken_; }

  private:
    std::atomic<std::size_t> missing_;
    std::atomic<bool> broken_ = false;
    std::atomic<bool> stopping_ = false;
};

}  // namespace oval4d::net
