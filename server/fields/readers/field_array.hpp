#pragma once
// The options and the result of the functions that read fields from files.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "errors/error.hpp"
#include "fields/array/array_function.hpp"
#include "fields/array/shape.hpp"
#include "fields/image_level.hpp"
#include "fields/quantity.hpp"
#include "fields/scalar_function.hpp"
#include "serialization/stored_members.hpp"

namespace oval4d::fields {

/// A function that makes a new file of this size in bytes, mapped for reading and writing. Errors: `too_large` and
/// `too_many` if there is no room for the file.
using MappedFileMaker = std::function<Result<std::shared_ptr<MappedFile>>(std::size_t bytes)>;

/// Options for reading an array from a file.
struct FieldReadOptions {
    /// The axes of the array's dimensions in the order of its indices, such as "tzyx"; t means w. The last index varies
    /// fastest in memory, unless the file states otherwise. An axis without a dimension gets one sample. If `axes` is
    /// empty, the axes are those that the file states. If it states none, they are "tzyx", "zyx", "yx" or "x",
    /// depending on the number of dimensions.
    std::string axes = {};
    std::optional<Box> box = {};  ///< used instead of the box that the file states
    std::string variable = {};    ///< the path of the variable in a NetCDF file, of the dataset in an HDF5 file, or of
                                  ///< the array in a Zarr folder; if empty, the reader chooses
    std::size_t maxSamples = kMaxSamples;  ///< a larger array is an error, `too_large`
    /// The maximum number of samples of an array that is kept in memory. The samples of a larger array remain in the
    /// file or, if they must be converted, are written to a file that `newFile` makes.
    std::size_t maxInMemory = kMaxSamples;
    MappedFileMaker newFile = {};  ///< makes a file for converted samples; null if they are always kept in memory
    std::span<float> into = {};    ///< memory for converted samples, used if it has exactly the size of the array; must
                                   ///< remain valid as long as the samples are used
    /// The part of the array that is read: the samples that cover this region, or the sample nearest to it along an
    /// axis where the region has no extent. The region is in the coordinates of the array's box. Only readZarr() reads
    /// parts.
    std::optional<Box> region = {};
    /// The maximum number of samples of the level of a multiscale image that readZarr() chooses. Finer levels of at
    /// most `maxInMemory` samples count as MultiscaleImageLevel::finer.
    std::size_t maxInFirstLevel = kMaxSamples;
    std::optional<std::uint32_t> level = {};  ///< the level of a multiscale image that readZarr() reads; if empty,
                                              ///< readZarr() chooses the level
};

/// An array that was read from a file, with its box and units. If `samples` refers to the bytes of the file, it keeps
/// these bytes valid.
struct FieldArray {
    Shape shape{1, 1, 1, 1};
    Box box;
    bool boxIsKnown = false;  ///< whether the file or the options state the box; otherwise, the box is defaultBox()
    SampleStorage samples{std::vector<float>()};
    AxisUnits units;                    ///< the units of the coordinates in `box`
    Quantity quantity;                  ///< what the samples measure
    bool isPart = false;                ///< whether the file has more samples, of a finer level or beyond the box
    MultiscaleImageLevel imageLevel;    ///< the level, if the file is a folder with a multiscale image
    std::vector<std::string> warnings;  ///< warnings for the user, as sentences

    /// Returns the function that interpolates the samples. Error: `bad_field` if the box is not valid (see Lattice).
    Result<std::shared_ptr<const ArrayFunction>> function() const;
};
void visitStoredMembers(serialization::ReadOrWritten<FieldArray> auto& array, auto& visit) {
    // `boxIsKnown` is not stored, and `warnings` is not stored: both matter only while a file is loaded.
    auto& [shape, box, boxIsKnown, samples, units, quantity, isPart, imageLevel, warnings] = array;
    visit.member(0, shape);
    visit.member(1, box);
    visit.member(2, samples);
    visit.member(3, units);
    visit.member(4, quantity);
    visit.member(5, isPart);
    visit.memberAddedLater(6, imageLevel);
}

/// Returns the error `bad_field`, for a file that does not follow its format, or whose values cannot become a field.
inline Error badFieldError(std::string reason) { return {ErrorCode::bad_field, std::move(reason)}; }

}  // namespace oval4d::fields
