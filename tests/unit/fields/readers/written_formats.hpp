#pragma once
// Arrays in files of all formats, written by the formats' own libraries.

#include <gtest/gtest.h>
#include <hdf5.h>
#include <netcdf.h>
#include <nifti1_io.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fields/readers/field_reader.hpp"
#include "unit/fields/array/random_arrays.hpp"
#include "unit/fields/readers/files.hpp"

namespace oval4d::fields::test {

inline constexpr Shape kShape{5, 4, 3, 2};  // the numbers of samples along x, y, z, w
inline constexpr std::size_t kCount = 120;

inline std::vector<float> numbers() {
    std::mt19937 random(1);
    auto samples = randomSamples(kShape, 0, random);
    samples[7] = std::numeric_limits<float>::quiet_NaN();
    return samples;
}

inline std::vector<std::uint32_t> sampleBits(const FieldArray& field) {
    std::vector<std::uint32_t> bits;
    for (const float sample : field.samples.values()) bits.push_back(std::bit_cast<std::uint32_t>(sample));
    return bits;
}

inline FieldArray readOrFail(const std::string& bytes, const FieldReadOptions& options = {}) {
    auto field = readField(FileContents::copyOf(bytes), options);
    if (!field) throw std::runtime_error(field.error().message);
    return *field;
}

inline void check(int status) { ASSERT_EQ(status, NC_NOERR) << nc_strerror(status); }

// Returns the bytes of a NetCDF file with a variable f(t, z, y, x) of floats. `mode` is its format: NC_NETCDF4,
// NC_64BIT_DATA …
inline std::string netcdf(int mode, const std::vector<float>& samples) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    int file = 0, variable = 0;
    check(nc_create(path.c_str(), mode | NC_CLOBBER, &file));
    std::array<int, 4> dimensions{};
    const std::array<const char*, 4> names{"t", "z", "y", "x"};
    for (std::size_t i = 0; i < 4; ++i) check(nc_def_dim(file, names[i], kShape[3 - i], &dimensions[i]));
    check(nc_def_var(file, "f", NC_FLOAT, 4, dimensions.data(), &variable));
    check(nc_enddef(file));
    check(nc_put_var_float(file, variable, samples.data()));
    check(nc_close(file));
    return readFile(path);
}

struct Hdf5Options {
    bool compressed = false, bigEndian = false, external = false, softLinks = false;
};

inline std::string hdf5(const std::vector<float>& samples, const Hdf5Options& options = {}) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.h5").string();
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t group = H5Gcreate2(file, "run", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const std::array<hsize_t, 4> size{kShape[3], kShape[2], kShape[1], kShape[0]}, chunk{1, 2, 4, 3};
    const hid_t space = H5Screate_simple(4, size.data(), nullptr), list = H5Pcreate(H5P_DATASET_CREATE);
    if (options.compressed) {
        H5Pset_chunk(list, 4, chunk.data());
        H5Pset_deflate(list, 5);
    }
    if (options.external) H5Pset_external(list, "/etc/passwd", 0, kCount * sizeof(float));
    const hid_t dataset = H5Dcreate2(group, "f", options.bigEndian ? H5T_IEEE_F32BE : H5T_IEEE_F32LE, space,
                                     H5P_DEFAULT, list, H5P_DEFAULT);
    if (!options.external) H5Dwrite(dataset, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, samples.data());
    if (options.softLinks) {
        for (const auto& [target, name] : {std::pair{"/run/f", "latest"},
                                           {"/run", "last"},
                                           {"latest", "twice"},
                                           {"/nothing", "dangling"},
                                           {"circular", "circular"}})
            H5Lcreate_soft(target, file, name, H5P_DEFAULT, H5P_DEFAULT);
    }
    H5Dclose(dataset);
    H5Pclose(list);
    H5Sclose(space);
    H5Gclose(group);
    H5Fclose(file);
    return readFile(path);
}

// Returns the bytes of an HDF5 file with numbers of IEEE 754 binary16 (half precision), as h5py writes them.
inline std::string hdf5OfHalves(std::vector<std::uint16_t> bits, bool bigEndian) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.h5").string();
    const hid_t type = H5Tcopy(bigEndian ? H5T_IEEE_F32BE : H5T_IEEE_F32LE);
    H5Tset_fields(type, 15, 10, 5, 0, 10);
    H5Tset_size(type, 2);
    H5Tset_ebias(type, 15);
    if (bigEndian != (std::endian::native == std::endian::big)) {
        for (std::uint16_t& each : bits) each = static_cast<std::uint16_t>(each >> 8U | each << 8U);
    }
    const hsize_t size = bits.size();
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t space = H5Screate_simple(1, &size, nullptr);
    const hid_t dataset = H5Dcreate2(file, "f", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bits.data());
    H5Dclose(dataset);
    H5Sclose(space);
    H5Fclose(file);
    H5Tclose(type);
    return readFile(path);
}

// Returns the bytes of a NIfTI file. `changed` changes the header before the file is written.
inline std::string nifti(const std::string& name, const std::vector<float>& samples,
                         const std::function<void(nifti_image&)>& changed = {}) {
    const TemporaryFolder folder;
    const std::string path = (folder / name).string();
    const std::array<int, 8> size{4, 5, 4, 3, 2, 1, 1, 1};
    nifti_image* const image = nifti_make_new_nim(size.data(), DT_FLOAT32, 1);
    std::memcpy(image->data, samples.data(), kCount * sizeof(float));
    nifti_set_filenames(image, path.c_str(), 0, 0);
    if (changed) changed(*image);
    nifti_image_write(image);
    nifti_image_free(image);
    return readFile(path);
}

inline std::string npyOf(const std::vector<float>& samples) { return npy("(2, 3, 4, 5)", samples); }

// Returns the bytes of a NetCDF file with a variable f(time, x) of one time, in the unit `unit`. For `mode`, see
// netcdf().
inline std::string netcdfOfMoment(double time, int mode = 0, const std::string& unit = "K") {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    int file = 0, coordinate = 0, variable = 0;
    std::array<int, 2> dimensions{};
    check(nc_create(path.c_str(), mode | NC_CLOBBER, &file));
    check(nc_def_dim(file, "time", 1, &dimensions[0]));
    check(nc_def_dim(file, "x", 2, &dimensions[1]));
    check(nc_def_var(file, "time", NC_DOUBLE, 1, dimensions.data(), &coordinate));
    check(nc_def_var(file, "f", NC_FLOAT, 2, dimensions.data(), &variable));
    check(nc_put_att_text(file, coordinate, "units", 1, "s"));
    check(nc_put_att_text(file, variable, "units", unit.size(), unit.data()));
    check(nc_enddef(file));
    const std::array<float, 2> samples{1, 2};
    check(nc_put_var_double(file, coordinate, &time));
    check(nc_put_var_float(file, variable, samples.data()));
    check(nc_close(file));
    return readFile(path);
}

}  // namespace oval4d::fields::test
