#include "net/access.hpp"

#include <gtest/gtest.h>

#include "net/target.hpp"

namespace oval4d::net {
namespace {

using Verdict = Access::Verdict;

TEST(Access, OnLoopbackOnlyLoopbackNames) {
    const Access access({}, {}, "", true);
    for (const char* host : {"localhost", "LOCALHOST:8080", "127.0.0.1:1", "[::1]", "[::1]:8080"}) {
        EXPECT_EQ(access.judge({.host = host}), Verdict::allowed) << host;
    }
    for (const char* host : {"", "example.org", "localhost.example.org", "127.0.0.1.example.org:80", "[::2]:80"}) {
        EXPECT_EQ(access.judge({.host = host}), Verdict::bad_host) << host;
    }
}

TEST(Access, OwnPagesAndListedOnesMayCall) {
    const Access access({"*"}, {"https://pages.example"}, "", false);
    EXPECT_EQ(access.judge({.host = "a:80", .origin = "http://a:80"}), Verdict::allowed);
    EXPECT_EQ(access.judge({.host = "a", .origin = "https://A"}), Verdict::allowed);
    EXPECT_EQ(access.judge({.host = "a", .origin = "https://pages.example"}), Verdict::allowed);
    for (const char* origin : {"null", "a", "http://b", "http://a:80", "http://a.example", "https://pages.example:1"}) {
        EXPECT_EQ(access.judge({.host = "a", .origin = origin}), Verdict::bad_origin) << origin;
    }
}

TEST(Access, TheTokenOpensByQueryHeaderOrCookie) {
    const Access access({"*"}, {}, "secret", false);
    EXPECT_EQ(access.judge({.host = "a"}), Verdict::bad_token);
    EXPECT_EQ(access.judge({.host = "a", .token = "secret"}), Verdict::allowed);
    EXPECT_EQ(access.judge({.host = "a", .token = "secrets"}), Verdict::bad_token);
    EXPECT_EQ(access.judge({.host = "a", .authorization = "Bearer secret"}), Verdict::allowed);
    EXPECT_EQ(access.judge({.host = "a", .authorization = "bearer wrong"}), Verdict::bad_token);
    EXPECT_EQ(access.judge({.host = "a", .cookie = "x=1; oval4d_token=secret; y=2"}), Verdict::allowed);
    EXPECT_EQ(access.judge({.host = "a", .cookie = "oval4d_token_=secret; oval4d_token=wrong"}), Verdict::bad_token);
    EXPECT_EQ(access.cookieFor({.token = "wrong"}), "");
    EXPECT_TRUE(access.cookieFor({.token = "secret"}).starts_with("oval4d_token=secret;"));
}

TEST(Target, PathAndQueryAreDecoded) {
    const auto target = parseTarget("/a%20b?rotate=xw,yz:pi/8,0.1+2^3&rotate=%78y:1&&flag&empty=");
    ASSERT_TRUE(target);
    EXPECT_EQ(target->path, "/a b");
    const session::Query expected{{"rotate", "xw,yz:pi/8,0.1+2^3"}, {"rotate", "xy:1"}, {"flag", ""}, {"empty", ""}};
    EXPECT_EQ(target->query, expected);
}

TEST(Target, WhatCannotBeReadIsNothing) {
    for (const char* text : {"", "x", "http://host/", "/%", "/%4", "/%zz", "/?a=%", "/?%g0=1"}) {
        EXPECT_FALSE(parseTarget(text)) << text;
    }
}

}  // namespace
}  // namespace oval4d::net
