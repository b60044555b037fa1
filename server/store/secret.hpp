#pragma once
// Names that cannot be guessed.

#include <cstddef>
#include <string>
#include <string_view>

namespace oval4d::store {

/// `bytes` random bytes of the system's generator as lower-case base 32 (a–z, 2–7): fit for URLs and file names.
std::string randomName(std::size_t bytes);

/// Compares without telling by its duration where the texts differ.
bool sameSecret(std::string_view given, std::string_view expected);

}  // namespace oval4d::store
