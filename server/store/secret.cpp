#include "store/secret.hpp"

#include <sys/random.h>

#include <cerrno>
#include <cstdint>
#include <system_error>
#include <vector>

namespace oval4d::store {

namespace {

std::vector<std::uint8_t> randomBytes(std::size_t count) {
    std::vector<std::uint8_t> bytes(count);
    std::size_t have = 0;
    while (have < count) {
        const ssize_t got = getrandom(bytes.data() + have, count - have, 0);
        if (got > 0) {
            have += static_cast<std::size_t>(got);
        } else if (errno != EINTR) {
            throw std::system_error(errno, std::generic_category(), "getrandom");
        }
    }
    return bytes;
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

bool sameSecret(std::string_view given, std::string_view expected) {
    unsigned difference = given.size() == expected.size() ? 0U : 1U;
    for (std::size_t i = 0; i < given.size(); ++i) {
        const char other = expected.empty() ? '\0' : expected[i % expected.size()];
        difference |= static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(other);
    }
    return difference == 0;
}

}  // namespace oval4d::store
