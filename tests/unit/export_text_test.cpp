#include <algorithm>
#include <sstream>

#include "export/export.hpp"
#include "export/measure.hpp"
#include "export/text.hpp"
#include "export/text_formats.hpp"
#include "export_support.hpp"
#include "geometry/import.hpp"

namespace {

using namespace oval4d::exports;
using namespace oval4d::exports::support;
using namespace oval4d::geometry;
using oval4d::geometry::support::cutAt;
using oval4d::geometry::support::ontoW;
using oval4d::geometry::support::randomRotation;

TEST(Measure, cubesOctahedraAndTetrahedra) {
    const Polytope& cube = named("8-cell");
    const Measures c = measure(cutAt(cube, {}, 0.4), 0);
    EXPECT_EQ(c.faces, 6U);
    EXPECT_NEAR(c.volume, 8, 1e-12);
    EXPECT_NEAR(c.area, 24, 1e-12);
    EXPECT_NEAR(glm::length(c.centroid), 0, 1e-12);

    // At w = 0 the 16-cell is an octahedron of edge 2.
    const Measures o = measure(cutAt(named("16-cell"), {}, 0), 0);
    EXPECT_EQ(o.faces, 8U);
    EXPECT_NEAR(o.volume, std::sqrt(2) / 3 * 8, 1e-12);
    EXPECT_NEAR(o.area, 2 * std::sqrt(3) * 4, 1e-12);

    // A 5-cell over its base, part t of the way up: the tetrahedron of edge 2, shrunk by 1 − t.
    const Polytope& pen = named("5-cell");
    const Rotation up = ontoW(pen.vertices[0]);
    const double top = pen.circumradius;
    const double bottom = -top / 4;
    for (const double t : {0.0, 0.25, 0.7}) {
        const Measures m = measure(cutAt(pen, up, bottom + t * (top - bottom)), 0);
        const double edge = 2 * (1 - t);
        EXPECT_NEAR(m.volume, edge * edge * edge / (6 * std::sqrt(2)), 1e-9);
        EXPECT_NEAR(m.area, std::sqrt(3) * edge * edge, 1e-9);
        EXPECT_NEAR(glm::length(m.centroid), 0, 1e-9);
    }
}

TEST(Measure, movesWithTheSlice) {
    const Polytope& p = named("24-cell");
    std::mt19937 random(3);
    const Rotation turned = randomRotation(random);
    SliceSet s = cutAt(p, turned, 0.2);
    const Measures here = measure(s, 0);
    const glm::dvec3 by(100, -20, 3);
    for (auto& v : s.vertices) v += by;
    const Measures there = measure(s, 0);
    EXPECT_NEAR(there.volume, here.volume, 1e-10);
    EXPECT_NEAR(there.area, here.area, 1e-10);
    EXPECT_NEAR(glm::distance(there.centroid, here.centroid + by), 0, 1e-10);
}

TEST(Measure, theCentresOfSlicesAreThatOfThePolytope) {
    // The first moments of the volumes over w are the polytope's, whose centre is the origin; between vertex levels
    // they are quartics in w, which Boole's rule integrates exactly.
    std::mt19937 random(4);
    for (const char* name : {"5-cell", "24-cell"}) {
        const Polytope& p = named(name);
        const Rotation turned = randomRotation(random);
        std::vector<double> levels;
        for (const auto& v : p.vertices) levels.push_back(turned(v).w);
        std::ranges::sort(levels);
        glm::dvec3 sum(0);
        double whole = 0;
        for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
            const double step = (levels[i + 1] - levels[i]) / 4;
            constexpr std::array kWeights{7.0, 32.0, 12.0, 32.0, 7.0};
            for (int k = 0; k < 5; ++k) {
                const Measures m = measure(cutAt(p, turned, levels[i] + k * step), 0);
                sum += 2 * step / 45 * kWeights[k] * m.volume * m.centroid;
                whole += 2 * step / 45 * kWeights[k] * m.volume;
            }
        }
        EXPECT_NEAR(glm::length(sum), 0, 1e-9);
        EXPECT_GT(whole, 0.1);
    }
}

