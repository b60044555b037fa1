// Fuzzes the reader of Zarr folders. The input is a list of files, separated by the byte 0x1e. Each file has its path,
// a line feed and its contents.

#include <algorithm>
#include <map>
#include <optional>

#include "fields/readers/zarr.hpp"
#include "support.hpp"

using namespace oval4d;
using fuzz::require;

namespace {

constexpr std::size_t kMaxSamples = 4096;

void requireInFolder(const std::string& path) {
    require(!path.starts_with('/') && ("/" + path + "/").find("/../") == std::string::npos,
            "only files in the folder are read:", path);
}

void requireSound(const fields::FieldArray& field) {
    const std::size_t count = fields::sampleCount(field.shape);
    require(field.samples.values().size() == count, "there is a sample for each point");
    require(count <= kMaxSamples, "no array is larger than allowed");
    for (const std::string& unit : field.units) require(fields::isQuantityText(unit), "units are short and printable");
    require(fields::isQuantityText(field.quantity.name), "the name of the quantity is short and printable");
    require(fields::isQuantityText(field.quantity.unit), "the unit of the values is short and printable");
    const auto function = field.function();
    if (!function) fuzz::requireSentence(function.error());
}

}  // namespace

OVAL4D_FUZZER(zarr) {
    std::string_view rest = fuzz::textOf(data, size);
    std::map<std::string, std::string_view> files;
    while (!rest.empty()) {
        std::string_view file = fuzz::takeUntil(rest, '\x1e');
        const std::string_view path = fuzz::takeUntil(file, '\n');
        files.try_emplace(std::string(path), file);
    }
    const fields::FolderFileReader folder =
        [&](const std::string& path, const fields::FilePart& part) -> Result<std::optional<fields::FileContents>> {
        requireInFolder(path);
        const auto found = files.find(path);
        if (found == files.end()) return std::optional<fields::FileContents>();
        return std::optional(fields::FileContents::copyOf(found->second).partialContents(part));
    };
    for (const char* variable : {"", "a", "../a"}) {
        for (const std::optional<fields::Box>& region :
             {std::optional<fields::Box>(), std::optional(fields::Box{glm::dvec4(0.3), glm::dvec4(0.3, 1, 2, 5)})}) {
            const auto field =
                fields::readZarr(folder, {.variable = variable, .maxSamples = kMaxSamples, .region = region});
            if (field) {
                requireSound(*field);
            } else {
                fuzz::requireSentence(field.error());
            }
        }
    }
    return 0;
}
