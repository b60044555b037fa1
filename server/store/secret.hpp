#pragma once
// Random names, hashes of secret tokens, and digests of records.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace oval4d::store {

/// Returns an unguessable name: `bytes` random bytes from the system, encoded in lower-case base 32 (a–z, 2–7), whose
/// characters are allowed in URLs and file names.
std::string randomName(std::size_t bytes);

/// Returns the hash that stores keep in place of a token: 256 bits of BLAKE2b in lower-case hexadecimal. A fast hash
/// without salt is sufficient, because a token is 160 random bits and cannot be found by brute force, unlike a
/// password.
std::string hashToken(std::string_view token);

/// Returns a digest that detects damaged records: 128 bits of BLAKE2b over `parts` and their lengths, as 16 bytes.
std::string recordDigest(std::span<const std::string_view> parts);

/// Returns whether two secrets are equal. For secrets of equal length, the running time does not depend on the position
/// of the first difference, and therefore reveals nothing about the secrets.
bool equalInConstantTime(std::string_view given, std::string_view expected);

}  // namespace oval4d::store
