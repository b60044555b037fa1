#include "geometry/object_info.hpp"

#include <atomic>
#include <random>

namespace oval4d::geometry {

namespace {

// Returns a random integer below 2^52. A process counts its serial numbers up from this integer, and stays below 2^53.
// So JSON readers that store numbers as 64-bit floats read the serial numbers exactly.
std::uint64_t randomFirstSerial() {
    std::random_device random;
    const std::uint64_t high = random(), low = random();
    return high << 20U | low >> 12U;
}

}  // namespace

std::uint64_t nextSerial() {
    static std::atomic<std::uint64_t> serial{randomFirstSerial()};
    return ++serial;
}

}  // namespace oval4d::geometry
