// Compares rendered pictures with stored pictures. If OVAL4D_UPDATE_GOLDEN=1 is in the environment, the test replaces
// the stored pictures instead. Look at the new pictures before you commit them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "unit/render/pictures.hpp"

namespace oval4d::render {
namespace {

namespace fs = std::filesystem;

// The greatest difference of a channel, and the mean difference, that count as equal. Other versions of Mesa and
// FreeType draw edges and letters slightly differently.
constexpr int kMaxDifference = 96;
constexpr double kMeanDifference = 0.6;

struct Golden {
    const char* file;
    const char* polytope;
    unsigned seed;  ///< the seed of the random orientation; 0 means the initial orientation
    scene::Look look;
};

std::ostream& operator<<(std::ostream& out, const Golden& golden) { return out << golden.file; }

std::vector<std::uint8_t> bytesOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void write(const fs::path& file, const image::Image& image) {
    std::vector<std::uint8_t> bytes;
    image::PngEncoder().encode(image, "", bytes);
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
}

/// Returns an image of the absolute differences, multiplied by four.
image::Image differenceOf(const image::Image& a, const image::Image& b) {
    image::Image image = a;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        image.pixels[i] = static_cast<std::uint8_t>(std::min(255, 4 * std::abs(a.pixels[i] - b.pixels[i])));
    return image;
}

class GoldenPictures : public testing::TestWithParam<Golden> {};

TEST_P(GoldenPictures, AreDrawn) {
    const Golden& golden = GetParam();
    const geometry::Rotation orientation = golden.seed == 0 ? geometry::Rotation() : randomRotation(golden.seed);
    Renderer renderer;
    const image::Image image = Subject(golden.polytope, orientation, 21, golden.look, {480, 270}).draw(renderer);
    const fs::path expectedFile =
        fs::path(OVAL4D_SOURCE_DIR) / "tests/unit/render/golden" / (std::string(golden.file) + ".png");
    if (std::getenv("OVAL4D_UPDATE_GOLDEN") != nullptr) {
        write(expectedFile, image);
        GTEST_SKIP() << "written: " << expectedFile;
    }
    const image::Image expected = readPng(bytesOf(expectedFile));
    ASSERT_EQ(expected.width, image.width) << "no picture in " << expectedFile;
    ASSERT_EQ(expected.height, image.height);

    int largest = 0;
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const int d = difference(pixelAt(image, x, y), pixelAt(expected, x, y));
            largest = std::max(largest, d);
            sum += d;
        }
    const double mean = sum / (image.width * image.height);
    if (largest <= kMaxDifference && mean <= kMeanDifference) return;
    const fs::path place = fs::path(testing::TempDir()) / "oval4d-golden";
    write(place / (std::string(golden.file) + "-drawn.png"), image);
    write(place / (std::string(golden.file) + "-difference.png"), differenceOf(image, expected));
    ADD_FAILURE() << "differs from " << expectedFile << " by at most " << largest << " (allowed " << kMaxDifference
                  << "), on average " << mean << " (allowed " << kMeanDifference << "); pictures in " << place;
}

INSTANTIATE_TEST_SUITE_P(
    All, GoldenPictures,
    testing::Values(Golden{"5-cell", "5-cell", 0, {}}, Golden{"8-cell", "8-cell", 11, {}},
                    Golden{"16-cell", "16-cell", 12, {}}, Golden{"24-cell", "24-cell", 13, {}},
                    Golden{"120-cell", "120-cell", 14, {}}, Golden{"600-cell", "600-cell", 15, {}},
                    Golden{"star", "great stellated 120-cell", 18, {}},
                    Golden{"dense-star", "icosahedral 120-cell", 19, {}},
                    Golden{"single", "5-cell", 16, {.view = scene::View::single, .parts = {}, .orbit = {}}},
                    Golden{"matrix", "24-cell", 20, {.view = scene::View::matrix, .parts = {}, .orbit = {}}},
                    Golden{"strip", "24-cell", 21, {.view = scene::View::strip, .parts = {}, .orbit = {}}},
                    Golden{"faces-from-aside",
                           "24-cell",
                           17,
                           {.view = scene::View::oval,
                            .parts = {.faces = true, .bars = false, .balls = false, .coordinates = true},
                            .orbit = {0.5, 0.2, 1.2}}}));

}  // namespace
}  // namespace oval4d::render
