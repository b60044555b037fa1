#pragma once
// Limits on the work for one file.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <utility>

namespace oval4d::exports {

/// The limits on the work for one file.
struct Limits {
    std::size_t triangles = 5'000'000;
    std::size_t bytes = 512U << 20U;
    std::chrono::duration<double> time{20};
    /// Returns whether this many bytes may be allocated in total; called as soon as the number is known. May be null.
    std::function<bool(std::size_t)> reserve = nullptr;
};

/// The reason why no file is made. `message` is for the user.
struct Refusal {
    enum class Cause : std::uint8_t {
        no_body,    ///< the slice is empty or flat, or the label does not fit
        too_large,  ///< beyond Limits::triangles or bytes
        too_long,   ///< beyond Limits::time, or stopped
        no_room,    ///< Limits::reserve returned false
    };
    Cause cause;
    std::string message;
};

/// The exception for a refusal inside this folder; `fileOf` catches it and returns the refusal.
struct Refused {
    Refusal refusal;
};

/// Checks the work for one file against its limits.
class Budget {
  public:
    Budget(const Limits& limits, std::stop_token stop)
        : limits_(limits), stop_(std::move(stop)), start_(std::chrono::steady_clock::now()) {}

    bool isOver() const { return stop_.stop_requested() || std::chrono::steady_clock::now() - start_ > limits_.time; }
    /// Throws Refused if the time is over or a stop is requested. To be called often.
    void checkTime() const {
        if (stop_.stop_requested())
            throw Refused{{Refusal::Cause::too_long, "the export was canceled because the server is stopping"}};
        if (isOver()) {
            throw Refused{{Refusal::Cause::too_long, "the export takes longer than the allowed " +
                                                         std::to_string(static_cast<int>(limits_.time.count())) +
                                                         " s; export only the focus slice, or a solid body"}};
        }
    }
    /// Throws Refused if the limits do not allow a mesh with this number of triangles.
    void checkTriangles(std::size_t count) const {
        if (count > limits_.triangles) {
            throw Refused{
                {Refusal::Cause::too_large, "the file would have about " + std::to_string(count) +
                                                " triangles; at most " + std::to_string(limits_.triangles) +
                                                " are allowed; export only the focus slice, or a solid body"}};
        }
        checkRoom(kBytesOfTriangle * count);
    }
    /// Throws Refused if the limits do not allow a file of this size.
    void checkBytes(std::size_t count) const {
        if (count > limits_.bytes) {
            throw Refused{{Refusal::Cause::too_large,
                           "the file would exceed the allowed " + std::to_string(limits_.bytes) + " bytes"}};
        }
        checkRoom(count);
    }
    std::size_t triangles() const { return limits_.triangles; }

  private:
    static constexpr std::size_t kBytesOfTriangle = 64;  // approximately, in the file or in memory

    void checkRoom(std::size_t bytes) const {
        if (limits_.reserve && !limits_.reserve(bytes))
            throw Refused{{Refusal::Cause::no_room, "the memory limit leaves no room for the file"}};
    }

    const Limits limits_;
    const std::stop_token stop_;
    const std::chrono::steady_clock::time_point start_;
};

}  // namespace oval4d::exports