TEST(Measure, flatOnesAndHoles) {
    const Polytope& p = named("24-cell");
    const auto corner = [&](int i) { return p.vertices[p.faces[0][i]]; };
    const glm::dvec4 middle = (corner(0) + corner(1) + corner(2)) / 3.0;
    const Rotation up = ontoW(middle);
    const Measures m = measure(cutAt(p, up, glm::length(middle)), 0);
    EXPECT_EQ(m.volume, 0);
    EXPECT_TRUE(m.hasCentroid);
    const glm::dvec4 at = up(middle);
    EXPECT_NEAR(glm::distance(m.centroid, glm::dvec3(at.x, at.y, at.z)), 0, 1e-9);

    const Measures dented = [] {
        const Polytope prism = product(kDented, kSquare);
        return measure(cutAt(prism, {}, 0.5), 0);
    }();
    EXPECT_NEAR(dented.volume, 2 * kDentedArea, 1e-12);
    EXPECT_NEAR(dented.area, 2 * kDentedArea + 2 * (4 + 2 + 1.5 + 1.5 + 1 + 1.5 + 1.5 + 2), 1e-12);
    EXPECT_NEAR(dented.centroid.y, (8 * -1 + 1.5 * 0.75) / kDentedArea, 1e-12);
    EXPECT_FALSE(measure(cutAt(p, {}, 10), 0).hasCentroid);
}

std::string fileOf(const Polytope& p, const Rotation& orientation, const Hyperplanes& planes, Wish wish,
                   const Limits& limits = {}) {
    const Subject subject{p, orientation, planes, planes.first + (planes.count - 1) / 2};
    auto made = oval4d::exports::fileOf(subject, wish, limits);
    if (auto* refusal = std::get_if<Refusal>(&made)) return "refused: " + refusal->message;
    return std::get<std::string>(made);
}

std::vector<double> numbersIn(const std::string& row) {
    std::vector<double> numbers;
    std::istringstream in(row);
    for (std::string cell; std::getline(in, cell, ',');) numbers.push_back(cell.empty() ? NAN : std::stod(cell));
    return numbers;
}

