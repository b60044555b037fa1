#include <gtest/gtest.h>

#include <set>

#include "store/secret.hpp"

namespace oval4d::store {
namespace {

TEST(Secret, NamesAreLongAndDifferent) {
    std::set<std::string> seen;
    for (int i = 0; i < 1000; ++i) {
        const std::string name = randomName(10);
        EXPECT_EQ(name.size(), 16U);
        EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz234567"), std::string::npos);
        EXPECT_TRUE(seen.insert(name).second);
    }
}

TEST(Secret, SameOnlyIfEqual) {
    EXPECT_TRUE(sameSecret("abc", "abc"));
    EXPECT_TRUE(sameSecret("", ""));
    for (const char* other : {"", "ab", "abd", "abcabc", "abcd"}) EXPECT_FALSE(sameSecret(other, "abc")) << other;
    EXPECT_FALSE(sameSecret("abc", ""));
}

}  // namespace
}  // namespace oval4d::store
