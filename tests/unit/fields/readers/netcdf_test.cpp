// Tests of the reader of NetCDF files; the NetCDF library writes the files.

#include "fields/readers/netcdf.hpp"

#include <gtest/gtest.h>
#include <netcdf.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "fields/array_field.hpp"
#include "unit/fields/readers/written_formats.hpp"

namespace oval4d::fields::test {
namespace {

TEST(Netcdf, FollowsTheConventions) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    int file = 0;
    check(nc_create(path.c_str(), NC_CLOBBER | NC_NETCDF4, &file));
    const std::array<const char*, 4> names{"lon", "hours", "latitude", "nv"};
    const std::array<std::size_t, 4> sizes{4, 3, 2, 2};
    std::array<int, 4> dimensions{};
    std::array<int, 3> coordinates{};
    for (std::size_t i = 0; i < 4; ++i) check(nc_def_dim(file, names[i], sizes[i], &dimensions[i]));
    for (std::size_t i = 0; i < 3; ++i)
        check(nc_def_var(file, names[i], NC_DOUBLE, 1, &dimensions[i], &coordinates[i]));
    const auto setText = [&](int variable, const char* name, const std::string& text) {
        check(nc_put_att_text(file, variable, name, text.size(), text.c_str()));
    };
    setText(coordinates[0], "units", "degrees_east");
    setText(coordinates[1], "units", "hours since 2020-01-01");
    setText(coordinates[2], "standard_name", "latitude");
    setText(coordinates[2], "bounds", "latitude_bounds");
    int bounds = 0, variable = 0;
    const std::array<int, 2> ofBounds{dimensions[2], dimensions[3]};
    check(nc_def_var(file, "latitude_bounds", NC_DOUBLE, 2, ofBounds.data(), &bounds));
    check(nc_def_var(file, "sst", NC_SHORT, 3, dimensions.data(), &variable));
    setText(variable, "long_name", "sea surface temperature");
    setText(variable, "units", "K");
    const short fill = -999, range[2] = {-500, 100};
    const double scale = 0.01, offset = 273.15;
    check(nc_put_att_short(file, variable, "_FillValue", NC_SHORT, 1, &fill));
    check(nc_put_att_short(file, variable, "valid_range", NC_SHORT, 2, range));
    check(nc_put_att_double(file, variable, "scale_factor", NC_DOUBLE, 1, &scale));
    check(nc_put_att_double(file, variable, "add_offset", NC_DOUBLE, 1, &offset));
    check(nc_enddef(file));
    const std::array<double, 4> lon{10, 20, 30, 40};
    const std::array<double, 3> hours{0, 6, 12};
    const std::array<double, 2> latitude{50, 40};  // latitudes decrease, from north to south
    check(nc_put_var_double(file, coordinates[0], lon.data()));
    check(nc_put_var_double(file, coordinates[1], hours.data()));
    check(nc_put_var_double(file, coordinates[2], latitude.data()));
    std::array<short, 24> stored{};
    for (std::size_t i = 0; i < 24; ++i) stored[i] = static_cast<short>(i);
    stored[3] = fill;
    stored[4] = 101;
    check(nc_put_var_short(file, variable, stored.data()));
    check(nc_close(file));

    const auto field = readOrFail(readFile(path));
    EXPECT_EQ(field.shape, (Shape{4, 2, 1, 3}));
    EXPECT_EQ(field.box, (Box{{10, 40, 0, 0}, {40, 50, 0, 12}}));
    EXPECT_TRUE(field.boxIsKnown);
    EXPECT_EQ(field.units, (std::array<std::string, 4>{"degrees_east", "", "", "hours since 2020-01-01"}));
    EXPECT_EQ(field.quantity.name, "sea surface temperature");
    EXPECT_EQ(field.quantity.unit, "K");
    EXPECT_TRUE(field.warnings.empty()) << field.warnings.front();
    for (std::size_t x = 0; x < 4; ++x) {
        for (std::size_t t = 0; t < 3; ++t) {
            for (std::size_t y = 0; y < 2; ++y) {
                const short number = stored.at((x * 3 + t) * 2 + (1 - y));  // the field has y in ascending order, the
                                                                            // file in descending order
                const float sample = field.samples.values()[x + 4 * (y + 2 * t)];
                if (number == fill || number > 100)
                    EXPECT_TRUE(std::isnan(sample));
                else
                    EXPECT_EQ(sample, static_cast<float>(number * scale + offset));
            }
        }
    }
    EXPECT_EQ(readOrFail(readFile(path), {.axes = "xyz"}).shape, (Shape{4, 3, 2, 1}));
    EXPECT_EQ(readOrFail(readFile(path), {.variable = "/hours"}).shape, (Shape{1, 1, 1, 3}));
    const auto missing = readField(FileContents::copyOf(readFile(path)), {.variable = "salinity"});
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::not_found);
}

