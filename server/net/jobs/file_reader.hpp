#pragma once

#include "net/services.hpp"
#include "session/object_loader.hpp"

namespace oval4d::net {

/// Returns a function that reads an object in a file reader process: an array of the data folder if
/// LoadObject::dataName is not empty, otherwise a file that a client has sent. The services must outlive the function.
session::FileReader fileReader(const Services& services);

}  // namespace oval4d::net
