#include "image/png_text.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "image/png.hpp"

namespace oval4d::image {
namespace {

std::string pictureWith(std::string_view state) {
    PngEncoder encoder;
    const Image image{3, 2, std::vector<std::uint8_t>(24, 100)};
    std::vector<std::uint8_t> file;
    encoder.encode(image, state, file);
    return {file.begin(), file.end()};
}

TEST(PngText, IsThatOfTheEncoder) {
    for (const std::string& state : {std::string("{}"), std::string("\xc3\xa9\0x", 4), std::string(100'000, 'a')}) {
        const std::string file = pictureWith(state);
        EXPECT_TRUE(isPng(file));
        ASSERT_TRUE(stateTextIn(file));
        EXPECT_EQ(*stateTextIn(file), state);
    }
}

TEST(PngText, IsFoundBehindOtherChunks) {
    std::string file = pictureWith("the state");
    constexpr std::size_t kHeader = 8 + 25;  // the length of the signature and the IHDR chunk
    file.insert(kHeader, std::string("\0\0\0\x05iTXtother\0\0\0\0", 4 + 4 + 5 + 4));
    file.insert(kHeader, std::string("\0\0\0\0tEXt\0\0\0\0", 12));
    ASSERT_TRUE(stateTextIn(file));
    EXPECT_EQ(*stateTextIn(file), "the state");
}

// If only a part of a file is given, the result is nothing or the whole text. In particular, a chunk that claims to be
// longer than the file is not read beyond the end of the file.
TEST(PngText, OfPartsOfAFileIsNothingOrTheWholeText) {
    const std::string state = "some text", file = pictureWith(state);
    for (std::size_t size = 0; size < file.size(); ++size) {
        const std::string part = file.substr(0, size);
        if (const auto found = stateTextIn(part)) {
            EXPECT_EQ(*found, state) << size;
        }
    }
    for (std::size_t at = 0; at < file.size(); ++at) {
        for (const char changed : {'\0', '\xff', '\x7f'}) {
            std::string damaged = file;
            damaged[at] = changed;
            if (const auto found = stateTextIn(damaged)) {
                EXPECT_LE(found->size(), damaged.size());
            }
        }
    }
    EXPECT_FALSE(stateTextIn(""));
    EXPECT_FALSE(stateTextIn("a text"));
    EXPECT_FALSE(stateTextIn(file.substr(0, 33))) << "a picture without a state";
}

}  // namespace
}  // namespace oval4d::image
