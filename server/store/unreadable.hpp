#pragma once

#include <stdexcept>

namespace oval4d::store {

/// The bytes are not a valid session or object, or have a version that this program does not read.
class Unreadable : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

}  // namespace oval4d::store
