#include "export/mesh/field_surfaces.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <random>
#include <sstream>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fields/array/array_function.hpp"
#include "scene/surface_look.hpp"
#include "unit/export/support.hpp"
#include "unit/slicing/field_support.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::support;
using namespace oval4d::exports;

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

// A field with its exact exports. The slices of the field have no surfaces, so exports must compute the surfaces.
struct ExactField {
    slicing::Object object;
    geometry::Rotation orientation;
    slicing::SliceSet slices;
    scene::Scene scene;  // refers to `slices`

    ExactField(fields::Field field, const geometry::Rotation& turned, const geometry::Hyperplanes& planes,
               const slicing::FieldSettings& settings, scene::Coloring coloring = scene::Coloring::cell)
        : object(std::make_shared<const fields::Field>(std::move(field))), orientation(turned) {
        slicing::Slicer().slice(object, orientation, planes, settings, {}, slices);
        scene::Look look;
        look.field = settings;
        look.coloring = coloring;
        scene::Composer().compose(object, orientation, slices, 0, look, {}, scene);
    }
    ExactField(const ExactField&) = delete;
    ExactField& operator=(const ExactField&) = delete;

    std::string file(const char* format, ExportContentsKind contents = ExportContentsKind::focus,
                     const ExportLimits& limits = kUnhurried, std::stop_token stop = {}) const {
        const ExportRequest request{.format = formatNamed(format), .contents = contents, .exact = true};
        return bytesOf(exports::exportScene(scene, object, orientation, request, limits, std::move(stop)));
    }
    // Returns the number in the column `column`, from the first row of the exported CSV file.
    double measured(std::string_view column) const {
        std::istringstream table(file("csv"));
        std::string names, row;
        std::getline(table, names);
        std::getline(table, row);
        std::istringstream heads(names), cells(row);
        std::string head, cell;
        while (std::getline(heads, head, ',') && std::getline(cells, cell, ',')) {
            if (head == column) return std::stod(cell);
        }
        ADD_FAILURE() << "no column " << column << " in " << names;
        return 0;
    }
    // Converts a volume from cubic units of the field to cubic millimeters.
    double cubicMillimeters(double volume) const { return volume * std::pow(30 / scene.circumradius, 3); }
};

struct ParsedMesh {
    std::vector<glm::dvec3> points;
    Triangles triangles;

    double volume() const {
        double sum = 0;
        for (const auto& [a, b, c] : triangles) sum += glm::dot(points[a], glm::cross(points[b], points[c])) / 6;
        return sum;
    }
    bool isManifold() const { return DirectedEdges(triangles).isManifold(); }
    std::size_t unbalanced() const { return DirectedEdges(triangles).unbalanced(); }
};

ParsedMesh parsedObj(const std::string& file) {
    ParsedMesh mesh;
    std::istringstream lines(file);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string kind;
        words >> kind;
        if (kind == "v") {
            glm::dvec3 point;
            words >> point.x >> point.y >> point.z;
            mesh.points.push_back(point);
        } else if (kind == "f") {
            std::array<std::uint32_t, 3> corners{};
            for (std::uint32_t& corner : corners) {
                words >> corner;
                --corner;
            }
            mesh.triangles.push_back(corners);
        }
    }
    return mesh;
}

template <typename Number>
Number numberAt(const std::string& bytes, std::size_t at) {
    Number number;
    std::memcpy(&number, bytes.data() + at, sizeof number);
    return number;
}

// Reads a binary STL file as other programs do: points with equal coordinates are one point.
ParsedMesh parsedStl(const std::string& file) {
    ParsedMesh mesh;
    std::map<Key, std::uint32_t> numbers;
    for (std::size_t at = 84; at + 50 <= file.size(); at += 50) {
        auto& corners = mesh.triangles.emplace_back();
        for (std::size_t i = 0; i < 3; ++i) {
            const auto part = [&](std::size_t k) { return numberAt<float>(file, at + 12 * (i + 1) + 4 * k); };
            const auto [found, isNew] =
                numbers.try_emplace(Key{part(0), part(1), part(2)}, static_cast<std::uint32_t>(mesh.points.size()));
            if (isNew) mesh.points.emplace_back(part(0), part(1), part(2));
            corners[i] = found->second;
        }
    }
    return mesh;
}

// Returns a field of an array with random samples between −1 and 1. `holes` is the probability that a sample is NaN
// (missing).
fields::Field noise(std::size_t side, std::mt19937& random, double holes = 0) {
    std::uniform_real_distribution<float> value(-1, 1);
    std::uniform_real_distribution<double> chance(0, 1);
    const fields::Box box{glm::dvec4(-1), glm::dvec4(1, 1.5, 1, 2)};
    std::vector<float> samples(side * side * side * side);
    for (float& sample : samples) sample = chance(random) < holes ? NAN : value(random);
    auto function = std::make_shared<const fields::ArrayFunction>(fields::Shape{side, side, side, side}, box,
                                                                  fields::SampleStorage(std::move(samples)));
    fields::Field field = fields::makeField("noise", function, box);
    field.array = function;
    return field;
}

