#pragma once
// The bounds of one file's work, as it is done.

#include <chrono>
#include <stop_token>
#include <string>
#include <utility>

#include "export/export.hpp"

namespace oval4d::exports {

/// Thrown inside this folder; `fileOf` returns the refusal.
struct Refused {
    Refusal refusal;
};

class Budget {
  public:
    Budget(const Limits& limits, std::stop_token stop)
        : limits_(limits), stop_(std::move(stop)), start_(std::chrono::steady_clock::now()) {}

    bool isOver() const { return stop_.stop_requested() || std::chrono::steady_clock::now() - start_ > limits_.time; }
    /// To be called often. Throws when the time is over.
    void checkTime() const {
        if (stop_.stop_requested())
            throw Refused{{Refusal::Cause::too_long, "the file was given up: the server stops"}};
        if (isOver()) {
            throw Refused{{Refusal::Cause::too_long, "the file takes more than the allowed " +
                                                         std::to_string(static_cast<int>(limits_.time.count())) +
                                                         " s to make; ask for the focus slice alone or for a solid"}};
        }
    }
    void checkTriangles(std::size_t count) const {
        if (count > limits_.triangles) {
            throw Refused{
                {Refusal::Cause::too_large, "the file would have about " + std::to_string(count) + " triangles, and " +
                                                std::to_string(limits_.triangles) +
                                                " are allowed; ask for the focus slice alone or for a solid"}};
        }
    }
    void checkBytes(std::size_t count) const {
        if (count > limits_.bytes) {
            throw Refused{{Refusal::Cause::too_large,
                           "the file would be longer than the allowed " + std::to_string(limits_.bytes) + " bytes"}};
        }
    }
    std::size_t triangles() const { return limits_.triangles; }

  private:
    const Limits limits_;
    const std::stop_token stop_;
    const std::chrono::steady_clock::time_point start_;
};

}  // namespace oval4d::exports
