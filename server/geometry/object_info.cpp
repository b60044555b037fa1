#include "geometry/object_info.hpp"

#include <atomic>
#include <random>

namespace oval4d::geometry {

namespace {

// Returns a random integer of 52 bits. A process that counts up from there stays below 2^53, so JSON readers with
// 64-bit floats read its serial numbers exactly.
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
