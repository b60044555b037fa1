#pragma once

#include "net/services.hpp"
#include "session/object_loader.hpp"

namespace oval4d::net {

/// Returns a function that reads a client's file, or an array of the data folder, in a file reader process. The
/// services must outlive the function.
session::FileReader fileReader(const Services& services);

}  // namespace oval4d::net
