#pragma once

#include <stop_token>

#include "net/services.hpp"
#include "session/object_loader.hpp"

namespace oval4d::net {

/// Returns a function that reads an object in a file reader process: an array of the data folder if
/// LoadObject::dataName is not empty, otherwise a file that a client has sent. After a request of `stop`, the function
/// throws parallel::Canceled, unless it only waits for another thread that reads the same array. The services must
/// outlive the function.
session::FileReader fileReader(const Services& services, std::stop_token stop = {});

}  // namespace oval4d::net
