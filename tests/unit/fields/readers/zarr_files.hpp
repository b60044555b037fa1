#pragma once
// Zarr arrays whose files are in memory, for tests.

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fields/readers/zarr.hpp"
#include "unit/fields/readers/files.hpp"

namespace oval4d::fields::test {

using Files = std::map<std::string, std::string>;  ///< the contents of each file, by the path of the file

/// Reads an array from the files. If `opened` is not null, adds the paths of the opened files to it.
inline Result<FieldArray> readFiles(const Files& files, const FieldReadOptions& options,
                                    std::set<std::string>* opened = nullptr) {
    const FolderFileReader folder = [&](const std::string& path,
                                        const FilePart& part) -> Result<std::optional<FileContents>> {
        if (opened != nullptr) opened->insert(path);
        const auto found = files.find(path);
        if (found == files.end()) return std::optional<FileContents>();
        return std::optional(FileContents::copyOf(found->second).partialContents(part));
    };
    return readZarr(folder, options);
}

/// Reads the array at the path `variable` from the files.
inline Result<FieldArray> readFiles(const Files& files, const std::string& variable = "") {
    return readFiles(files, FieldReadOptions{.variable = variable});
}

/// Returns the bytes of a chunk that contains these 32-bit floats.
inline std::string chunkOf(const std::vector<float>& numbers) {
    std::string bytes;
    for (const float number : numbers) bytes += bytesOf(number);
    return bytes;
}

}  // namespace oval4d::fields::test
