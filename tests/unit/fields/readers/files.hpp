#pragma once
// Helpers for tests of readers: temporary files, the bytes of .npy files, and damaged files.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "fields/readers/field_array.hpp"
#include "fields/readers/file_contents.hpp"

namespace oval4d::fields::test {

/// A new folder for temporary files. The destructor removes the folder and its contents.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "oval4d-fields-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot create " + name);
        path_ = name;
    }
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

inline void writeFile(const std::filesystem::path& path, std::string_view bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string readFile(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the bytes of a number in this processor's byte order, which is little-endian.
template <typename Number>
std::string bytesOf(Number number) {
    std::string bytes(sizeof number, '\0');
    std::memcpy(bytes.data(), &number, sizeof number);
    return bytes;
}

/// Returns the bytes of a .npy file. `descr` is the type of the numbers, such as "<f4". `fortran` chooses Fortran order
/// (the first index varies fastest) instead of C order. `shape` is a tuple as Python writes it. `data` are the bytes of
/// the numbers. `version` is the major version of the format.
inline std::string npy(const std::string& descr, bool fortran, const std::string& shape, const std::string& data,
                       int version = 1) {
    std::string header =
        "{'descr': '" + descr + "', 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': " + shape + ", }";
    const std::size_t before = version == 1 ? 10 : 12;
    while ((before + header.size() + 1) % 64 != 0) header += ' ';
    header += '\n';
    const auto length = static_cast<std::uint32_t>(header.size());
    const std::string size = version == 1 ? bytesOf(static_cast<std::uint16_t>(length)) : bytesOf(length);
    return std::string("\x93NUMPY") + static_cast<char>(version) + '\0' + size + header + data;
}

/// Returns the bytes of a .npy file of 32-bit floats in C order (the last index varies fastest).
inline std::string npy(const std::string& shape, const std::vector<float>& numbers) {
    std::string data;
    for (const float number : numbers) data += bytesOf(number);
    return npy("<f4", false, shape, data);
}

/// Expects that a reader handles damaged versions of `file`. Calls `read` for truncations of `file` to every `step`-th
/// length. Also calls `read` for copies of `file` with one changed byte: every `step`-th of the first `mutated` bytes,
/// in four ways. `read` must return an error with a message, or a field with as many samples as its shape states.
template <typename Reader>
void expectRobust(const std::string& file, std::size_t mutated, const Reader& read, std::size_t step = 1) {
    const auto tryFile = [&](const std::string& bytes) {
        auto field = read(FileContents::copyOf(bytes), FieldReadOptions{.maxSamples = 1'000'000});
        if (!field) {
            EXPECT_FALSE(field.error().message.empty());
            return;
        }
        EXPECT_EQ(sampleCount(field->shape), field->samples.values().size());
        double sum = 0;
        for (const float sample : field->samples.values()) sum += sample;
        EXPECT_TRUE(sum == sum || sum != sum);  // always true; reads all samples
        (void)field->function();
    };
    for (std::size_t length = 0; length < file.size(); length += step) tryFile(file.substr(0, length));
    for (std::size_t at = 0; at < std::min(mutated, file.size()); at += step) {
        for (const int change : {1, 0x20, 0x80, 0xff}) {
            std::string changed = file;
            changed[at] = static_cast<char>(changed[at] ^ change);
            tryFile(changed);
        }
    }
}

}  // namespace oval4d::fields::test
