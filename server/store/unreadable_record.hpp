#pragma once

#include <stdexcept>

namespace oval4d::store {

/// Thrown if bytes are not a valid record of a session or object, or are of a version that this program does not read.
class UnreadableRecord : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

}  // namespace oval4d::store
