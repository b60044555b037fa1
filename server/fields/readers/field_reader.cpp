#include "fields/readers/field_reader.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <glm/vec3.hpp>

#include "fields/readers/axis_mapping.hpp"
#include "fields/readers/cf_conventions.hpp"
#include "fields/readers/gzip.hpp"
#include "fields/readers/hdf5.hpp"
#include "fields/readers/netcdf.hpp"
#include "fields/readers/nifti.hpp"
#include "fields/readers/npy.hpp"
#include "fields/readers/sample_buffer.hpp"
#include "text/ascii.hpp"
#include "text/message_text.hpp"

namespace oval4d::fields {

namespace {

bool isNiftiOrGzipStart(std::span<const std::byte> start) { return isNiftiStart(start) || isGzipStart(start); }

constexpr std::array<FieldFileFormat, 4> kFormats{{{"npy", isNpyStart, readNpy},
                                                   {"netcdf", isNetcdfStart, readNetcdf},
                                                   {"hdf5", isHdf5Start, readHdf5},
                                                   {"nifti", isNiftiOrGzipStart, readNifti}}};

// Removes all digits at the start of `rest`, and returns them without leading zeros.
std::string_view takeDigits(std::string_view& rest) {
    const auto digits =
        static_cast<std::size_t>(std::find_if_not(rest.begin(), rest.end(), text::isDigit) - rest.begin());
    std::string_view number = rest.substr(0, digits);
    rest.remove_prefix(digits);
    number.remove_prefix(std::min(number.find_first_not_of('0'), number.size()));
    return number;
}

bool precedesInNaturalOrder(const std::string& a, const std::string& b) {
    std::string_view restA = a, restB = b;
    while (!restA.empty() && !restB.empty()) {
        if (text::isDigit(restA.front()) && text::isDigit(restB.front())) {
            const std::string_view numberA = takeDigits(restA), numberB = takeDigits(restB);
            if (numberA.size() != numberB.size()) return numberA.size() < numberB.size();
            if (numberA != numberB) return numberA < numberB;
            continue;
        }
        if (restA.front() != restB.front()) return restA.front() < restB.front();
        restA.remove_prefix(1);
        restB.remove_prefix(1);
    }
    return restA.empty() != restB.empty() ? restA.empty() : a < b;
}

// Sets the box of a series of files (see readSeries()). `times` has, for each file, the w at which the box of the file
// begins.
void setSeriesBox(FieldArray& series, std::span<const double> times, const FieldReadOptions& options) {
    const bool known =
        series.boxIsKnown && std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) == times.end();
    FirstAndLastCoordinate ends{0, static_cast<double>(times.size() - 1)};
    if (known) {
        static_cast<void>(endsOfCoordinates(times, "w", series.warnings));  // adds a warning if they are not evenly
                                                                            // spaced
        ends = {times.front(), times.back()};
        if (!options.box) subtractLeastCoordinateIfFar(ends, times.size(), "w", series.units[3], series.warnings);
    }
    // Files that state no times all have the same time, which needs no warning.
    const bool differ = std::adjacent_find(times.begin(), times.end(), std::not_equal_to<>()) != times.end();
    if (series.boxIsKnown && !known && differ && !options.box) {
        series.warnings.emplace_back(
            "the times that the files state do not increase in the order of the files' names and are ignored; w is the "
            "number of the file, from 0 on");
    }
    if (!known) series.units[3].clear();  // w is the number of the file, without a unit
    series.box.min.w = ends.first;
    series.box.max.w = ends.last;
    if (!series.boxIsKnown) series.box = defaultBox(series.shape, true);
    if (options.box) series.box = *options.box;
    series.boxIsKnown = series.boxIsKnown || options.box;
}

}  // namespace

std::span<const FieldFileFormat> fieldFormats() { return kFormats; }

const FieldFileFormat* formatOfFile(std::span<const std::byte> start) {
    const auto* const format = std::find_if(kFormats.begin(), kFormats.end(),
                                            [&](const FieldFileFormat& each) { return each.isStart(start); });
    return format == kFormats.end() ? nullptr : format;
}

Result<FieldArray> readField(const FileContents& file, const FieldReadOptions& options) {
    if (options.region)
        return Error{ErrorCode::unsupported_format, "only Zarr folders can be read in part, not other files (region)"};
    const FieldFileFormat* const format = formatOfFile(file.bytes.first(std::min(file.bytes.size(), kRecognizedBytes)));
    if (format == nullptr) {
        std::vector<std::string_view> names;
        for (const FieldFileFormat& each : kFormats) names.push_back(each.name);
        return Error{ErrorCode::unsupported_format,
                     "the file has none of the formats of fields: " + text::commaSeparated(names)};
    }
    return format->read(file, options);
}

