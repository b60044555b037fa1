#include <gtest/gtest.h>

#include <set>
#include <vector>

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

TEST(Secret, ComparesSecrets) {
    EXPECT_TRUE(equalInConstantTime("abc", "abc"));
    EXPECT_TRUE(equalInConstantTime("", ""));
    for (const char* other : {"", "ab", "abd", "abcabc", "abcd"})
        EXPECT_FALSE(equalInConstantTime(other, "abc")) << other;
    EXPECT_FALSE(equalInConstantTime("abc", ""));
}

TEST(Secret, HashIsBlake2b) {
    EXPECT_EQ(hashToken("abc"), "bddd813c634239723171ef3fee98579b94964e3bb1cb3e427262c8c068d52319");
    EXPECT_NE(hashToken(""), hashToken(std::string(1, '\0')));
}

TEST(Secret, DigestDependsOnPartBoundaries) {
    const auto digest = [](std::vector<std::string_view> parts) { return recordDigest(parts); };
    EXPECT_EQ(digest({"ab", "c"}), digest({"ab", "c"}));
    EXPECT_EQ(digest({"ab", "c"}).size(), 16U);
    EXPECT_NE(digest({"ab", "c"}), digest({"a", "bc"}));
    EXPECT_NE(digest({"abc"}), digest({"abc", ""}));
}

}  // namespace
}  // namespace oval4d::store
