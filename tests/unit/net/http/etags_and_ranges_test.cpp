#include "net/http/etags_and_ranges.hpp"

#include <gtest/gtest.h>

namespace oval4d::net {
namespace {

TEST(Preconditions, ComparesEntityTagsWeakly) {
    for (const char* field : {"*", " * ", "\"a\"", "\"x\", \"a\"", "W/\"a\"", "\"x,y\",W/\"a\""})
        EXPECT_TRUE(matchesEntityTag(field, "\"a\"")) << field;
    for (const char* field : {"", "a", "\"b\"", "\"a", "a\"", "\"xa\"", "\"*\"", "\"b\" * "})
        EXPECT_FALSE(matchesEntityTag(field, "\"a\"")) << field;
}

TEST(Preconditions, ParsesASingleRange) {
    struct {
        const char* field;
        std::size_t first, size;
    } const rows[] = {{"bytes=0-0", 0, 1},
                      {"bytes=2-4", 2, 3},
                      {"bytes=5-", 5, 5},
                      {"bytes=5-99", 5, 5},
                      {"bytes=-3", 7, 3},
                      {"bytes=-99", 0, 10},
                      {"bytes=0-99999999999999999999999", 0, 10}};
    for (const auto& [field, first, size] : rows) {
        const auto range = parseRange(field, 10);
        ASSERT_TRUE(range && range->satisfiable) << field;
        EXPECT_EQ(range->first, first) << field;
        EXPECT_EQ(range->size, size) << field;
    }
}

TEST(Preconditions, RangesBeyondTheEndAreNotSatisfiable) {
    for (const char* field : {"bytes=10-", "bytes=10-20", "bytes=-0", "bytes=99999999999999999999999-"}) {
        const auto range = parseRange(field, 10);
        ASSERT_TRUE(range) << field;
        EXPECT_FALSE(range->satisfiable) << field;
    }
    ASSERT_TRUE(parseRange("bytes=0-", 0));
    EXPECT_FALSE(parseRange("bytes=0-", 0)->satisfiable);
}

TEST(Preconditions, IgnoresMalformedAndMultipleRanges) {
    for (const char* field : {"", "bytes", "bytes=", "bytes=-", "bytes=a-b", "bytes=4-2", "bytes=0-1,3-4", "lines=0-1",
                              "bytes=0x1-2", "bytes=1--2", "bytes= 1 - 2", "bytes=+1-2"}) {
        EXPECT_FALSE(parseRange(field, 10)) << field;
    }
}

}  // namespace
}  // namespace oval4d::net
