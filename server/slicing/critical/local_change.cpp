#include "slicing/critical/local_change.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <glm/vector_relational.hpp>

namespace oval4d::slicing {

namespace {

constexpr int kWindowSide = LocalTopologyChangeSearch::kSide, kWindowMiddle = kWindowSide / 2;
constexpr std::size_t kWindowLayer = static_cast<std::size_t>(kWindowSide) * kWindowSide,
                      kWindowPoints = kWindowLayer * kWindowSide;
constexpr int kMaxSamplings = 600;  // how often one search may sample windows, approximately
// Of the points that enter or leave the body, at most this many are tried as the middle of the next window.
constexpr std::size_t kMaxTriedPoints = 8;
// Points less than this many lattice steps from the boundary of a window are not in its interior.
constexpr int kWindowMargin = 2;
constexpr double kFirstPrecision = 0.01;  // the precision of w in the first window, per SearchStart::tolerance
// The next window searches only this many times less far along w than the window before it.
constexpr double kReachShrink = 2;
constexpr int kNeededWindows = 3;  // the number of successive windows in which a change must be found to count

std::size_t windowPointIndex(int x, int y, int z) {
    return static_cast<std::size_t>(x) +
           kWindowSide * (static_cast<std::size_t>(y) + kWindowSide * static_cast<std::size_t>(z));
}

// Returns twice the least step along w that changes at least one coordinate of every point in the box. The coordinates
// of points are 32-bit floats, so a smaller step may be lost by rounding. `normal` is one unit of w, as a vector in the
// function's coordinates.
double leastStepAlongW(const fields::Box& box, const glm::dvec4& normal) {
    double least = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 4; ++axis) {
        const double largest = std::max(std::abs(box.min[axis]), std::abs(box.max[axis]));
        if (normal[axis] != 0)
            least = std::min(least, largest * std::numeric_limits<float>::epsilon() / std::abs(normal[axis]));
    }
    return 2 * least;
}

}  // namespace

LocalTopologyChangeSearch::LocalTopologyChangeSearch(const fields::Field& field, const geometry::Rotation& orientation,
                                                     double level, fields::BodySide inside,
                                                     std::function<bool()> mustEnd)
    : field_(field),
      toFunction_(field.toFunction * orientation.inverse().matrix()),
      level_(level),
      inside_(inside),
      mustEnd_(std::move(mustEnd)),
      leastStep_(leastStepAlongW(field.box, toFunction_[3])),
      flags_(kWindowPoints),
      otherFlags_(kWindowPoints),
      parents_(kWindowPoints),
      values_(kWindowLayer),
      x_(kWindowLayer),
      y_(kWindowLayer),
      z_(kWindowLayer),
      w_(kWindowLayer) {}

std::optional<double> LocalTopologyChangeSearch::find(const SoughtPartCountChange& change, const SearchStart& start) {
    change_ = change;
    tolerance_ = start.tolerance;
    samplings_ = 0;
    return findInWindow({start.point, start.half}, start.w, start.reach, 1);
}

// Returns the w of the change in a window (a cube in the section), refined in smaller windows around the points that
// enter or leave the body (the region inside the level). `number` is 1 for the first, largest window.
std::optional<double> LocalTopologyChangeSearch::findInWindow(const SearchWindow& window, double w, double reach,
                                                              int number) {
    const std::optional<PartCountEvent> event = changeInWindow(window, w, reach, number);
    if (!event) return std::nullopt;
    if (number == kWindows) return event->w;
    for (std::size_t i = 0; i < std::min(kMaxTriedPoints, event->points.size()); ++i) {
        if (const auto finer =
                findInWindow({event->points[i], window.half / kZoom}, event->w, reach / kReachShrink, number + 1))
            return finer;
    }
    return number >= kNeededWindows ? std::optional(event->w) : std::nullopt;
}

