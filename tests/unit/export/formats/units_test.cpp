// Tests of the units in tables and VTK files of fields.

#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "export/formats/formats.hpp"
#include "fields/array_field.hpp"
#include "unit/export/support.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::exports;

// Returns the field x² + y² + z², made from an array whose box has the length `time` along w. The object has the length
// 2 along w.
fields::Field fieldWithUnits(double time, const fields::AxisUnits& units, const fields::Quantity& quantity,
                             bool hasSecond = false) {
    fields::FieldArray array;
    array.shape = {3, 3, 3, 2};
    array.box = {glm::dvec4(-1, -1, -1, 0), glm::dvec4(1, 1, 1, time)};
    std::vector<float> samples;
    for (int w = 0; w < 2; ++w) {
        for (int z = -1; z < 2; ++z) {
            for (int y = -1; y < 2; ++y) {
                for (int x = -1; x < 2; ++x) samples.push_back(static_cast<float>(x * x + y * y + z * z));
            }
        }
    }
    array.samples = fields::SampleStorage(std::move(samples));
    array.units = units;
    array.quantity = quantity;
    fields::Field field = *fields::fieldFromArray("run", array);
    array.quantity = {"pressure", "Pa"};
    if (hasSecond) {
        EXPECT_FALSE(fields::setSecondArray(field, array, "p"));
    }
    return field;
}

// Returns the exported file of the focus slice with the level 0.5.
std::string fileOf(const fields::Field& field, const std::string& format) {
    const slicing::Object object = std::make_shared<const fields::Field>(field);
    const geometry::Hyperplanes planes{0, 1, 1};
    scene::Look look;
    look.field.levels = {0.5};
    slicing::SurfaceDetail detail;
    slicing::setUniformDetail(slicing::infoOf(object).circumradius, planes, slicing::Quality::draft, detail);
    detail.secondValues = field.second != nullptr;
    slicing::SliceSet slices;
    slicing::Slicer().slice(object, {}, planes, look.field, detail, slices);
    scene::Scene scene;
    scene::Composer().compose(object, {}, slices, 0, look, {}, scene);
    return support::bytesOf(exports::exportScene(scene, object, {},
                                                 {.format = formatNamed(format), .contents = ExportContentsKind::focus},
                                                 support::kUnhurried, {}));
}

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

const fields::Quantity kTemperature{"temperature", "K"};

TEST(Csv, endsWithTheKnownUnits) {
    const std::string own = "n,w,volume,area,centroid_x,centroid_y,centroid_z,components,euler";
    EXPECT_EQ(linesOf(fileOf(fieldWithUnits(9, {}, {}), "csv")).at(0), own + ",box_w");
    const auto lines = linesOf(fileOf(fieldWithUnits(9, {"m", "m", "m", "s"}, kTemperature), "csv"));
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0], own + ",box_w,box_w_unit,length_unit,level_unit") << "w is scaled, and not in seconds";
    EXPECT_TRUE(lines[1].ends_with(R"(,4.5,"s","m","K")")) << lines[1];
    const auto scaled = linesOf(fileOf(fieldWithUnits(2, {"m", "km", "m", "s"}, kTemperature, true), "csv"));
    EXPECT_EQ(scaled.at(0), own + ",mean_second_value,box_w,w_unit,box_w_unit,level_unit,mean_second_value_unit");
    EXPECT_TRUE(scaled.at(1).ends_with(R"(,1,"s","s","K","Pa")")) << scaled.at(1);
}

TEST(Csv, quotesHostileUnits) {
    const auto lastOf = [](const std::string& unit) {
        return linesOf(fileOf(fieldWithUnits(9, {}, {"", unit}), "csv")).at(1);
    };
    EXPECT_TRUE(lastOf(R"(a,"b)").ends_with(R"(,"a,""b")"));
    EXPECT_TRUE(lastOf("=1+1").ends_with(R"(,"'=1+1")")) << "no formula of a spreadsheet";
}

TEST(Vtk, hasTheUnitsOfArrays) {
    const auto contains = [](const std::string& text, const std::string& part) {
        return text.find(part) != std::string::npos;
    };
    const std::string unit = R"(<InformationKey name="UNITS_LABEL" location="vtkDataArray">)";
    const fields::Field field = fieldWithUnits(9, {"m", "m", "m", "s"}, {"a < b", "K & \"C\""}, true);
    for (const std::string format : {"vtp", "vti"}) {
        const std::string file = fileOf(field, format);
        EXPECT_TRUE(contains(file, R"(Name="value" NumberOfComponents="1" ComponentName0="a &lt; b" format="binary">)"))
            << format;
        EXPECT_TRUE(contains(file, unit + "K &amp; &quot;C&quot;</InformationKey>\n</DataArray>")) << format;
        EXPECT_FALSE(contains(fileOf(fieldWithUnits(9, {}, {}), format), "InformationKey")) << format;
    }
    const std::string surfaces = fileOf(field, "vtp");
    EXPECT_TRUE(contains(surfaces, R"(Name="second_value" NumberOfComponents="1" ComponentName0="pressure")"));
    EXPECT_TRUE(contains(surfaces, unit + "Pa<"));
    EXPECT_TRUE(contains(surfaces, unit + "m<")) << "of the points";
    EXPECT_FALSE(contains(surfaces, unit + "s<")) << "w is scaled";
}

}  // namespace
