#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "store/open_store.hpp"

namespace oval4d::store {
namespace {

TEST(OpenStore, ParsesPlaces) {
    StoreOptions options;
    const auto named = [&](const std::string& url) {
        options.url = url;
        return openStore(options)->name();
    };
    EXPECT_EQ(named("memory"), "memory");
    EXPECT_EQ(named("redis://host"), "redis://host:6379/");
    EXPECT_EQ(named("redis://user:pass@word@host:7000/3"), "redis://host:7000/3") << "without the password";
    EXPECT_EQ(named("redis://[::1]:7000"), "redis://::1:7000/");
    for (const char* wrong :
         {"", "disk", "sqlite:", "redis://", "redis://host:x", "redis://host:0", "redis://host/x"}) {
        EXPECT_THROW(named(wrong), std::invalid_argument) << wrong;
    }
}

}  // namespace
}  // namespace oval4d::store
