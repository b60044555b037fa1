#pragma once

#include <stop_token>

#include "net/services.hpp"
#include "session/object_loader.hpp"

namespace oval4d::net {

/// Returns a function that makes a file reader process, which parses files outside the server, read an object. If
/// LoadObject::dataName is not empty, the object is an array of the data folder; otherwise it is in a file that a
/// client has sent. If `stop` requests a stop, the function throws parallel::Canceled, unless it only waits for another
/// thread that reads the same array. The services must outlive the function.
session::FileReader makeFileReader(const Services& services, std::stop_token stop = {});

}  // namespace oval4d::net
