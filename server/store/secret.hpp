#pragma once
// Random names, hashes of secret tokens, and digests of records.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace oval4d::store {

/// Returns an unguessable name: `bytes` random bytes from the operating system, encoded in lowercase base 32 (a–z,
/// 2–7). All characters are allowed in URLs and file names.
std::string randomName(std::size_t bytes);

/// Returns the hash of a token: 256 bits of BLAKE2b in lowercase hexadecimal. Stores keep this hash instead of the
/// token. A fast hash without salt is sufficient: a token has 160 random bits, so it cannot be guessed as passwords
/// can.
std::string hashToken(std::string_view token);

/// Returns the digest of a record that consists of `parts`: 128 bits of BLAKE2b over the lengths and bytes of the
/// parts, as 16 bytes. A store notices a damaged record by its digest.
std::string recordDigest(std::span<const std::string_view> parts);

/// Returns whether two secrets are equal. For equal lengths, the running time does not depend on the position of the
/// first difference. So an attacker cannot find a secret by measuring times.
bool equalInConstantTime(std::string_view given, std::string_view expected);

}  // namespace oval4d::store
