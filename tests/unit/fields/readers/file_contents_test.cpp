#include "fields/readers/file_contents.hpp"

#include <gtest/gtest.h>

#include <string>

namespace oval4d::fields::test {
namespace {

std::string textOfPart(const FilePart& part) {
    const FileContents contents = FileContents::ofString("0123456789").partialContents(part);
    return {reinterpret_cast<const char*>(contents.bytes.data()), contents.bytes.size()};
}

TEST(FileContents, PartsEndWhereTheFileEnds) {
    EXPECT_TRUE(FilePart{}.isWhole());
    EXPECT_EQ(textOfPart({}), "0123456789");
    EXPECT_EQ(textOfPart({2, 3}), "234");
    EXPECT_EQ(textOfPart({2}), "23456789");
    EXPECT_EQ(textOfPart({8, 5}), "89");
    EXPECT_EQ(textOfPart({10, 1}), "");
    EXPECT_EQ(textOfPart({FilePart::kAll, FilePart::kAll - 1}), "");
    EXPECT_EQ(textOfPart({0, 3, true}), "789");
    EXPECT_EQ(textOfPart({0, 99, true}), "0123456789");
}

}  // namespace
}  // namespace oval4d::fields::test
