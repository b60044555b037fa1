#include "net/http/access_control.hpp"

#include <gtest/gtest.h>

#include "net/http/request_target.hpp"

namespace oval4d::net {
namespace {

using Verdict = AccessControl::Verdict;

TEST(AccessControl, AllowsOnlyLoopbackNamesOnLoopback) {
    const AccessControl access({}, {}, "", true);
    for (const char* host : {"localhost", "LOCALHOST:8080", "127.0.0.1:1", "[::1]", "[::1]:8080"}) {
        EXPECT_EQ(access.check({.host = host}), Verdict::allowed) << host;
    }
    for (const char* host : {"", "example.org", "localhost.example.org", "127.0.0.1.example.org:80", "[::2]:80"}) {
        EXPECT_EQ(access.check({.host = host}), Verdict::bad_host) << host;
    }
}

TEST(AccessControl, AllowsOwnAndListedOrigins) {
    const AccessControl access({"*"}, {"https://pages.example"}, "", false);
    EXPECT_EQ(access.check({.host = "a:80", .origin = "http://a:80"}), Verdict::allowed);
    EXPECT_EQ(access.check({.host = "a", .origin = "https://A"}), Verdict::allowed);
    EXPECT_EQ(access.check({.host = "a", .origin = "https://pages.example"}), Verdict::allowed);
    for (const char* origin : {"null", "a", "http://b", "http://a:81", "http://a.example", "https://pages.example:1"}) {
        EXPECT_EQ(access.check({.host = "a", .origin = origin}), Verdict::bad_origin) << origin;
    }
}

TEST(AccessControl, AcceptsTheTokenFromQueryHeaderOrCookie) {
    const AccessControl access({"*"}, {}, "secret", false);
    EXPECT_EQ(access.check({.host = "a"}), Verdict::bad_token);
    EXPECT_EQ(access.check({.host = "a", .token = "secret"}), Verdict::allowed);
    EXPECT_EQ(access.check({.host = "a", .token = "secrets"}), Verdict::bad_token);
    EXPECT_EQ(access.check({.host = "a", .authorization = "Bearer secret"}), Verdict::allowed);
    EXPECT_EQ(access.check({.host = "a", .authorization = "bearer wrong"}), Verdict::bad_token);
    EXPECT_EQ(access.check({.host = "a", .cookie = "x=1; oval4d_token=secret; y=2"}), Verdict::allowed);
    EXPECT_EQ(access.check({.host = "a", .cookie = "oval4d_token_=secret; oval4d_token=wrong"}), Verdict::bad_token);
    EXPECT_EQ(access.tokenCookieFor({.token = "wrong"}), "");
    EXPECT_TRUE(access.tokenCookieFor({.token = "secret"}).starts_with("oval4d_token=secret;"));
}

TEST(UrlAuthority, IsAHostWithAnOptionalPort) {
    for (const char* text : {"localhost", "localhost:0", "127.0.0.1:65535", "[::1]", "[::1]:8080", "a-b.example_1"})
        EXPECT_TRUE(parseAuthority(text)) << text;
    for (const char* text : {"", ":80", "a:", "a:b", "a:65536", "a:-1", "a:+1", "a:80:80", "a b", "u@a", "[::1", "::1",
                             "[localhost]", "[::1]x", "[::1]80", "a/", "a,b", "a\t"}) {
        EXPECT_FALSE(parseAuthority(text)) << text;
    }
    EXPECT_EQ(parseAuthority("[::1]:8080")->host, "[::1]");
    EXPECT_EQ(parseAuthority("[::1]:8080")->port, "8080");
}

TEST(AccessControl, AcceptsOnlyHttpOrigins) {
    const AccessControl access({"*"}, {}, "", false);
    for (const char* origin : {"http://a", "HTTP://A", "https://a:443", "http://a:80", "https://a"})
        EXPECT_EQ(access.check({.host = "a", .origin = origin}), Verdict::allowed) << origin;
    for (const char* origin :
         {"ftp://a", "file://", "chrome-extension://a", "http://a:x", "http://a:", "http://a:65616", "http://a/",
          "http://u@a", "http:///a", "http://a, http://a", "http://"}) {
        EXPECT_EQ(access.check({.host = "a", .origin = origin}), Verdict::bad_origin) << origin;
    }
}

TEST(AccessControl, RecognizesCrossSiteRequests) {
    const AccessControl access({"*"}, {"https://pages.example"}, "", false);
    EXPECT_TRUE(access.isUnwantedCrossSite({.host = "a", .fetchSite = "cross-site"}));
    EXPECT_FALSE(access.isUnwantedCrossSite({.host = "a", .fetchSite = "same-origin"}));
    EXPECT_FALSE(access.isUnwantedCrossSite({.host = "a"}));
    EXPECT_FALSE(
        access.isUnwantedCrossSite({.host = "a", .origin = "https://pages.example", .fetchSite = "cross-site"}));
}

TEST(RequestTarget, DecodesPathAndQuery) {
    const auto target = parseRequestTarget("/a%20b?rotate=xw,yz:pi/8,0.1+2^3&rotate=%78y:1&&flag&empty=");
    ASSERT_TRUE(target);
    EXPECT_EQ(target->path, "/a b");
    const session::QueryParameters expected{
        {"rotate", "xw,yz:pi/8,0.1+2^3"}, {"rotate", "xy:1"}, {"flag", ""}, {"empty", ""}};
    EXPECT_EQ(target->query, expected);
}

TEST(RequestTarget, ReadsPlusAsBlankUnlessItAdds) {
    const auto value = [](const std::string& query) { return parseRequestTarget("/?" + query)->query.at(0).second; };
    EXPECT_EQ(value("polytope=two+warm+spots"), "two warm spots");
    EXPECT_EQ(value("polytope=x3o3o+*b3o"), "x3o3o *b3o");
    EXPECT_EQ(value("formula=x%5E2+%2B+y%5E2+%3C+1"), "x^2 + y^2 < 1");  // encoded by standard clients
    EXPECT_EQ(value("formula=x^2+y^2+(z-1)<w"), "x^2+y^2+(z-1)<w");      // typed by people
    EXPECT_EQ(value("formula=sqrt(x)+%CF%80+.5"), "sqrt(x)+\u03C0+.5");
    EXPECT_EQ(value("formula=x+-+y+"), "x - y ");
    EXPECT_EQ(value("rotate=xw,yz:0.1,+pi/8"), "xw,yz:0.1, pi/8");
    EXPECT_EQ(value("rotate=xw:30+%C2%B0"), "xw:30 °");  // a unit is not an operand
    EXPECT_EQ(value("rotate=xw,yz:30+deg,0.5+rad"), "xw,yz:30 deg,0.5 rad");
    EXPECT_EQ(value("alpha=0.5+deg(30)+degree"), "0.5+deg(30)+degree");
    for (const std::string name : {"variable", "values_variable"}) {  // names in files are not arithmetic
        EXPECT_EQ(value(name + "=air+temperature"), "air temperature");
        EXPECT_EQ(value(name + "=u%2Bv+%2B+w"), "u+v + w");
    }
}

TEST(RequestTarget, KeepsCharactersThatBrowsersDoNotEncode) {
    const auto target = parseRequestTarget(R"(/a^|b[]?formula=x^2|y-{z}`[w]\&{a}=b)");
    ASSERT_TRUE(target);
    EXPECT_EQ(target->path, "/a^|b[]");
    const session::QueryParameters expected{{"formula", R"(x^2|y-{z}`[w]\)"}, {"{a}", "b"}};
    EXPECT_EQ(target->query, expected);
}

TEST(RequestTarget, LeavesOutWhatOtherSitesAppend) {
    const auto target = parseRequestTarget(
        "/?fbclid=1&polytope=5-cell&utm_source=a&utm_medium=b&gclid=c&fb=2&gad_source=1&gad_campaignid=2&srsltid=d&"
        "gbraid=e&wbraid=f&dclid=g&mc_eid=h&igshid=i&twclid=j&li_fat_id=k&_ga=l&ref_src=m");
    const session::QueryParameters expected{{"polytope", "5-cell"}, {"fb", "2"}};
    EXPECT_EQ(target->query, expected);
}

TEST(RequestTarget, ReadsQueriesThatWereEscapedAgain) {
    const auto target =
        parseRequestTarget("/?rotate=xw:0.1%252C0.2&amp;polytope=two%2520spots&amp;a=100%25&b=%25zz%2520");
    ASSERT_TRUE(target);
    const session::QueryParameters expected{
        {"rotate", "xw:0.1,0.2"}, {"polytope", "two spots"}, {"a", "100%"}, {"b", "%zz "}};
    EXPECT_EQ(target->query, expected);
}

TEST(RequestTarget, AcceptsAbsoluteForm) {
    struct {
        const char *text, *authority, *path;
    } const rows[] = {{"http://host/a", "host", "/a"},
                      {"HTTPS://host:1/a?b=c", "host:1", "/a"},
                      {"http://[::1]:80", "[::1]:80", "/"},
                      {"http://host?b=c", "host", "/"}};
    for (const auto& [text, authority, path] : rows) {
        const auto target = parseRequestTarget(text);
        ASSERT_TRUE(target) << text;
        EXPECT_EQ(target->authority, authority) << text;
        EXPECT_EQ(target->path, path) << text;
    }
    EXPECT_EQ(parseRequestTarget("http://host?b=c")->query, (session::QueryParameters{{"b", "c"}}));
}

TEST(RequestTarget, RejectsMalformedTargets) {
    for (const char* text : {"", "x", "http:/host/", "http://", "http:///", "http://u@host/", "ftp://host/", "*", "/%",
                             "/%4", "/%zz", "/?a=%", "/?%g0=1"}) {
        EXPECT_FALSE(parseRequestTarget(text)) << text;
    }
}

}  // namespace
}  // namespace oval4d::net
