#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// 3MF in millimeters, with an object for each body. Throws std::runtime_error if lib3mf fails, and Refused if the time
/// is over.
std::string threeMf(const Bodies& bodies);

}  // namespace oval4d::exports