// A function that counts how many times its pages are released.
class MappedFunction : public slicing::TestFunction {
  public:
    using TestFunction::TestFunction;
    void releasePages() const override { ++released; }

    mutable std::atomic<int> released = 0;
};

TEST(FilesOfFields, releaseThePagesOfMappedArraysAfterEachSlice) {
    const auto radius = [](const glm::dvec4& p) { return glm::length(p); };
    const auto first = std::make_shared<const MappedFunction>(radius, 1.0);
    const auto second = std::make_shared<const MappedFunction>(radius, 1.0);
    fields::Field ball = fields::makeField("ball", first, {glm::dvec4(-1), glm::dvec4(1)});
    fields::setSecondFunction(ball, {.function = second});
    const ExactField field(std::move(ball), {}, {-1, 3, 0.1}, {{0.9}});
    const int atFirst = first->released.load(), atSecond = second->released.load();
    EXPECT_TRUE(field.file("csv", ExportContentsKind::oval).starts_with("n,w,volume"));
    EXPECT_GE(first->released.load(), atFirst + 3);
    EXPECT_GE(second->released.load(), atSecond + 3);
    const int beforeLattice = first->released.load();
    const ExportRequest lattice{.format = formatNamed("vti"), .contents = ExportContentsKind::focus};
    const auto made = bytesOf(exports::exportScene(field.scene, field.object, {}, lattice, kUnhurried, {}));
    EXPECT_TRUE(made.starts_with("<?xml"));
    EXPECT_GE(first->released.load(), beforeLattice + 64) << "after each layer of the lattice";
}

// Exact surfaces are closed, and enclose the volume that the CSV file states. The test includes hyperplanes through
// lattice points, where many triangles have no area.
TEST(ExactSurfaces, areClosedAndHaveTheVolumeOfTheTable) {
    std::mt19937 random(60);
    std::uniform_real_distribution<double> height(-0.4, 0.4), levels(-0.4, 0.4);
    for (int trial = 0; trial < 16; ++trial) {
        SCOPED_TRACE(trial);
        const bool isAligned = trial % 4 == 0;
        const geometry::Rotation orientation = isAligned ? geometry::Rotation() : randomRotation(random);
        const slicing::FieldSettings settings{{levels(random)},
                                              trial % 2 == 0 ? fields::BodySide::below : fields::BodySide::above};
        const double w = isAligned ? 0 : height(random);
        const ExactField field(noise(5, random), orientation, {0, 1, 1, w}, settings);
        const double expected = field.cubicMillimeters(field.measured("volume"));
        ASSERT_GT(expected, 100);
        const ParsedMesh obj = parsedObj(field.file("obj"));
        ASSERT_GT(obj.triangles.size(), 500U);
        EXPECT_TRUE(obj.isManifold());
        EXPECT_NEAR(obj.volume() / expected, 1, 1e-9);
        const ParsedMesh stl = parsedStl(field.file("stl"));
        EXPECT_TRUE(stl.isManifold());
        EXPECT_NEAR(stl.volume() / expected, 1, 2e-3);  // coordinates are rounded, and parts of the body are thin
    }
}

TEST(ExactSurfaces, areClosedBesideMissingSamples) {
    std::mt19937 random(61);
    for (int trial = 0; trial < 4; ++trial) {
        const ExactField field(noise(6, random, 0.05), randomRotation(random), {0, 1, 1, 0.1}, {{0.1}});
        const ParsedMesh mesh = parsedObj(field.file("obj"));
        EXPECT_EQ(mesh.unbalanced(), 0U);
        EXPECT_NEAR(mesh.volume() / field.cubicMillimeters(field.measured("volume")), 1, 1e-9);
    }
}

// The exact surface of a formula is that of the CSV file, on the same lattice. The surface in pictures is closer to the
// sphere.
TEST(ExactSurfaces, ofAFormulaAreThoseOfTheTable) {
    auto ball = fields::fieldFromFormula("ball", "x^2 + y^2 + z^2 + w^2", {glm::dvec4(-1.2), glm::dvec4(1.2)});
    ASSERT_TRUE(ball);
    std::mt19937 random(62);
    const ExactField field(std::move(*ball), randomRotation(random), {0, 1, 1, 0.2}, {{1}});
    const double expected = field.measured("volume"), ideal = 4.0 / 3 * std::numbers::pi * std::pow(0.96, 1.5);
    EXPECT_GT(std::abs(expected / ideal - 1), 1e-5);
    EXPECT_NEAR(expected / ideal, 1, 1e-2);
    const ParsedMesh mesh = parsedObj(field.file("obj"));
    EXPECT_TRUE(mesh.isManifold());
    EXPECT_NEAR(mesh.volume() / field.cubicMillimeters(expected), 1, 1e-9);
}

