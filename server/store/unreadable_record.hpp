#pragma once

#include <stdexcept>

namespace oval4d::store {

/// An error: bytes are not a valid record of a session or object, or refer to an object that is missing or cannot be
/// built.
class UnreadableRecord : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// An error: a record is well formed, but a later version of the program has stored it. The record has a version, a
/// member or a value that this program does not know or allow. The record must be kept, because the later version can
/// read it.
class NewerVersionRecord : public UnreadableRecord {
  public:
    using UnreadableRecord::UnreadableRecord;
};

}  // namespace oval4d::store