// Finds, in one window, the change whose w is nearest to `w`, at a distance of at most `reach`. Returns an empty
// optional if there is none, or if no lattice point in the interior of the window enters or leaves the body. `number`
// is 1 for the first, largest window.
std::optional<LocalTopologyChangeSearch::PartCountEvent> LocalTopologyChangeSearch::changeInWindow(
    const SearchWindow& window, double w, double reach, int number) {
    double from = w, to = w;
    std::size_t before = 0, after = 0;
    for (double distance = std::min(tolerance_, reach);; distance = std::min(2 * distance, reach)) {
        if (samplings_ > kMaxSamplings || mustEnd_()) return std::nullopt;
        from = w - distance;
        to = w + distance;
        before = countSoughtPartsAt(window, from);
        after = countSoughtPartsAt(window, to);
        if (isSoughtChange(before, after)) break;
        if (distance >= reach) return std::nullopt;
    }
    // In an interval of w of the same length, more points of a finer lattice enter or leave the body (the region inside
    // the level). So the interval must be shorter on a finer lattice.
    const double precision = std::max(leastStep_, kFirstPrecision * tolerance_ / std::pow(kZoom, number - 1));
    while (to - from > precision) {
        if (samplings_ > kMaxSamplings || mustEnd_()) return std::nullopt;
        const double middle = (from + to) / 2;
        (isSoughtChange(before, countSoughtPartsAt(window, middle)) ? to : from) = middle;
    }
    sampleWindow(window, from, flags_);
    sampleWindow(window, to, otherFlags_);
    PartCountEvent event{(from + to) / 2, {}};
    const double step = window.half / kWindowMiddle;
    for (int z = kWindowMargin; z < kSide - kWindowMargin; ++z) {
        for (int y = kWindowMargin; y < kSide - kWindowMargin; ++y) {
            for (int x = kWindowMargin; x < kSide - kWindowMargin; ++x) {
                const std::size_t i = windowPointIndex(x, y, z);
                if (flags_[i] != otherFlags_[i])
                    event.points.push_back(window.center + step * (glm::dvec3(x, y, z) - double{kWindowMiddle}));
            }
        }
    }
    if (event.points.empty()) return std::nullopt;
    return event;
}

std::size_t LocalTopologyChangeSearch::countSoughtPartsAt(const SearchWindow& window, double w) {
    sampleWindow(window, w, flags_);
    return countSoughtParts(flags_);
}

// Sets `inside` to whether each lattice point of the window, in the section at `w`, is in the body. Points outside the
// domain and points without a value are not in the body.
void LocalTopologyChangeSearch::sampleWindow(const SearchWindow& window, double w, InBodyFlags& inside) {
    ++samplings_;
    const double step = window.half / kWindowMiddle;
    const bool isBelow = inside_ == fields::BodySide::below;
    for (int z = 0; z < kSide; ++z) {
        const auto flags = inside.begin() + static_cast<std::ptrdiff_t>(z * kWindowLayer);
        std::size_t i = 0;
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x, ++i) {
                const glm::dvec3 p = window.center + step * (glm::dvec3(x, y, z) - double{kWindowMiddle});
                const glm::dvec4 at = field_.center + toFunction_ * glm::dvec4(p, w);
                const bool isInDomain = glm::all(glm::greaterThanEqual(at, field_.box.min)) &&
                                        glm::all(glm::lessThanEqual(at, field_.box.max));
                flags[static_cast<std::ptrdiff_t>(i)] = isInDomain ? 1 : 0;
                x_[i] = static_cast<float>(at.x);
                y_[i] = static_cast<float>(at.y);
                z_[i] = static_cast<float>(at.z);
                w_[i] = static_cast<float>(at.w);
            }
        }
        field_.function->evaluate({x_, y_, z_, w_}, values_);
        for (i = 0; i < kWindowLayer; ++i) {
            const double value = values_[i];
            if (!(isBelow ? value < level_ : value > level_)) flags[static_cast<std::ptrdiff_t>(i)] = 0;
        }
    }
}

// Returns the number of connected parts of the body (the region inside the level) in a window or, if change_.ofBody is
// false, of the rest of the window. `inside` has 1 for each lattice point in the body.
std::size_t LocalTopologyChangeSearch::countSoughtParts(const InBodyFlags& inside) {
    std::iota(parents_.begin(), parents_.end(), std::uint32_t{0});
    const auto rootOf = [&](std::uint32_t point) {
        while (parents_[point] != point) point = parents_[point] = parents_[parents_[point]];
        return point;
    };
    const std::uint8_t counted = change_.ofBody ? 1 : 0;
    std::size_t parts = 0;
    for (int z = 0; z < kSide; ++z) {
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x) {
                const std::size_t point = windowPointIndex(x, y, z);
                if (inside[point] != counted) continue;
                ++parts;
                // The edges of the Freudenthal subdivision lead from a corner of a lattice cube to the corners with
                // larger coordinates.
                for (int bits = 1; bits < 8; ++bits) {
                    const int dx = bits & 1, dy = bits >> 1 & 1, dz = bits >> 2;
                    if (x < dx || y < dy || z < dz) continue;
                    const std::size_t other = windowPointIndex(x - dx, y - dy, z - dz);
                    if (inside[other] != counted) continue;
                    const std::uint32_t a = rootOf(static_cast<std::uint32_t>(point));
                    const std::uint32_t b = rootOf(static_cast<std::uint32_t>(other));
                    if (a == b) continue;
                    parents_[std::max(a, b)] = std::min(a, b);
                    --parts;
                }
            }
        }
    }
    return parts;
}

}  // namespace oval4d::slicing
