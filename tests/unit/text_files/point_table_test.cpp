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
        for (const std::string& warning : readPoints(decodePlainText(bytes), {.maxPoints = 3, .radii = radii}, add))
            result += warning + '\n';
    } catch (const FileError& error) {
        return fileErrorText(error);
    }
    return result;
}

constexpr const char* kRow = "0.5 1.0 -2.0 3.0 r 0.0\n";

TEST(Columns, AreSeparatedByBlanksCommasSemicolonsOrTabs) {
    for (const char* row :
         {"0.5 1 -2 3", "  .5\t1 -2  3 ", "0.5,1,-2,3", "0.5, 1, -2, 3,", "0.5;1;-2;3", "0.5 ; 1 ; -2 ; 3;",
          "0.5\t1\t-2\t3", "\"0.5\",\"1\",\"-2\",\"3\"", "0.5 1 -2 3 # a comment", "0.5 1 -2 3\r\n", "0.5 1 -2 3\r",
          "% a # comment\n0.5 1 -2 3", "+5e-1 1E0 -2.0D+00 3d0", "0.5\v1\f-2 3", "0.5\u00A01\u202F\u22122 3",
          "\uFEFF0.5 1 -2 3", "0.5 1 -2 3;"})
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

TEST(Columns, FollowAHeaderBelowTitles) {
    const std::string said = std::string(kRow) + "line 1, 'Results of the run', has no numbers and was left out\n";
    for (const char* header : {"w,x,y,z\n", "\nw,x,y,z\n", "# w,x,y,z\n", "# a comment\nw,x,y,z\n"})
        EXPECT_EQ(read("Results of the run\n" + std::string(header) + "3,0.5,1,-2\n"), said) << header;
    EXPECT_EQ(read("sep=;\nw;x;y;z\n3;0,5;1;-2\n"), kRow);
    EXPECT_EQ(read("\uFEFFSEP=,\r\nw,x,y,z\r\n3,.5,1,-2\r\n"), kRow);
    EXPECT_EQ(read("sep=\t\nw\tx\ty\tz\n3\t.5\t1\t-2\n"), kRow);
    EXPECT_EQ(read("sep=;\n0,5;1;-2;3\n"), kRow);
    std::string text;
    for (int line = 0; line < 11; ++line) text += "Some words\n";
    EXPECT_EQ(read(text + "0.5 1 -2 3\n"), "line 11: a point has 2 coordinates; four are needed");
}

// A column that a header leaves out may be text, with any separator.
TEST(Columns, MayBeTextIfTheyAreLeftOut) {
    const std::string said = std::string(kRow) + "these columns were left out: 'name'\n";
    for (const char* row :
         {"name,x,y,z,w\nH,.5,1,-2,3\n", "name;x;y;z;w\nH;.5;1;-2;3\n", "name;x;y;z;w\nH;0,5;1;-2;3\n",
          "name\tx\ty\tz\tw\nH 2\t.5\t1\t-2\t3\n", "name\tx\ty\tz\tw\nH\t0,5\t1\t-2\t3\n",
          "name x y z w\nH .5 1 -2 3\n", "name x y z w\nH 0,5 1 -2 3\n", "name,x,y,z,w\n\"H, O\",.5,1,-2,3\n",
          "name x y z w\n\"H, O\" .5 1 -2 3\n", "name;x;y;z;w\n\"H;O\";0,5;1;-2;3\n",
          "name,x,y,z,w\nHydrogen atom number 1,.5,1,-2,3\n", "name,x,y,z,w\n2024-01-01,.5,1,-2,3\n",
          "x,y,z,w,name\n.5,1,-2,3,\"a, b\"\n"})
        EXPECT_EQ(read(row), said) << row;
    EXPECT_EQ(read("name,x,y,z,w\nH,1,0,0\n"), "line 2: the row has 4 columns, but the header names 5");
    EXPECT_EQ(read("H,1,0,0,0\n"), "line 1, column 1: 'H' is not a number");
    EXPECT_EQ(read("Results of the run, in mm\n.5 1 -2 3\n"),
              std::string(kRow) + "line 1, 'Results of the run, in mm', has no numbers and was left out\n");
}

TEST(Columns, BetweenTabsMayBeTextsWithCommasAndSemicolons) {
    const std::string leftOut = "these columns were left out: 'name'\n";
    for (const char* table :
         {"name\tx\ty\tz\tw\nParis, France\t0.5\t1\t-2\t3\n", "x\ty\tz\tw\tname\n0.5\t1\t-2\t3\ta; b, c\n",
          "x\ty\tz\tw\tname\n0,5\t1\t-2,0\t3\tParis, France\n"})
        EXPECT_EQ(read(table), kRow + leftOut) << table;
    for (const char* row : {"0.5,\t1,\t-2,\t3", "0.5;\t1;\t-2;\t3"}) EXPECT_EQ(read(row), kRow) << row;
}

TEST(Columns, MayBeNamedByAComment) {
    for (const char* comment :
         {"# w x y z", "# w, x, y, z", "# columns: w x y z", "# columns w x y z", "# (w, x, y, z)",
          "# columns = (w,x,y,z)", "# w x y z\n# another comment", "# w x y z\n\n", "# a comment\n# w x y z\n\n# x y z",
          "# t[s] x[m] y[m] z[m]", "% w x y z", " %w, x, y, z"})
        EXPECT_EQ(read(std::string(comment) + "\n3 .5 1 -2\n"), kRow) << comment;
    for (const char* comment : {"# columns x y z w of run", "# x y z w", "# the points x y z w and others", "# x"})
        EXPECT_EQ(read(std::string(comment) + "\n.5 1 -2 3\n"), kRow) << comment;
    EXPECT_EQ(read("# sorted by w x y z\n.5 1 -2 3\n"),
              std::string(kRow) +
                  "the comment in line 1 does not name each column of the rows, and was not read as a header\n");
    EXPECT_EQ(read("# x y z w name\n.5 1 -2 3 H\n"), std::string(kRow) + "these columns were left out: 'name'\n");
}

TEST(Columns, AreNamedWithOrWithoutUnits) {
    for (const char* header :
         {"t[s],x[m],y[m],z[m]", "t [s],x [m],y [m],z [m]", "t (s), x (m), y (m), z (m)", "t [s] x [m] y [m] z [m]",
          "t [m / s] x y z", "t/s;x/m;y/m;z/m", "\"w [m]\",x,y,z", "w(mm)\tx(mm)\ty(mm)\tz(mm)"})
        EXPECT_EQ(read(std::string(header) + "\n3,.5,1,-2\n"), kRow) << header;
    EXPECT_EQ(read("x[m] y[m] z[m] w[m] r[m]\n.5 1 -2 3 .1\n"), "0.5 1.0 -2.0 3.0 r 0.1\n");
    for (const char* header : {"2theta x y z w", "2theta,x,y,z,w", "2theta [deg] x y z w"})
        EXPECT_EQ(read(std::string(header) + "\n9 .5 1 -2 3\n").substr(0, 23), kRow) << header;
    EXPECT_EQ(read("1x 2x 3x 4x\n1 2 3 4\n"), "line 1, column 1: '1x' is not a number");
}

TEST(Columns, MayLackTheRadiusUnderAHeaderToo) {
    const std::string both = "0.5 1.0 -2.0 3.0 r 0.1\n" + std::string(kRow);
    for (const char* header : {"x y z w r", "x,y,z,w,radius", "# x y z w r"}) {
        EXPECT_EQ(read(std::string(header) + "\n.5 1 -2 3 .1\n.5 1 -2 3\n"), both) << header;
        EXPECT_EQ(read(std::string(header) + "\n.5 1 -2 3\n"), kRow) << header;
    }
    EXPECT_EQ(read("r x y z w\n.1 .5 1 -2 3\n.5 1 -2 3\n"), "line 3: the row has 4 columns, but the header names 5");
    EXPECT_EQ(read("x,y,z,w,r\n.5,1,-2,3,.1\n.5,1,-2,3\n"), "line 3: the row has 4 columns, but the header names 5");
    EXPECT_EQ(read("x y z w r\n.5 1 -2 3 .1\n.5 1 -2\n"), "line 3: the row has 3 columns, but the header names 5");
}

TEST(Columns, AreSeparatedByBlanksEvenIfAWordHasAComma) {
    EXPECT_EQ(read("1 0 0 0\n0 1,5m 1 0\n"), "line 2, column 2: '1,5m' is not a number");
    EXPECT_EQ(read("name x y z w\na,b .5 1 -2 3\n"), std::string(kRow) + "these columns were left out: 'name'\n");
}

TEST(Columns, WithBracketsAreNotTakenForDecimalCommas) {
    EXPECT_EQ(read("(1, 0, 0, 0)\n"), "line 1, column 1: '(1' is not a number");
    EXPECT_EQ(read("[1, 0, 0, 0],\n[0, 1, 0, 0]\n"), "line 1, column 1: '[1' is not a number");
}

TEST(Columns, AreRefusedWithLineAndColumn) {
    EXPECT_EQ(read("1,2,3,4\n1,,3,4\n"), "line 2, column 2: the column is empty");
    EXPECT_EQ(read("1\t2\t3\t4\n1\t\t3\t4\n"), "line 2, column 2: the column is empty");
    EXPECT_EQ(read("1;2;3;4;5\n1;2;3;4;\n"), "line 2, column 5: the column is empty");
    EXPECT_EQ(read("1 2 3 4\n1 2 x 4\n"), "line 2, column 3: 'x' is not a number");
    EXPECT_EQ(read("nan 0 0 1\n"), "line 1, column 1: 'nan' is not a finite number");
    EXPECT_EQ(read("0 0 0 -Infinity\n"), "line 1, column 4: '-Infinity' is not a finite number");
    for (const std::string word : {"nan(ind)", "-nan(ind)", "NaN(snan)", "nan()", "nan(0x7ff)"}) {
        const std::string said = "column 1: '" + word + "' is not a finite number";
        EXPECT_EQ(read(word + " 0 0 1\n"), "line 1, " + said);
        EXPECT_EQ(read("0 0 0 1\n" + word + " 0 0 1\n"), "line 2, " + said);
    }
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

TEST(Numbers, BeyondTheRangeOfADoubleAreToldFromZero) {
    const std::string zeros(400, '0');
    for (const std::string& number :
         {"0." + zeros + "1", "." + zeros + "1e50", "-0." + zeros + "5e+2", "1" + zeros + "e-900"})
        EXPECT_EQ(read(number + " 1 2 3"), read("0 1 2 3")) << number;
    for (const std::string& number : {"1" + zeros, "1" + zeros + "e-5", "1" + zeros + ".5", std::string("0.01e400"),
                                      std::string("1e99999999999999999999")})
        EXPECT_NE(read(number + " 1 2 3").find("is beyond ±1e14"), std::string::npos) << number;
}

TEST(Tables, WithoutRowsAreRefused) {
    EXPECT_EQ(read("x,y,z,w\n"), "the table has a header, but no rows");
    EXPECT_EQ(read("Some words\n"), "the file has no rows of numbers, so it is not a table of points");
    EXPECT_EQ(read("# x y z w\n"), "the file has no rows of numbers, so it is not a table of points");
}

// Text that is not in UTF-8, and files that are not text.

std::string utf16(const std::string& ascii, bool bigEndian, bool mark) {
    std::string bytes = !mark ? "" : bigEndian ? "\xFE\xFF" : "\xFF\xFE";
    for (const char c : ascii) bytes += bigEndian ? std::string{'\0', c} : std::string{c, '\0'};
    return bytes;
}

TEST(PlainText, IsReadFromUtf16) {
    for (const bool bigEndian : {false, true}) {
        for (const bool mark : {false, true}) EXPECT_EQ(decodePlainText(utf16("1 2\r\n3", bigEndian, mark)), "1 2\n3");
    }
}

TEST(PlainText, HasOneKindOfSpace) {
    for (const char* space : {"\u00A0", "\u2000", "\u2002", "\u2007", "\u2009", "\u200A", "\u200B", "\u202F", "\u205F",
                              "\u3000", "\uFEFF", "\v", "\f"})
        EXPECT_EQ(decodePlainText("1" + std::string(space) + "2"), "1 2") << space;
    EXPECT_EQ(decodePlainText("\u2212\u201C\u3001\xE2\x80"), "\u2212\u201C\u3001\xE2\x80");
}

TEST(PlainText, IsNotMadeOfOtherFiles) {
    const auto refusal = [](const std::string& bytes) {
        try {
            decodePlainText(bytes);
        } catch (const FileError& error) {
            return fileErrorText(error);
        }
        return std::string("not refused");
    };
    EXPECT_EQ(refusal(""), "the file is empty");
    EXPECT_EQ(refusal(" \r\n\t"), "the file is empty");
    EXPECT_EQ(refusal("<!DOCTYPE html>\n<p>1 2 3 4"), "the file is an HTML page");
    EXPECT_EQ(refusal(" <svg width=\"3\">"), "the file is an SVG picture");
    EXPECT_EQ(refusal("\xEF\xBB\xBF<?xml version=\"1.0\"?>"),
              "the file is an XML file, such as an SVG picture or a VTK file");
    EXPECT_EQ(refusal("\x1F\x8B\x08"), "the file is compressed with gzip; unpack it first");
    EXPECT_EQ(refusal("\x89PNG\r\n\x1A\n"), "the file is a PNG picture");
    EXPECT_EQ(refusal(std::string("1 2 3 4") + '\0'), "the file is not text: byte 8 is zero");
}

}  // namespace
}  // namespace oval4d::text_files
