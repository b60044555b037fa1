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

/// Makes a new file of this size in bytes, mapped for reading and writing. Errors: `too_large` and `too_many` if there
/// is no room for it.
using MappedFileMaker = std::function<Result<std::shared_ptr<MappedFile>>(std::size_t bytes)>;

/// How to read a file.
struct FieldReadOptions {
    /// The axes of the array's dimensions in the order of its indices, such as "tzyx"; t means w. The last index varies
    /// fastest in memory, unless the file states otherwise. An axis that is not named gets one sample. If empty, the
    /// axes are those that the file states; if it states none, "tzyx", "zyx", "yx" or "x", depending on the number of
    /// dimensions.
    std::string axes = {};
    std::optional<Box> box = {};  ///< used instead of the box that the file states
    std::string variable = {};    ///< the path of the variable in a NetCDF file, of the dataset in an HDF5 file, or of
                                  ///< the array in a Zarr folder; if empty, the reader chooses one
    std::size_t maxSamples = kMaxSamples;  ///< larger arrays are refused
    /// Arrays with more samples than this are not kept in memory: their samples remain in the file or, if they must be
    /// converted, are written to a file that `newFile` makes.
    std::size_t maxInMemory = kMaxSamples;
    MappedFileMaker newFile = {};  ///< null if all converted samples are kept in memory
    std::span<float> into = {};    ///< memory for converted samples, used if it has exactly the size of the array; must
                                   ///< remain valid as long as the samples are used
    /// The part of the array that is read, in the coordinates of its box: the samples that cover this region or, along
    /// an axis where the region has no extent, the sample nearest to it. Only readZarr() reads parts.
    std::optional<Box> region = {};
    /// The most samples of a level of a multiscale image that readZarr() chooses. Finer levels of at most `maxInMemory`
    /// samples count as ImageLevel::finer.
    std::size_t maxInFirstLevel = kMaxSamples;
    std::optional<std::uint32_t> level = {};  ///< the level of a multiscale image that readZarr() reads; if empty, it
                                              ///< chooses one
};

/// A field read from a file. If `samples` refers to the bytes of the file, it keeps these bytes valid.
struct FieldArray {
    Shape shape{1, 1, 1, 1};
    Box box;
    bool boxIsKnown = false;  ///< whether the file or the options state the box; else it is defaultBox()
    SampleStorage samples{std::vector<float>()};
    AxisUnits units;                    ///< of `box`
    Quantity quantity;                  ///< what the samples measure
    bool isPart = false;                ///< whether the file has further samples: of a finer level, or beyond the box
    ImageLevel imageLevel;              ///< the default unless the file is a folder with a multiscale image
    std::vector<std::string> warnings;  ///< sentences for the user

    /// Returns the interpolant of the samples. Error: `bad_field` if the box is not valid (see Lattice).
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
    visit.addedMember(6, imageLevel);
}

/// Returns the error of a file that does not follow its format, or whose values cannot become a field.
inline Error badField(std::string reason) { return {ErrorCode::bad_field, std::move(reason)}; }

}  // namespace oval4d::fields
