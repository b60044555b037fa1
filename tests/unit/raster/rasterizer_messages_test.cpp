// Tests of the messages with which the server requests pictures from a rasterizer process (which draws them).

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <string_view>

#include "polytopes/catalogue/polytope_cache.hpp"
#include "raster/rasterizer_messages.hpp"

namespace oval4d::raster {
namespace {

// A message that was cut short is refused. (tests/unit/pipeline/picture_request_test.cpp checks that complete requests
// arrive unchanged.)
TEST(RasterizerMessages, BytesCutShortAreRefused) {
    scene::PictureRequest picture;
    picture.source = picture.object = polytopes::fiveCell();
    std::string bytes;
    encodeDrawRequest(picture, {}, bytes);
    DrawRequest order;
    EXPECT_NO_THROW(decodeDrawRequest(bytes, order));
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_THROW(decodeDrawRequest(std::string_view(bytes).substr(0, size), order), std::runtime_error);
}

}  // namespace
}  // namespace oval4d::raster