// All formats contain the exact surfaces of all slices. Formats for printers contain only one level, and other formats
// contain all levels.
TEST(ExactSurfaces, areInAllFormatsWithSurfaces) {
    std::mt19937 random(63);
    const slicing::FieldSettings settings{{0.3, -0.2}};
    const ExactField field(noise(4, random), randomRotation(random), {-1, 3, 0.2}, settings);
    for (const Format& format : formats()) {
        if (format.writeBodies == nullptr && !format.readsSurfaces) continue;
        SCOPED_TRACE(format.name);
        const std::string bytes = field.file(format.name.c_str(), ExportContentsKind::oval);
        EXPECT_FALSE(bytes.starts_with("refused")) << bytes;
        EXPECT_GT(bytes.size(), 10'000U);
    }
    const std::string obj = field.file("obj", ExportContentsKind::oval);
    std::size_t bodies = 0;
    for (std::size_t at = obj.find("\no "); at != std::string::npos; at = obj.find("\no ", at + 1)) ++bodies;
    EXPECT_EQ(bodies, 6U);
    EXPECT_TRUE(parsedObj(obj).isManifold());
    EXPECT_TRUE(parsedStl(field.file("stl", ExportContentsKind::oval)).isManifold());
    EXPECT_NE(field.file("vtp").find("type=\"Float64\" Name=\"points\""), std::string::npos);
}

// Returns the offset, in bytes, of the data in a PLY file.
std::size_t dataOf(const std::string& ply) {
    constexpr std::string_view kEnd = "end_header\n";
    return ply.find(kEnd) + kEnd.size();
}

// Exact surfaces have colors, values and growth. The growth of a linear function is the same everywhere on its level
// set.
TEST(ExactSurfaces, haveColorsAndValues) {
    std::mt19937 random(64);
    const glm::dvec4 slope(0.7, -1.1, 0.4, 0.9);
    const geometry::Rotation orientation = randomRotation(random);
    const glm::dvec4 turned = orientation.matrix() * slope;
    const double growth = -turned.w / glm::length(glm::dvec3(turned));
    fields::Field linear = slicing::sampledField(
        slicing::testField([&](const glm::dvec4& p) { return glm::dot(slope, p); }, 2, fields::Box{}), 5);
    const double level = 0.1;
    const ExactField field(std::move(linear), orientation, {0, 1, 1, level * turned.w / glm::dot(turned, turned)},
                           {{level}}, scene::Coloring::growth);
    const std::string ply = field.file("ply");
    ASSERT_NE(ply.find("property double x\nproperty double y\nproperty double z\n"), std::string::npos);
    const scene::Color expected = scene::growthColor(static_cast<float>(growth));
    constexpr std::size_t kStride = 3 * 8 + 3 + 4;
    const std::string_view kCount = "element vertex ";
    const std::size_t count = std::stoul(ply.substr(ply.find(kCount) + kCount.size(), 20));
    std::size_t onLevel = 0, at = dataOf(ply);
    ASSERT_GE(ply.size(), at + count * kStride);
    for (std::size_t i = 0; i < count; ++i, at += kStride) {
        const float value = numberAt<float>(ply, at + 27);
        if (value == static_cast<float>(level)) {
            ++onLevel;
            for (unsigned k = 0; k < 3; ++k) {
                const int channel = static_cast<unsigned char>(ply[at + 24 + k]);
                EXPECT_NEAR(channel, static_cast<int>(expected >> (16 - 8 * k) & 0xffU), 2);
            }
        } else {
            EXPECT_LT(value, level) << "a point of a cap";
        }
    }
    EXPECT_GT(onLevel, 20U);
    EXPECT_LT(onLevel, count);
}

TEST(ExactSurfaces, areBounded) {
    std::mt19937 random(65);
    const ExactField field(noise(8, random), randomRotation(random), {-1, 3, 0.2}, {{0}});
    std::stop_source stop;
    stop.request_stop();
    for (const char* format : {"obj", "pov", "stl", "vtp"}) {
        SCOPED_TRACE(format);
        const auto refusal = [&](const ExportLimits& limits, std::stop_token token = {}) {
            return field.file(format, ExportContentsKind::oval, limits, std::move(token));
        };
        EXPECT_NE(refusal({.triangles = 2000, .time = kUnhurried.time}).find("2000 triangles; export fewer slices"),
                  std::string::npos);
        EXPECT_NE(refusal({.time = std::chrono::duration<double>(-1)}).find("takes longer"), std::string::npos);
        EXPECT_NE(refusal(kUnhurried, stop.get_token()).find("stopping"), std::string::npos);
        EXPECT_NE(
            refusal({.time = kUnhurried.time, .grantTotalBytes = [](std::size_t bytes) { return bytes < 50'000; }})
                .find("no room"),
            std::string::npos);
    }
}

}  // namespace
