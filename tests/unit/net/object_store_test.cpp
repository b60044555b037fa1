// What the class ObjectStore refuses before it makes a request. tests/service/test_object_store.py tests its requests.

#include "net/object_store.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace oval4d::net {
namespace {

TEST(ObjectStore, RefusesAddressesThatAreNotValid) {
    for (const char* const address : {"s3://bucket/runs", "file:///etc/", "http://", "http://me:secret@host/",
                                      "http://host/?list", "http://host/#a", "http://host name/", "HTTP//host/"}) {
        EXPECT_THROW(ObjectStore(address, {}), std::invalid_argument) << address;
    }
    for (const char* const address : {"http://host", "https://host:9000/bucket/runs/", "http://[::1]/"})
        EXPECT_NO_THROW(ObjectStore(address, {})) << address;
    EXPECT_TRUE(ObjectStore::isUrl("https://host/runs"));
    EXPECT_FALSE(ObjectStore::isUrl("/fields"));
}

TEST(ObjectStore, HasNoObjectsElsewhere) {
    const ObjectStore store("http://host.invalid/runs/", {});
    const std::string paths[] = {"",
                                 "/",
                                 "/x",
                                 "x/",
                                 "..",
                                 "../x",
                                 "x/.",
                                 "x//y",
                                 "x/../y",
                                 "http://host/x",
                                 std::string("x\0y", 3),
                                 std::string(2000, 'x')};
    for (const std::string& path : paths) {
        const auto object = store.get(path, {});
        ASSERT_TRUE(object) << path;
        EXPECT_FALSE(*object) << path;
    }
}

}  // namespace
}  // namespace oval4d::net
