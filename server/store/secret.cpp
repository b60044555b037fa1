#include "store/secret.hpp"

#include <sodium.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace oval4d::store {

namespace {

/// Initializes libsodium, so that it uses its fastest implementation for this processor.
void initializeLibsodium() {
    if (sodium_init() < 0) throw std::runtime_error("libsodium cannot be used");
}

std::vector<std::uint8_t> randomBytes(std::size_t count) {
    initializeLibsodium();
    std::vector<std::uint8_t> bytes(count);
    randombytes_buf(bytes.data(), bytes.size());
    return bytes;
}

const unsigned char* asUnsignedBytes(std::string_view text) {
    return reinterpret_cast<const unsigned char*>(text.data());
}

}  // namespace

std::string randomName(std::size_t bytes) {
    static constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz234567";
    std::string name;
    std::uint32_t held = 0;
    int bits = 0;
    for (const std::uint8_t byte : randomBytes(bytes)) {
        held = held << 8 | byte;
        for (bits += 8; bits >= 5; bits -= 5) name += kLetters[held >> (bits - 5) & 31];
    }
    if (bits > 0) name += kLetters[held << (5 - bits) & 31];
    return name;
}

std::string hashToken(std::string_view token) {
    initializeLibsodium();
    std::array<unsigned char, crypto_generichash_BYTES> hash{};
    crypto_generichash(hash.data(), hash.size(), asUnsignedBytes(token), token.size(), nullptr, 0);
    std::string text(2 * hash.size() + 1, '\0');  // with room for the terminating zero of sodium_bin2hex()
    sodium_bin2hex(text.data(), text.size(), hash.data(), hash.size());
    text.pop_back();
    return text;
}

std::string recordDigest(std::span<const std::string_view> parts) {
    initializeLibsodium();
    crypto_generichash_state state{};
    std::string digest(crypto_generichash_BYTES_MIN, '\0');
    crypto_generichash_init(&state, nullptr, 0, digest.size());
    for (const std::string_view part : parts) {
        const std::uint64_t size = part.size();
        std::array<unsigned char, sizeof size> prefix{};
        for (std::size_t i = 0; i < prefix.size(); ++i) prefix.at(i) = static_cast<unsigned char>(size >> (8 * i));
        crypto_generichash_update(&state, prefix.data(), prefix.size());
        crypto_generichash_update(&state, asUnsignedBytes(part), part.size());
    }
    std::array<unsigned char, crypto_generichash_BYTES_MIN> bytes{};
    crypto_generichash_final(&state, bytes.data(), bytes.size());
    std::ranges::copy(bytes, digest.begin());
    return digest;
}

bool equalInConstantTime(std::string_view given, std::string_view expected) {
    // Comparing lengths first reveals nothing, because all tokens have the same length, and so do all hashes.
    return given.size() == expected.size() && sodium_memcmp(given.data(), expected.data(), given.size()) == 0;
}

}  // namespace oval4d::store
