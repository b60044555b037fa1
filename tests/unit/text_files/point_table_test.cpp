#include "text_files/point_table.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "text_files/file_error.hpp"
#include "text_files/plain_text.hpp"

namespace oval4d::text_files {
namespace {

// Returns the rows and the warnings of a table, or the reason why it is refused.
std::string read(const std::string& bytes, bool radii = true) {
    std::string result;
    const auto add = [&](const PointRow& row) {
        for (int i = 0; i < 4; ++i) result += std::to_string(row.point[i]).substr(0, row.point[i] < 0 ? 4 : 3) + ' ';
        result += "r " + std::to_string(row.radius).substr(0, 3) + '\n';
    };
    try {
        for (const std::string& warning : readPoints(plainText(bytes), {.maxPoints = 3, .radii = radii}, add))
            result += warning + '\n';
    } catch (const FileError& error) {
        return message(error);
    }
    return result;
}

constexpr const char* kRow = "0.5 1.0 -2.0 3.0 r 0.0\n";

TEST(Columns, AreSeparatedByBlanksCommasSemicolonsOrTabs) {
    for (const char* row :
         {"0.5 1 -2 3", "  .5\t1 -2  3 ", "0.5,1,-2,3", "0.5, 1, -2, 3,", "0.5;1;-2;3", "0.5 ; 1 ; -2 ; 3;",
          "0.5\t1\t-2\t3", "\"0.5\",\"1\",\"-2\",\"3\"", "0.5 1 -2 3 # a comment", "0.5 1 -2 3\r\n", "0.5 1 -2 3\r",
          "+5e-1 1E0 -2.0D+00 3d0", "0.5\v1\f-2 3", "0.5\u00A01\u202F\u22122 3", "\uFEFF0.5 1 -2 3", "0.5 1 -2 3;"})
        EXPECT_EQ(read(row), kRow) << row;
}

TEST(Columns, MayHaveDecimalCommasUnlessCommasSeparateThem) {
    for (const char* row : {"0,5;1;-2;3", "0,5;1,0;-2,0;3,0", "0,5\t1\t-2\t3", "0,5 1 -2,0 3", "\"0,5\";1;-2;3"})
        EXPECT_EQ(read(row), kRow) << row;
    EXPECT_EQ(read("1.234,5;1;2;3"),
              "line 1, column 1: '1.234,5' has a comma and a point; write numbers without separators of thousands");
    EXPECT_EQ(read("\"0,5\",1,2,3"), "line 1, column 1: '0,5' has a decimal comma; write a decimal point");
}

TEST(Columns, FollowTheHeader) {
    for (const char* header :
         {"w,x,y,z", "W, X, Y, Z", "\"w\",\"x\",\"y\",\"z\"", "w x y z", "w;x;y;z", "# w x y z", "t,x,y,z"})
        EXPECT_EQ(read(std::string(header) + "\n3,0.5,1,-2\n"), kRow) << header;
    EXPECT_EQ(read(",id,x,y,z,w,r\n0,9,0.5,1,-2,3,0.1\n"),
              "0.5 1.0 -2.0 3.0 r 0.1\nthese columns were left out: column 1, 'id'\n");
    EXPECT_EQ(read("x y z w r\n0.5 1 -2 3 0.1\n", false), std::string(kRow) + "these columns were left out: 'r'\n");
    EXPECT_EQ(read("Results of the run\n0.5 1 -2 3\n"),
              std::string(kRow) + "line 1, 'Results of the run', has no numbers and was left out\n");
    EXPECT_EQ(read("x y z\n1 2 3\n"), "line 1: the header names no column w; it must name x, y, z and w");
    EXPECT_EQ(read("x y z w\n1 2 3\n"), "line 2: the row has 3 columns, but the header names 4");
}

TEST(Columns, AreRefusedWithLineAndColumn) {
    EXPECT_EQ(read("1,2,3,4\n1,,3,4\n"), "line 2, column 2: the column is empty");
    EXPECT_EQ(read("1\t2\t3\t4\n1\t\t3\t4\n"), "line 2, column 2: the column is empty");
    EXPECT_EQ(read("1;2;3;4;5\n1;2;3;4;\n"), "line 2, column 5: the column is empty");
    EXPECT_EQ(read("1 2 3 4\n1 2 x 4\n"), "line 2, column 3: 'x' is not a number");
    EXPECT_EQ(read("nan 0 0 1\n"), "line 1, column 1: 'nan' is not a finite number");
    EXPECT_EQ(read("0 0 0 -Infinity\n"), "line 1, column 4: '-Infinity' is not a finite number");
    EXPECT_EQ(read("1e15 0 0 1\n"), "line 1, column 1: '1e15' is beyond ±1e14, the range of coordinates");
    EXPECT_EQ(read("0 0 0 \u00FCber\n"), "line 1, column 4: '\u00FCber' is not a number");
    EXPECT_EQ(read("0 0 0 +-1\n"), "line 1, column 4: '+-1' is not a number");
    EXPECT_EQ(read("1 2 3 4 -5\n"), "line 1, column 5: a radius is negative");
    EXPECT_EQ(read("1 2 3 4 5\n", false),
              "line 1: '5' follows a point's four coordinates; a header x y z w says which columns to read");
}

// Each separator but blanks keeps the place of an empty column.
TEST(Columns, AreNotShiftedByEmptyOnes) {
    for (const char separator : {',', ';', '\t'}) {
        const auto table = [&](std::string text) {
            std::ranges::replace(text, ',', separator);
            return read(text);
        };
        EXPECT_EQ(table("1,2,3,4,5\n,.2,.3,.4,.5\n"), "line 2, column 1: the column is empty") << separator;
        EXPECT_EQ(table("1,2,3,4,5\n1,2,3,4,\n"), "line 2, column 5: the column is empty") << separator;
        EXPECT_EQ(table("1,2,3,4,5\n1,2,3,4\n"), "line 2: the row has 4 columns, but the first row has 5") << separator;
        EXPECT_EQ(table("1,2,3,4\n1,2,3,4,5\n"), "line 2: the row has 5 columns, but the first row has 4") << separator;
        EXPECT_EQ(table("1,2,3,4\n1,2,3,\n"), "line 2, column 4: the column is empty") << separator;
        EXPECT_EQ(table(" .5 , 1,-2,3,,\n"), kRow) << separator;
        EXPECT_EQ(table(",x,y,z,w\n0,.5,1,-2,3\n"), std::string(kRow) + "these columns were left out: column 1\n")
            << separator;
        EXPECT_EQ(table("id,x,y,z,w,name\n,.5,1,-2,3,\n"),
                  std::string(kRow) + "these columns were left out: 'id', 'name'\n")
            << separator;
    }
    EXPECT_EQ(read("1,2,3,4\n,,,\n"), "line 2, column 1: the column is empty");
    EXPECT_EQ(read("0.5 1 -2 3 0.1\n0.5 1 -2 3\n"),
              "0.5 1.0 -2.0 3.0 r 0.1\n0.5 1.0 -2.0 3.0 r 0.0\nthe fifth column was read as radius\n");
}

TEST(Columns, AreReadWholeIfTheyOnlyBeginWithQuotes) {
    EXPECT_EQ(read("1,2,3,\"4\"5\n"), "line 1, column 4: '\"4\"5' is not a number");
}

TEST(Tables, AreRefusedIfTheyHaveTooManyRows) {
    EXPECT_EQ(read("1 2 3 4\n1 2 3 4\n1 2 3 4\n\n1 2 3 4\n"), "line 5: there are more than 3 points, the most allowed");
}

TEST(Columns, TakenForARadiusAreTold) {
    EXPECT_EQ(read("0.5 1 -2 3 0.1\n"), "0.5 1.0 -2.0 3.0 r 0.1\nthe fifth column was read as radius\n");
}

TEST(Numbers, TooSmallForADoubleAreZero) {
    for (const char* number : {"1e-400", "1E-400", "-1D-400", "1e\u2212400"})
        EXPECT_EQ(read(std::string(number) + " 1 2 3"), read("0 1 2 3")) << number;
}

// Text that is not in UTF-8, and files that are not text.

std::string utf16(const std::string& ascii, bool bigEndian, bool mark) {
    std::string bytes = !mark ? "" : bigEndian ? "\xFE\xFF" : "\xFF\xFE";
    for (const char c : ascii) bytes += bigEndian ? std::string{'\0', c} : std::string{c, '\0'};
    return bytes;
}

TEST(PlainText, IsReadFromUtf16) {
    for (const bool bigEndian : {false, true}) {
        for (const bool mark : {false, true}) EXPECT_EQ(plainText(utf16("1 2\r\n3", bigEndian, mark)), "1 2\n3");
    }
}

TEST(PlainText, IsNotMadeOfOtherFiles) {
    const auto refusal = [](const std::string& bytes) {
        try {
            plainText(bytes);
        } catch (const FileError& error) {
            return message(error);
        }
        return std::string("not refused");
    };
    EXPECT_EQ(refusal(""), "the file is empty");
    EXPECT_EQ(refusal(" \r\n\t"), "the file is empty");
    EXPECT_EQ(refusal("\x1F\x8B\x08"), "the file is compressed with gzip; unpack it first");
    EXPECT_EQ(refusal("\x89PNG\r\n\x1A\n"), "the file is a PNG picture");
    EXPECT_EQ(refusal(std::string("1 2 3 4") + '\0'), "the file is not text: byte 8 is zero");
}

}  // namespace
}  // namespace oval4d::text_files
