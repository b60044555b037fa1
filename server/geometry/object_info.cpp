#include "geometry/object_info.hpp"

#include <atomic>
#include <random>

namespace oval4d::geometry {

namespace {

// 52 random bits: the numbers that follow remain below 2^53, and JSON readers with 64-bit floats read them exactly.
std::uint64_t randomStart() {
    std::random_device random;
    const std::uint64_t high = random(), low = random();
    return high << 20U | low >> 12U;
}

}  // namespace

std::uint64_t nextSerial() {
    static std::atomic<std::uint64_t> serial{randomStart()};
    return ++serial;
}

}  // namespace oval4d::geometry
