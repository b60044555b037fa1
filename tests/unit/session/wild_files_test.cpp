// Tests with files of other people and programs, in tests/wild: the object that is read from each file, or the reason
// why the file is refused.

#include <array>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "session/load.hpp"

namespace oval4d::session {
namespace {

struct WildFile {
    const char* name;
    /// The numbers of vertices, edges, 2-faces and cells, followed by warnings; or the error message.
    const char* right;
};

constexpr const char* k5Cell = "5/10/10/5";
constexpr const char* k16Cell = "8/24/32/16";

const auto kFiles = std::to_array<WildFile>({
    {"all-on-one-line.off", k5Cell},
    {"two-vertices-per-line.off", k5Cell},
    {"24-cell-float32-as-18e.txt", "24/96/96/24"},
    {"tesseract-float32-as-9g.txt", "16/32/24/8"},
    {"tesseract-float32-as-12f.txt", "16/32/24/8"},
    {"cloud-of-names.csv", "2/0/0/0; these columns were left out: 'name'"},
    {"comment-with-names.txt", k16Cell},
    {"short-vertex.off", "line 3: vertex 0 has 3 of 4 coordinates"},
    {"cloud-empty-field.txt", "line 2, column 2: the column is empty"},
    {"cloud-header.txt", "2/0/0/0"},
    {"cloud-index-without-header.txt", "2/0/0/0; the fifth column was read as radius"},
    {"columns-named-w-x-y-z.txt", k16Cell},
    {"first-line-minus-sign.txt", k16Cell},
    {"first-line-nan.txt", "line 1, column 1: 'nan' is not a finite number"},
    {"first-line-fortran-D.txt", k16Cell},
    {"exponent-lower-case.txt", k16Cell},
    {"exponent-upper-case.txt", k16Cell},
    {"decimal-comma-all-columns.txt", k5Cell},
    {"decimal-comma-one-column.txt", "1/0/0/0"},
    {"R&D.off", k5Cell},
    {"C4OFF.off", k5Cell},
    {"glued.txt", k5Cell},
    {"lower-case.off", k5Cell},
    {"nOFF.off",
     "line 1: 'nOFF' cannot be read; a file must begin with 4OFF, or be a list of points x y z w, whose convex hull is "
     "shown"},
    {"wrong-line-number.off", "line 2: 'foo' is not a number of vertices"},
    {"utf16le.off", k5Cell},
    {"toward-cell-duoprism-4-decimals.txt", "9/18/15/6"},
    {"16-cell-10-from-origin.txt",
     "8/24/32/16; the object is far from the origin: it turns about its center, (10, 10, 0, 0), where the middle of "
     "the slices is, too; the option center=origin keeps the origin"},
    {"nearly-flat-cell.off",
     "6/13/13/6; 5 vertices were moved by up to 0.00005, so that the vertices of each cell lie in one hyperplane"},
});

class WildFiles : public testing::TestWithParam<WildFile> {};

TEST_P(WildFiles, AreReadRightOrRefusedWithTheReason) {
    std::ifstream file(std::string(OVAL4D_SOURCE_DIR) + "/tests/wild/" + GetParam().name, std::ios::binary);
    ASSERT_TRUE(file);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const auto read = readObject({"mine", std::string(detectTextFormat(bytes)), bytes}, Limits{});
    std::ostringstream found;
    if (read) {
        const auto counts = slicing::elementCounts(read->object);
        found << counts[0] << '/' << counts[1] << '/' << counts[2] << '/' << counts[3];
        for (const std::string& warning : read->warnings) found << "; " << warning;
    } else {
        found << read.error().message;
    }
    EXPECT_EQ(found.str(), GetParam().right);
}

INSTANTIATE_TEST_SUITE_P(All, WildFiles, testing::ValuesIn(kFiles));

}  // namespace
}  // namespace oval4d::session
