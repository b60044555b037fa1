#pragma once
// Whether the server can do its work at full speed.

#include <atomic>
#include <cstddef>

#include "picture/painter.hpp"

namespace oval4d::net {

/// Ready once every worker has drawn its first picture, with shaders compiled and polytopes built.
class Readiness {
  public:
    explicit Readiness(std::size_t workers) : missing_(workers) {}

    /// The first job of a worker. Where frames cannot be drawn at all, that is logged, and the server is never ready,
    /// though it serves geometry.
    void warmUp(picture::Painter& painter);

    bool ready() const { return missing_ == 0; }
    /// From now on the server wants no new clients.
    void stop() { stopping_ = true; }
    bool stopping() const { return stopping_; }
    /// Frames cannot be drawn, now or later.
    bool broken() const { return broken_; }

  private:
    std::atomic<std::size_t> missing_;
    std::atomic<bool> broken_ = false;
    std::atomic<bool> stopping_ = false;
};

}  // namespace oval4d::net
