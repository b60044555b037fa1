// Tests of the reader of NIfTI files; the NIfTI reference library writes the files.

#include "fields/readers/nifti.hpp"

#include <gtest/gtest.h>
#include <nifti1_io.h>

#include <array>
#include <cstddef>
#include <string>

#include "unit/fields/readers/written_formats.hpp"

namespace oval4d::fields::test {
namespace {

TEST(Nifti, ReadsTheGeometry) {
    const auto samples = numbers();
    const auto place = [](nifti_image& image) {
        image.pixdim[1] = image.dx = 2;
        image.pixdim[2] = image.dy = 3;
        image.pixdim[3] = image.dz = 4;
        image.pixdim[4] = image.dt = 0.5F;
        image.xyz_units = NIFTI_UNITS_MM;
        image.time_units = NIFTI_UNITS_SEC;
        image.toffset = 1.5F;
    };
    const auto plain = readOrFail(nifti("a.nii", samples, place));
    EXPECT_EQ(plain.box, (Box{{-4, -4.5, -4, 1.5}, {4, 4.5, 4, 2}}));
    EXPECT_EQ(plain.units, (std::array<std::string, 4>{"mm", "mm", "mm", "s"}));
    EXPECT_EQ(readOrFail(nifti("a.nii.gz", samples, place)).box, plain.box);
    EXPECT_EQ(readOrFail(nifti("a.nii", samples, place), {.axes = "xyzw"}).units, (AxisUnits{"s", "mm", "mm", "mm"}))
        << "the fourth dimension, the first index in Python, is x";

    // An orientation by a matrix (sform): the index i increases along −y, j along x, and k along z.
    const auto turn = [&](nifti_image& image) {
        place(image);
        image.sform_code = 1;
        image.sto_xyz = {{{0, 3, 0, 100}, {-2, 0, 0, 200}, {0, 0, 4, 300}, {0, 0, 0, 1}}};
    };
    const auto turned = readOrFail(nifti("a.nii", samples, turn));
    EXPECT_EQ(turned.shape, (Shape{4, 5, 3, 2}));
    EXPECT_EQ(turned.box, (Box{{100, 192, 300, 1.5}, {109, 200, 308, 2}}));
    for (std::size_t i = 0; i < 5; ++i) {
        for (std::size_t j = 0; j < 4; ++j)
            EXPECT_EQ(turned.samples.values()[j + 4 * (4 - i) + 20], samples[i + 5 * j + 20]);
    }

    // An orientation by a quaternion (qform): a rotation by 180° about z, and a reversed k.
    const auto rotate = [&](nifti_image& image) {
        place(image);
        image.qform_code = 1;
        image.quatern_b = image.quatern_c = 0;
        image.quatern_d = 1;
        image.qfac = image.pixdim[0] = -1;
        image.qoffset_x = image.qoffset_y = image.qoffset_z = 10;
    };
    const auto rotated = readOrFail(nifti("a.nii", samples, rotate));
    EXPECT_EQ(rotated.box, (Box{{2, 1, 2, 1.5}, {10, 10, 10, 2}}));
    EXPECT_EQ(rotated.samples.values()[59], samples[0]);

    const auto oblique = [&](nifti_image& image) {
        turn(image);
        image.sto_xyz.m[0][0] = 1;
    };
    EXPECT_EQ(readOrFail(nifti("a.nii", samples, oblique)).warnings.size(), 1);
    EXPECT_EQ(readOrFail(nifti("a.nii", samples, oblique)).box, plain.box);
}

TEST(Nifti, ScalesNumbers) {
    const auto field = readOrFail(nifti("a.nii", numbers(), [](nifti_image& image) {
        auto* const shorts = static_cast<short*>(image.data);
        for (short i = 0; i < static_cast<short>(kCount); ++i) shorts[i] = i;
        image.datatype = DT_INT16;
        image.nbyper = 2;
        image.scl_slope = 0.5F;
        image.scl_inter = -3;
    }));
    for (std::size_t i = 0; i < kCount; ++i) EXPECT_EQ(field.samples.values()[i], 0.5F * static_cast<float>(i) - 3);
}

TEST(Nifti, SurvivesEveryTruncationAndMutation) {
    expectRobust(nifti("a.nii", numbers()), 352, readNifti);
    expectRobust(nifti("a.nii.gz", numbers()), 1000, readNifti);
}

}  // namespace
}  // namespace oval4d::fields::test
