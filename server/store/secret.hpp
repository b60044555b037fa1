#pragma once
// Random names, hashes of secret tokens, and digests of records.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace oval4d::store {

/// Returns `bytes` bytes of the system's random generator in lower-case base 32 (a–z, 2–7), which URLs and file names
/// can hold. Cannot be guessed.
std::string randomName(std::size_t bytes);

/// The hash of a token that a store keeps: 256 bits of BLAKE2b in lower-case hexadecimal. A fast hash without salt is
/// enough, because tokens are 160 random bits and cannot be found by brute force; a password would need a slow one.
std::string hashOf(std::string_view token);

/// 128 bits of BLAKE2b over `parts` and their lengths. Detects damaged records.
std::string digestOf(std::span<const std::string_view> parts);

/// Compares two secrets in constant time.
bool equalInConstantTime(std::string_view given, std::string_view expected);

}  // namespace oval4d::store
