#pragma once
// Limits on the size, the time and the memory of an export.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <stop_token>
#include <string>
#include <utility>

#include "slicing/occlusion.hpp"

namespace oval4d::exports {

/// The limits on one export.
struct ExportLimits {
    std::size_t triangles = 5'000'000;       ///< maximum number of triangles in all bodies together
    std::size_t bytes = 512U << 20U;         ///< maximum size of the file in bytes
    std::chrono::duration<double> time{20};  ///< maximum time of the export, from the construction of its ExportBudget
    /// A function that grants memory. The exporting thread calls it whenever there is a new estimate of the total
    /// number of bytes that the export needs. The function returns false to refuse the memory. If null, memory is not
    /// limited.
    std::function<bool(std::size_t)> grantTotalBytes = nullptr;
    /// The maximum number of edges of all slices together (see slicing::checkSliceEdges()).
    std::size_t sliceEdges = std::numeric_limits<std::size_t>::max();
    /// The maximum number of steps to find the parts of the projection that lie behind other cells (see
    /// slicing::OcclusionFinder::findDrawnElements()).
    std::size_t occlusionSteps = slicing::OcclusionFinder::kDefaultSteps;
    /// The maximum number of slices that ExportRequest::chosenW or ExportRequest::fittedSlices may choose.
    int slices = 201;
    /// Returns the current time, to measure `time`. Tests pass a function that returns a virtual time. Thread-safe.
    std::function<std::chrono::steady_clock::time_point()> now = std::chrono::steady_clock::now;
};

/// The reason why an export produces no file, and a text for the user. Functions throw an ExportRefusal within
/// ExportRefused, and exportScene() returns it.
struct ExportRefusal {
    enum class Cause : std::uint8_t {
        /// The body is empty or flat, the label does not fit, or the format cannot contain the requested contents.
        no_body,
        too_large,  ///< the file would exceed ExportLimits::triangles or ExportLimits::bytes
        too_long,   ///< the export exceeds ExportLimits::time, or a stop was requested
        no_room,    ///< ExportLimits::grantTotalBytes has refused the memory
    };
    Cause cause;
    std::string message;
};

/// An exception: an export is refused. Functions in this folder throw ExportRefused, and exportScene() catches it and
/// returns `error`.
struct ExportRefused {
    ExportRefusal error;
};

/// A check of one export against its limits. The time of the export begins with the construction of this object.
class ExportBudget {
  public:
    ExportBudget(const ExportLimits& limits, std::stop_token stop)
        : limits_(limits), stop_(std::move(stop)), start_(limits_.now()) {}

    /// Returns whether the time limit is exceeded, or a stop was requested.
    bool mustStop() const { return stop_.stop_requested() || limits_.now() - start_ > limits_.time; }
    /// Throws ExportRefused if the time limit is exceeded, or a stop was requested. Long computations must call this
    /// function often, because nothing else interrupts them.
    void checkTimeAndStop() const {
        if (stop_.stop_requested())
            throw ExportRefused{
                {ExportRefusal::Cause::too_long, "the export was canceled because the server is stopping"}};
        if (mustStop()) {
            throw ExportRefused{{ExportRefusal::Cause::too_long,
                                 "the export takes longer than the allowed " +
                                     std::to_string(static_cast<int>(limits_.time.count())) +
                                     " s; export only the focus slice or, if the object has cells, a solid body"}};
        }
    }
    /// Throws ExportRefused if `total`, the number of triangles in all bodies together, exceeds
    /// ExportLimits::triangles, or if ExportLimits::grantTotalBytes refuses the memory for these triangles.
    void checkTrianglesAndMemory(std::size_t total) const {
        if (total > limits_.triangles) {
            throw ExportRefused{
                {ExportRefusal::Cause::too_large,
                 "the file would have about " + std::to_string(total) + " triangles; at most " +
                     std::to_string(limits_.triangles) +
                     " are allowed; export only the focus slice or, if the object has cells, a solid body"}};
        }
        requireMemory(kBytesOfTriangle * total);
    }
    /// Throws ExportRefused if `count`, the size of the file in bytes, exceeds ExportLimits::bytes, or if
    /// ExportLimits::grantTotalBytes refuses this number of bytes.
    void checkFileSize(std::size_t count) const {
        if (count > limits_.bytes) {
            throw ExportRefused{{ExportRefusal::Cause::too_large,
                                 "the file would exceed the allowed " + std::to_string(limits_.bytes) + " bytes"}};
        }
        requireMemory(count);
    }
    /// Returns the maximum number of triangles in all bodies together (ExportLimits::triangles).
    std::size_t triangleLimit() const { return limits_.triangles; }
    /// Returns the maximum time of the whole export (ExportLimits::time).
    std::chrono::duration<double> timeLimit() const { return limits_.time; }
    /// Returns the token that says whether a stop is requested.
    std::stop_token stopToken() const { return stop_; }

  private:
    static constexpr std::size_t kBytesOfTriangle = 64;  // approximate bytes of a triangle, in the file or in memory

    void requireMemory(std::size_t bytes) const {
        if (limits_.grantTotalBytes && !limits_.grantTotalBytes(bytes))
            throw ExportRefused{{ExportRefusal::Cause::no_room, "the memory limit leaves no room for the file"}};
    }

    const ExportLimits limits_;
    const std::stop_token stop_;
    const std::chrono::steady_clock::time_point start_;
};

}  // namespace oval4d::exports