TEST(Csv, hasARowForEachSliceAndEachLevel) {
    const Polytope& p = named("8-cell");
    std::istringstream in(fileOf(p, {}, {-2, 5, 1}, {.format = Format::csv, .of = Extent::oval}));
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(line, "n,w,vertices,edges,faces,volume,area,centroid_x,centroid_y,centroid_z");
    for (int n = -2; n <= 2; ++n) {
        std::getline(in, line);
        if (std::abs(n) == 2) {
            EXPECT_EQ(line, std::to_string(n) + "," + std::to_string(n) + ",0,0,0,0,0,,,");
            continue;
        }
        const std::vector<double> expected{double(n), double(n), 8, 12, 6, 8, 24, 0, 0, 0};
        const auto numbers = numbersIn(line);
        ASSERT_EQ(numbers.size(), expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(numbers[i], expected[i], 1e-12);
    }
    std::getline(in, line);
    EXPECT_EQ(line, "");
    std::getline(in, line);
    EXPECT_EQ(line, "critical_w,vertices");
    for (const double level : {-1.0, 1.0}) {
        std::getline(in, line);
        const auto numbers = numbersIn(line);
        ASSERT_EQ(numbers.size(), 2U);
        EXPECT_NEAR(numbers[0], level, 1e-12);
        EXPECT_EQ(numbers[1], 8);
    }
    EXPECT_FALSE(std::getline(in, line));
}

TEST(Off, isReadAgainAsTheSamePolytope) {
    std::mt19937 random(7);
    for (const char* name : {"5-cell", "24-cell", "600-cell"}) {
        const Polytope& p = named(name);
        const Rotation turned = randomRotation(random);
        const std::string text = fileOf(p, turned, {0, 1, 1}, {.format = Format::off});
        const auto read = importPolytope(FileFormat::off4, text, "again", {});
        ASSERT_TRUE(std::holds_alternative<Imported>(read)) << std::get<ImportError>(read).reason;
        EXPECT_TRUE(std::get<Imported>(read).warnings.empty());
        const Polytope& again = std::get<Imported>(read).polytope;
        EXPECT_EQ(again.faces, p.faces);
        EXPECT_EQ(again.cells, p.cells);
        EXPECT_EQ(again.edges.size(), p.edges.size());
        for (std::size_t v = 0; v < p.vertices.size(); ++v) {
            EXPECT_NEAR(glm::distance(again.vertices[v], turned(p.vertices[v])), 0, 1e-14);
        }
    }
}

TEST(Svg, drawsEachCoordinateOfEachVertex) {
    const Polytope& p = named("24-cell");
    const std::string text = fileOf(p, {}, {0, 1, 1}, {.format = Format::svg});
    std::size_t lines = 0;
    for (auto at = text.find("<line"); at != std::string::npos; at = text.find("<line", at + 1)) ++lines;
    EXPECT_EQ(lines, 1 + 4 * p.vertices.size());
}

TEST(Svg, drawsTheDensityOfManyVertices) {
    const std::string text = fileOf(named("120-cell"), {}, {0, 1, 1}, {.format = Format::svg});
    EXPECT_NE(text.find("id=\"density\""), std::string::npos);
    std::size_t lines = 0;
    for (auto at = text.find("<line "); at != std::string::npos; at = text.find("<line ", at + 1)) ++lines;
    EXPECT_EQ(lines, 4U) << "the axes";
}

TEST(File, isRefusedForWhatIsTooMuchOrNothing) {
    const Polytope& p = named("120-cell");
    const Rotation none;
    const Wish frame{.format = Format::stl, .of = Extent::oval, .body = Body::frame};
    const Hyperplanes oval{-10, 21, 0.5};
    Limits limits;
    limits.triangles = 1000;
    EXPECT_NE(fileOf(p, none, oval, frame, limits).find("1000 are allowed"), std::string::npos);
    limits = {};
    limits.bytes = 1000;
    EXPECT_NE(fileOf(p, none, oval, {.format = Format::off}, limits).find("1000 bytes"), std::string::npos);
    limits = {};
    limits.triangles = 100'000'000;
    limits.time = std::chrono::duration<double>(1e-6);
    EXPECT_NE(fileOf(p, none, oval, frame, limits).find("takes more than"), std::string::npos);
    EXPECT_NE(fileOf(p, none, {90, 1, 1}, {}).find("is empty"), std::string::npos);
    std::stop_source stop;
    stop.request_stop();
    const auto given = oval4d::exports::fileOf({p, none, oval, 0}, frame, limits, stop.get_token());
    ASSERT_TRUE(std::holds_alternative<Refusal>(given));
    EXPECT_EQ(std::get<Refusal>(given).cause, Refusal::Cause::too_long);
}

/// The bodies of an OBJ file.
std::vector<std::vector<glm::dvec3>> bodiesIn(const std::string& text) {
    std::vector<std::vector<glm::dvec3>> bodies;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("o ")) bodies.emplace_back();
        if (!line.starts_with("v ")) continue;
        std::istringstream numbers(line.substr(2));
        glm::dvec3 v;
        numbers >> v.x >> v.y >> v.z;
        bodies.back().push_back(v);
    }
    return bodies;
}

TEST(File, ofTheOvalHasBodiesThatDoNotMeet) {
    const Polytope& p = named("24-cell");
    for (const int count : {1, 5, 21, 61}) {
        const double spacing = count == 1 ? 1 : 2 * p.circumradius / (count - 1);
        for (const Body body : {Body::solid, Body::frame}) {
            const auto bodies = bodiesIn(fileOf(p, {}, {-(count - 1) / 2, count, spacing},
                                                {.format = Format::obj, .of = Extent::oval, .body = body}));
            EXPECT_GE(static_cast<int>(bodies.size()), std::max(1, count - 2));
            // Each stands in a ball of its own.
            std::vector<std::pair<glm::dvec3, double>> balls;
            for (const auto& points : bodies) {
                Box box;
                for (const auto& v : points) box.include(v);
                const glm::dvec3 middle = (box.least + box.most) / 2.0;
                double radius = 0;
                for (const auto& v : points) radius = std::max(radius, glm::distance(v, middle));
                balls.emplace_back(middle, radius);
            }
            for (std::size_t i = 0; i < balls.size(); ++i) {
                for (std::size_t j = 0; j < i; ++j) {
                    EXPECT_GE(glm::distance(balls[i].first, balls[j].first), balls[i].second + balls[j].second - 1e-3);
                }
            }
        }
    }
}

}  // namespace