TEST(Netcdf, ANameAloneMakesNoCoordinates) {
    const std::array<float, 2> samples{1, 2};
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    int file = 0, x = 0, other = 0, variable = 0, coordinate = 0;
    check(nc_create(path.c_str(), NC_CLOBBER, &file));
    check(nc_def_dim(file, "x", 2, &x));
    check(nc_def_dim(file, "n", 100'000, &other));
    check(nc_def_var(file, "f", NC_FLOAT, 1, &x, &variable));
    check(nc_def_var(file, "x", NC_DOUBLE, 1, &other, &coordinate));
    check(nc_enddef(file));
    check(nc_put_var_float(file, variable, samples.data()));
    check(nc_close(file));
    const auto field = readOrFail(readFile(path), {.variable = "f"});
    EXPECT_EQ(field.shape, (Shape{2, 1, 1, 1}));
    EXPECT_FALSE(field.boxIsKnown);
}

TEST(Netcdf, TheDimensionOfAGroupIsNotTheOuterOneOfTheSameName) {
    const std::array<float, 2> samples{1, 2};
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    int file = 0, group = 0, outer = 0, inner = 0, variable = 0, coordinate = 0;
    check(nc_create(path.c_str(), NC_CLOBBER | NC_NETCDF4, &file));
    check(nc_def_dim(file, "x", 2, &outer));
    check(nc_def_grp(file, "g", &group));
    check(nc_def_dim(group, "x", 100'000, &inner));
    check(nc_def_var(group, "f", NC_FLOAT, 1, &outer, &variable));
    check(nc_def_var(group, "x", NC_DOUBLE, 1, &inner, &coordinate));
    check(nc_enddef(file));
    check(nc_put_var_float(group, variable, samples.data()));
    check(nc_close(file));
    const auto field = readOrFail(readFile(path), {.variable = "g/f"});
    EXPECT_EQ(field.shape, (Shape{2, 1, 1, 1}));
    EXPECT_FALSE(field.boxIsKnown);
}

TEST(Netcdf, VariablesAndCoordinatesMayBeInGroups) {
    const std::array<float, 6> samples{1, 2, 3, 4, 5, 6};
    const std::array<double, 3> at{10, 20, 30};
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    int file = 0, outer = 0, inner = 0, coordinate = 0, flat = 0, variable = 0;
    std::array<int, 2> dimensions{};
    check(nc_create(path.c_str(), NC_CLOBBER | NC_NETCDF4, &file));
    check(nc_def_dim(file, "y", 2, &dimensions[0]));
    check(nc_def_dim(file, "x", 3, &dimensions[1]));
    check(nc_def_grp(file, "run", &outer));
    check(nc_def_grp(outer, "last", &inner));
    check(nc_def_var(file, "x", NC_DOUBLE, 1, &dimensions[1], &coordinate));
    check(nc_def_var(outer, "mean", NC_FLOAT, 1, &dimensions[1], &flat));
    check(nc_def_var(inner, "f", NC_FLOAT, 2, dimensions.data(), &variable));
    check(nc_enddef(file));
    check(nc_put_var_double(file, coordinate, at.data()));
    check(nc_put_var_float(inner, variable, samples.data()));
    check(nc_close(file));
    const auto field = readOrFail(readFile(path));
    EXPECT_EQ(field.shape, (Shape{3, 2, 1, 1}));
    EXPECT_EQ(field.box, (Box{{10, 0, 0, 0}, {30, 1, 0, 0}}));
    EXPECT_TRUE(field.boxIsKnown);
    ASSERT_EQ(field.warnings.size(), 1);
    EXPECT_NE(field.warnings.front().find("run/last/f"), std::string::npos) << field.warnings.front();
    EXPECT_EQ(readOrFail(readFile(path), {.variable = "run/last/f"}).box, field.box);
}

TEST(Netcdf, PackedCoordinatesAreUnpacked) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    int file = 0, variable = 0;
    std::array<int, 2> dimensions{}, coordinates{};
    check(nc_create(path.c_str(), NC_CLOBBER, &file));
    const std::array<const char*, 2> names{"y", "x"};
    const std::array<std::size_t, 2> sizes{2, 3};
    const std::array<double, 2> scales{-0.5, 0.25}, offsets{3, -1};
    for (std::size_t i = 0; i < 2; ++i) {
        check(nc_def_dim(file, names[i], sizes[i], &dimensions[i]));
        check(nc_def_var(file, names[i], NC_SHORT, 1, &dimensions[i], &coordinates[i]));
        check(nc_put_att_double(file, coordinates[i], "scale_factor", NC_DOUBLE, 1, &scales[i]));
        check(nc_put_att_double(file, coordinates[i], "add_offset", NC_DOUBLE, 1, &offsets[i]));
    }
    check(nc_def_var(file, "f", NC_FLOAT, 2, dimensions.data(), &variable));
    check(nc_enddef(file));
    const std::array<short, 3> stored{0, 1, 2};
    const std::array<float, 6> samples{0, 1, 2, 3, 4, 5};
    for (const int coordinate : coordinates) check(nc_put_var_short(file, coordinate, stored.data()));
    check(nc_put_var_float(file, variable, samples.data()));
    check(nc_close(file));
    const auto field = readOrFail(readFile(path));
    EXPECT_EQ(field.box, (Box{{-1, 2.5, 0, 0}, {-0.5, 3, 0, 0}}));
    const auto values = field.samples.values();
    EXPECT_EQ(std::vector(values.begin(), values.end()), (std::vector<float>{3, 4, 5, 0, 1, 2}));  // y decreases in the
                                                                                                   // file
}

// Returns the bytes of a file with a variable f(time, x) at two times.
std::string fileOfTimes(const std::array<double, 2>& times, const std::string& units) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    int file = 0, coordinate = 0, variable = 0;
    std::array<int, 2> dimensions{};
    check(nc_create(path.c_str(), NC_CLOBBER, &file));
    check(nc_def_dim(file, "time", 2, &dimensions[0]));
    check(nc_def_dim(file, "x", 2, &dimensions[1]));
    check(nc_def_var(file, "time", NC_DOUBLE, 1, dimensions.data(), &coordinate));
    check(nc_def_var(file, "f", NC_FLOAT, 2, dimensions.data(), &variable));
    check(nc_put_att_text(file, coordinate, "units", units.size(), units.data()));
    check(nc_enddef(file));
    const std::array<float, 4> samples{0, 1, 2, 3};
    check(nc_put_var_double(file, coordinate, times.data()));
    check(nc_put_var_float(file, variable, samples.data()));
    check(nc_close(file));
    return readFile(path);
}

// Times that are far from 0 are counted from the first time. As 32-bit floats, hours since 1900 are an eighth of an
// hour apart.
TEST(Netcdf, TimesFarFromZeroAreCountedFromTheFirst) {
    const auto hours = readOrFail(fileOfTimes({1'087'824, 1'087'825}, "hours since 1900-01-01"));
    EXPECT_EQ(hours.box.min.w, 0);
    EXPECT_EQ(hours.box.max.w, 1);
    EXPECT_EQ(hours.units[3], "hours");
    ASSERT_EQ(hours.warnings.size(), 1U);
    EXPECT_NE(hours.warnings.front().find("1087824 hours since 1900-01-01"), std::string::npos);
    EXPECT_TRUE(fieldFromArray("hours", hours));
    const auto falling = readOrFail(fileOfTimes({1'087'825, 1'087'824}, "hours since 1900-01-01"));
    EXPECT_EQ(falling.box, hours.box);
    EXPECT_EQ(falling.samples.values()[0], 2);
    const Box box{{0, 0, 0, 5}, {1, 0, 0, 6}};
    const auto placed = readOrFail(fileOfTimes({1'087'824, 1'087'825}, "hours since 1900-01-01"), {.box = box});
    EXPECT_EQ(placed.box, box);
    EXPECT_TRUE(placed.warnings.empty());
    const auto days = readOrFail(fileOfTimes({40'000, 40'001}, "days since 1900-01-01"));
    EXPECT_EQ(days.box.min.w, 40'000);
    EXPECT_EQ(days.units[3], "days since 1900-01-01");
    EXPECT_TRUE(days.warnings.empty());
}

TEST(Netcdf, DimensionsOfSizeOneAreLeftOutOfMoreThanFour) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    const std::array<const char*, 6> names{"time", "member", "z", "y", "x", "part"};
    const std::array<std::size_t, 6> sizes{1, 1, 3, 2, 2, 1};
    int file = 0, variable = 0, flat = 0;
    std::array<int, 6> dimensions{};
    check(nc_create(path.c_str(), NC_CLOBBER, &file));
    for (std::size_t i = 0; i < 6; ++i) check(nc_def_dim(file, names[i], sizes[i], &dimensions[i]));
    check(nc_def_var(file, "mean", NC_FLOAT, 2, &dimensions[3], &flat));
    check(nc_def_var(file, "f", NC_FLOAT, 6, dimensions.data(), &variable));
    check(nc_enddef(file));
    std::array<float, 12> samples{};
    for (std::size_t i = 0; i < 12; ++i) samples[i] = static_cast<float>(i);
    check(nc_put_var_float(file, variable, samples.data()));
    check(nc_close(file));
    const auto field = readOrFail(readFile(path));
    EXPECT_EQ(field.quantity.name, "f");
    EXPECT_EQ(field.shape, (Shape{2, 2, 3, 1}));
    const auto values = field.samples.values();
    EXPECT_EQ(std::vector(values.begin(), values.end()), std::vector(samples.begin(), samples.end()));
    EXPECT_EQ(readOrFail(readFile(path), {.axes = "wzyx"}).shape, field.shape);
}

TEST(Netcdf, HeadersMayBeLongerThanTheValues) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    for (const std::size_t length : {0, 20, 100, 300, 3000, 40'000}) {
        SCOPED_TRACE(length);
        int file = 0, dimension = 0, variable = 0;
        check(nc_create(path.c_str(), NC_CLOBBER, &file));
        check(nc_def_dim(file, "x", 3, &dimension));
        check(nc_def_var(file, "f", NC_FLOAT, 1, &dimension, &variable));
        check(nc_put_att_text(file, variable, "comment", length, std::string(length, 'a').c_str()));
        check(nc_enddef(file));
        const std::array<float, 3> samples{1, 2, 4};
        check(nc_put_var_float(file, variable, samples.data()));
        check(nc_close(file));
        EXPECT_EQ(readOrFail(readFile(path)).samples.values()[2], 4);
    }
}

TEST(Netcdf, ValuesNeverWrittenAreMissing) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    int file = 0, dimension = 0, variable = 0;
    check(nc_create(path.c_str(), NC_CLOBBER, &file));
    check(nc_def_dim(file, "q", 3, &dimension));
    check(nc_def_var(file, "f", NC_DOUBLE, 1, &dimension, &variable));
    check(nc_enddef(file));
    const std::size_t at = 1;
    const double number = 2;
    check(nc_put_var1_double(file, variable, &at, &number));
    check(nc_close(file));
    const auto field = readOrFail(readFile(path));
    EXPECT_TRUE(std::isnan(field.samples.values()[0]));
    EXPECT_EQ(field.samples.values()[1], 2);
    EXPECT_FALSE(field.boxIsKnown);
}

TEST(Netcdf, LimitsAreRoundedToTheTypeOfTheNumbers) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    const double missing[2] = {-999.9, 3.4028235e38}, most = 0.1;
    int file = 0, dimension = 0, variable = 0;
    check(nc_create(path.c_str(), NC_CLOBBER, &file));
    check(nc_def_dim(file, "x", 4, &dimension));
    check(nc_def_var(file, "f", NC_FLOAT, 1, &dimension, &variable));
    check(nc_put_att_double(file, variable, "missing_value", NC_DOUBLE, 2, missing));
    check(nc_put_att_double(file, variable, "valid_max", NC_DOUBLE, 1, &most));
    check(nc_enddef(file));
    const std::array<float, 4> stored{-999.9F, 0.1F, std::numeric_limits<float>::max(), -999.8F};
    check(nc_put_var_float(file, variable, stored.data()));
    check(nc_close(file));
    const auto field = readOrFail(readFile(path));
    const auto values = field.samples.values();
    EXPECT_TRUE(std::isnan(values[0]));
    EXPECT_EQ(values[1], 0.1F);
    EXPECT_TRUE(std::isnan(values[2]));
    EXPECT_EQ(values[3], -999.8F);
}

TEST(Netcdf, LongAndDamagedUnitsAreCut) {
    EXPECT_EQ(readOrFail(netcdfOfMoment(3, 0, "\xff\xfe K")).quantity.unit, "?? K");
    const std::string cut = readOrFail(netcdfOfMoment(3, 0, std::string(100'000, 'm'))).quantity.unit;
    EXPECT_LE(cut.size(), kMaxQuantityText);
    EXPECT_TRUE(cut.ends_with("…")) << cut;
}

}  // namespace
}  // namespace oval4d::fields::test
