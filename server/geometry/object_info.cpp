#include "geometry/object_info.hpp"

#include <atomic>

namespace oval4d::geometry {

std::uint64_t nextSerial() {
    static std::atomic<std::uint64_t> serial{0};
    return ++serial;
}

}  // namespace oval4d::geometry