Result<FieldArray> readSeries(std::span<const FileContents> files, const FieldReadOptions& options) {
    if (files.empty()) return Error{ErrorCode::bad_field, "the series has no files"};
    FieldReadOptions ofFile = options;
    ofFile.box.reset();
    FieldArray series;
    std::optional<SampleBuffer> all;
    std::vector<double> times;
    bool unitsDiffer = false;
    // The first file of the series is decompressed to a file of its own. All later files are decompressed to one file:
    // the samples of each file are copied to `all` before the next file is decompressed.
    std::shared_ptr<MappedFile> decompressed;
    const MappedFileMaker reuseFile = [&](std::size_t bytes) -> Result<std::shared_ptr<MappedFile>> {
        if (decompressed && decompressed->bytes().size() >= bytes) return decompressed;
        auto made = options.newFile(bytes);
        if (made) decompressed = *made;
        return made;
    };
    for (std::size_t i = 0; i < files.size(); ++i) {
        const std::string where = "file " + std::to_string(i + 1) + " of the series: ";
        auto field = readField(files[i], ofFile);
        if (!field) return Error{field.error().code, where + field.error().message};
        const auto samples = field->samples.values();
        if (field->shape[3] != 1) return Error{ErrorCode::bad_field, where + "the array has more than one moment"};
        if (i == 0) {
            const std::size_t most = std::min(options.maxSamples, kMaxSamples) / samples.size();
            if (files.size() > most || files.size() > kMaxSamplesPerAxis)
                return Error{ErrorCode::too_large, "the series has too many samples"};
            auto buffer = SampleBuffer::allocate(samples.size() * files.size(), options);
            if (!buffer) return buffer.error();
            all = std::move(*buffer);
            if (options.newFile) ofFile.newFile = reuseFile;
            series = *field;
            for (std::string& warning : series.warnings) warning.insert(0, where);
        }
        if (field->shape != series.shape || glm::dvec3(field->box.min) != glm::dvec3(series.box.min) ||
            glm::dvec3(field->box.max) != glm::dvec3(series.box.max)) {
            return Error{ErrorCode::bad_field, where + "its shape or its box differs from that of the first file"};
        }
        if (field->units[3] != series.units[3]) series.units[3].clear();
        if (const std::string& unit = field->quantity.unit; unit != series.quantity.unit && !unitsDiffer) {
            unitsDiffer = true;
            series.warnings.push_back(where + "the unit of its values is " + text::inQuotes(unit) +
                                      ", but that of the first file is " + text::inQuotes(series.quantity.unit));
        }
        times.push_back(field->box.min.w);
        const auto timeStep = all->values().subspan(i * samples.size(), samples.size());
        if (samples.data() != timeStep.data()) std::ranges::copy(samples, timeStep.begin());
        if (i + 1 < files.size()) ofFile.into = all->values().subspan((i + 1) * samples.size(), samples.size());
        files[i].releasePages();
        all->releasePages();
    }
    if (unitsDiffer) series.quantity.unit.clear();
    series.shape[3] = files.size();
    series.samples = all->takeSamples();
    setSeriesBox(series, times, options);
    return series;
}

Result<std::vector<std::filesystem::path>> seriesFiles(const std::filesystem::path& folder) {
    std::error_code fault;
    std::vector<std::filesystem::path> files;
    for (std::filesystem::directory_iterator entry(folder, fault), end; !fault && entry != end;
         entry.increment(fault)) {
        std::error_code unknown;
        if (entry->symlink_status(unknown).type() != std::filesystem::file_type::regular) continue;
        if (entry->path().filename().string().starts_with('.')) continue;
        std::array<char, kRecognizedBytes> start{};
        std::ifstream file(entry->path(), std::ios::binary);
        file.read(start.data(), start.size());
        const auto length = static_cast<std::size_t>(file.gcount());
        if (formatOfFile(std::as_bytes(std::span(start).first(length))) != nullptr) files.push_back(entry->path());
    }
    if (fault) return Error{ErrorCode::not_found, "the folder cannot be read: " + fault.message()};
    std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
        return precedesInNaturalOrder(a.filename().string(), b.filename().string());
    });
    return files;
}

}  // namespace oval4d::fields
