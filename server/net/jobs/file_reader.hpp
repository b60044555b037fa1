#pragma once

#include <stop_token>

#include "net/services.hpp"
#include "session/object_loader.hpp"

namespace oval4d::net {

/// Returns a function that reads an object in a file reader process (parses files outside the server). If
/// LoadObject::dataName is not empty, the object is an array of the data folder; otherwise it is in a file that a
/// client has sent. The function throws parallel::Canceled after a stop is requested with `stop`, unless it only waits
/// for another thread that reads the same array. The services must outlive the function.
session::FileReader makeFileReader(const Services& services, std::stop_token stop = {});

}  // namespace oval4d::net
