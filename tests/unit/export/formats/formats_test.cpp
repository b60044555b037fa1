#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include <nlohmann/json.hpp>

#include "polytopes/import/import.hpp"
#include "protocol_data/embedded_files.hpp"
#include "scene/style.hpp"
#include "text/message_text.hpp"
#include "unit/export/support.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::support;
using namespace oval4d::exports;
using namespace oval4d::geometry;
using namespace oval4d::polytopes;
using namespace oval4d::slicing;

TEST(Formats, areThoseOfTheTable) {
    const auto rows = nlohmann::json::parse(protocol_data::embeddedFile("export_formats.json")).at("formats");
    ASSERT_EQ(formats().size(), rows.size());
    std::set<std::string_view> names;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Format& format = formats()[i];
        SCOPED_TRACE(format.name);
        EXPECT_EQ(format.name, rows[i].at("name").get<std::string>());
        EXPECT_EQ(format.mediaType, rows[i].at("media_type").get<std::string>());
        EXPECT_EQ(formatNamed(format.name), &format);
        EXPECT_EQ(formatNames()[i], format.name);
        EXPECT_TRUE(names.insert(format.name).second);
        const std::string bodies = rows[i].value("bodies", "");
        EXPECT_EQ(format.arrangement, bodies == "plate"  ? Format::BodyArrangement::plate
                                      : bodies == "oval" ? Format::BodyArrangement::oval
                                                         : Format::BodyArrangement::none);
        EXPECT_EQ(format.writeBodies != nullptr, !bodies.empty());
        const std::string group = rows[i].at("group");
        EXPECT_EQ(format.writeBodies != nullptr, group == "print" || group == "model");
        EXPECT_EQ(format.writeDrawing != nullptr, group == "figure");
        EXPECT_EQ(format.writeScene != nullptr, group == "data");
        EXPECT_EQ(format.writeBodies != nullptr || format.readsSurfaces, rows[i].value("surfaces", false));
    }
    EXPECT_EQ(formatNamed("STL"), nullptr);
    EXPECT_EQ(formatNamed(""), nullptr);
}

TEST(Formats, haveOnlyMembersThatTheTableDescribes) {
    const auto table = nlohmann::json::parse(protocol_data::embeddedFile("export_formats.json"));
    const std::string description = table.at("description");
    for (const auto& row : table.at("formats")) {
        for (const auto& [member, value] : row.items())
            EXPECT_NE(description.find(' ' + member + ": "), std::string::npos) << member << ": " << value;
    }
}

// Returns whether an exported file may begin with these bytes, according to the table of binary messages in
// protocol/README.md.
bool mayBeginAFile(std::string_view bytes) {
    return !bytes.empty() && bytes[0] > ' ' && bytes[0] <= '~' && !bytes.starts_with("{U");
}

TEST(Formats, areAllWritten) {
    for (const Format& format : formats()) {
        for (const ExportContentsKind contents : format.contents) {
            using enum ExportContentsKind;
            // The exports of these contents need other scenes.
            if (contents == projection || contents == matrix || contents == highlight) continue;
            const Hyperplanes planes = contents == oval ? Hyperplanes{-2, 5, 0.5} : Hyperplanes{0, 1, 0.5};
            const ExportRequest request{.format = &format, .contents = contents};
            const std::string bytes = format.objects == Format::ObjectKinds::fields
                                          ? bytesOf(SlicedBall(planes).exported(request))
                                          : fileOf(named("24-cell"), {}, planes, request);
            ASSERT_GT(bytes.size(), 100U) << format.name;
            EXPECT_FALSE(bytes.starts_with("refused")) << bytes;
            EXPECT_TRUE(mayBeginAFile(bytes)) << format.name << ": " << static_cast<int>(bytes[0]);
        }
    }
}

PlacedMesh tetrahedron(const std::string& name) {
    PlacedMesh body{name, {}, 0xff8800, glm::dvec3(1, 2, 3)};
    body.mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    body.mesh.add(0, 2, 1, kNoCell);
    body.mesh.add(0, 1, 3, kNoCell);
    body.mesh.add(0, 3, 2, kNoCell);
    body.mesh.add(1, 2, 3, kNoCell);
    return body;
}

// Returns a file with two bodies, both called `name`.
std::string fileOfBodies(const Format& format, const std::string& name, const ExportBudget& budget = unhurried()) {
    const std::vector<PlacedMesh> solids{tetrahedron(name), tetrahedron(name)};
    return format.writeBodies({solids, {}, name, budget});
}

TEST(Formats, ofBodiesStopWhenTheirTimeIsOver) {
    const ExportBudget spent({.time = std::chrono::seconds(-1)}, {});
    for (const Format& format : formats()) {
        if (format.writeBodies == nullptr) continue;
        EXPECT_THROW((void)fileOfBodies(format, "body", spent), ExportRefused) << format.name;
    }
}

std::size_t countOf(const std::string& text, std::string_view characters) {
    return static_cast<std::size_t>(
        std::ranges::count_if(text, [&](char c) { return characters.find(c) != std::string_view::npos; }));
}

const std::string kHostileName = "a \"b\" 'c'\r\nv 1 2\t3\n<d/> & é";

TEST(Formats, ofBodiesAreNotBrokenByNames) {
    for (const Format& format : formats()) {
        if (format.writeBodies == nullptr) continue;
        SCOPED_TRACE(format.name);
        const std::string plain = fileOfBodies(format, "body");
        if (plain.find('\0') != std::string::npos) continue;  // skip binary files
        const std::string bytes = fileOfBodies(format, kHostileName);
        EXPECT_TRUE(text::isUtf8(bytes));
        EXPECT_EQ(countOf(bytes, "\r\n"), countOf(plain, "\r\n"));
        if (!plain.starts_with('<')) continue;  // the rest checks XML only
        EXPECT_EQ(countOf(bytes, "<>\"'"), countOf(plain, "<>\"'"));
        EXPECT_EQ(bytes.find("& "), std::string::npos);
    }
}

TEST(X3d, namesHaveBackslashesBeforeQuotesAndBackslashes) {
    EXPECT_NE(fileOfBodies(*formatNamed("x3d"), R"(a"b\c'd)").find(R"( value='&quot;a\&quot;b\\c&apos;d&quot;'/>)"),
              std::string::npos);
}

TEST(Obj, namesAreWords) {
    EXPECT_NE(fileOfBodies(*formatNamed("obj"), kHostileName).find("\no a_\"b\"_'c'__v_1_2_3_<d/>_&_é\n"),
              std::string::npos);
}

TEST(Scad, isAProgramWithAModuleForEachBody) {
    const std::vector<PlacedMesh> solids{tetrahedron("a\nb")};
    const std::string title = "c\rd";
    EXPECT_EQ(formatNamed("scad")->writeBodies({solids, {}, title, unhurried()}),
              "// cd, in millimeters, from oval4d\n"
              "\n"
              "// ab\n"
              "module body_1() {\n"
              "    color(\"#ff8800\") polyhedron(convexity = 10, points = [\n"
              "[0, 0, 0],\n"
              "[1, 0, 0],\n"
              "[0, 1, 0],\n"
              "[0, 0, 1]\n"
              "], faces = [\n"
              "[0, 1, 2],\n"
              "[0, 3, 1],\n"
              "[0, 2, 3],\n"
              "[1, 3, 2]\n"
              "]);\n"
              "}\n"
              "\n"
              "translate([1, 2, 3]) body_1();\n");
}

/// Returns the first vector "[x, y, z]" in a line of an OpenSCAD program.
glm::dvec3 vectorIn(const std::string& line) {
    std::istringstream in(line.substr(line.find('[') + 1));
    glm::dvec3 v(NAN);
    char comma = 0;
    in >> v.x >> comma >> v.y >> comma >> v.z;
    return v;
}

/// Returns the bodies in an exported OpenSCAD program. The triangles have the orientation of the program.
std::vector<PlacedMesh> bodiesOfScad(const std::string& text) {
    std::vector<PlacedMesh> bodies;
    std::size_t placed = 0;
    std::string name;
    bool inFaces = false;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("// ")) {
            name = line.substr(3);
        } else if (line.starts_with("module ")) {
            EXPECT_EQ(line, "module body_" + std::to_string(bodies.size() + 1) + "() {");
            bodies.push_back({name, {}, 0, glm::dvec3(0)});
            inFaces = false;
        } else if (line.starts_with("    color(\"#")) {
            bodies.back().color =
                static_cast<scene::Color>(std::stoul(line.substr(line.find('#') + 1, 6), nullptr, 16));
        } else if (line == "], faces = [") {
            inFaces = true;
        } else if (line.starts_with("translate(")) {
            bodies.at(placed++).at = vectorIn(line);
            EXPECT_TRUE(line.ends_with(" body_" + std::to_string(placed) + "();")) << line;
        } else if (line.starts_with('[')) {
            const glm::dvec3 v = vectorIn(line);
            Mesh& mesh = bodies.back().mesh;
            if (inFaces) {
                const glm::uvec3 corners(v);
                mesh.add(corners.x, corners.y, corners.z, kNoCell);
            } else {
                mesh.points.push_back(v);
            }
        }
    }
    EXPECT_EQ(placed, bodies.size());
    return bodies;
}

TEST(Scad, hasFacesThatAreClockwiseSeenFromOutside) {
    // With a circumscribed sphere of 60 mm, the slice of the tesseract is a cube with edges of 30 mm.
    auto bodies = bodiesOfScad(fileOf(named("8-cell"), {}, {0, 1, 1}, {.format = formatNamed("scad")}));
    ASSERT_EQ(bodies.size(), 1U);
    Mesh& mesh = bodies.front().mesh;
    EXPECT_NEAR(volumeOf(mesh), -30.0 * 30 * 30, 1);
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    expectPrintable(mesh);
}

TEST(Scad, hasTheBodiesOfTheSlices) {
    const ExportRequest request{.format = formatNamed("scad"), .contents = ExportContentsKind::oval};
    const auto bodies = bodiesOfScad(fileOf(named("16-cell"), {}, {-2, 5, 0.5}, request));
    ASSERT_EQ(bodies.size(), 5U);
    const double scale = 30 / std::sqrt(2);  // millimeters per unit; the circumradius is √2
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const PlacedMesh& body = bodies[i];
        const int n = static_cast<int>(i) - 2;
        SCOPED_TRACE(body.name);
        EXPECT_TRUE(body.name.starts_with("16-cell, w = "));
        EXPECT_EQ(body.color, scene::style().ball);
        // The slice at ±w is an octahedron with the circumradius √2 − |w|.
        const double radius = scale * (std::sqrt(2) - std::abs(n * 0.5));
        const double volume = 4.0 / 3 * radius * radius * radius;
        EXPECT_NEAR(volumeOf(body.mesh), -volume, 1e-3 * volume);
    }
}

TEST(Scad, hasTheSamePointsAsObj) {
    const auto textOf = [](const char* format) {
        const ExportRequest request{
            .format = formatNamed(format), .contents = ExportContentsKind::oval, .label = LabelPlacement::separate};
        return fileOf(named("24-cell"), {}, {-2, 5, 0.5}, request);
    };
    std::vector<glm::dvec3> points;
    for (const PlacedMesh& body : bodiesOfScad(textOf("scad"))) {
        for (const glm::dvec3& point : body.mesh.points) points.push_back(point + body.at);
    }
    std::vector<glm::dvec3> pointsInObj;
    std::istringstream in(textOf("obj"));
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with("v ")) continue;
        std::istringstream numbers(line.substr(2));
        glm::dvec3& v = pointsInObj.emplace_back();
        numbers >> v.x >> v.y >> v.z;
    }
    EXPECT_FALSE(points.empty());
    EXPECT_EQ(points, pointsInObj);
}

std::vector<double> numbersIn(const std::string& row) {
    std::vector<double> numbers;
    std::istringstream in(row);
    for (std::string cell; std::getline(in, cell, ',');) numbers.push_back(cell.empty() ? NAN : std::stod(cell));
    return numbers;
}

TEST(Csv, hasARowForEachSlice) {
    const Polytope& p = named("8-cell");
    std::istringstream in(
        fileOf(p, {}, {-2, 5, 1}, {.format = formatNamed("csv"), .contents = ExportContentsKind::oval}));
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
    EXPECT_FALSE(std::getline(in, line));
}

TEST(Csv, hasARowForEachCriticalW) {
    std::istringstream in(fileOf(named("8-cell"), {}, {0, 1, 1},
                                 {.format = formatNamed("csv"), .contents = ExportContentsKind::critical}));
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(line, "w,vertices");
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
        const std::string text = fileOf(p, turned, {0, 1, 1}, defaultRequestFor(*formatNamed("off")));
        const auto read = importPolytope(PolytopeFileFormat::off4, text, "again", {});
        ASSERT_TRUE(std::holds_alternative<ImportedPolytope>(read)) << std::get<FileError>(read).reason;
        EXPECT_TRUE(std::get<ImportedPolytope>(read).warnings.empty());
        const Polytope& again = std::get<ImportedPolytope>(read).polytope;
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
    const std::string text = fileOf(p, {}, {0, 1, 1}, defaultRequestFor(*formatNamed("svg")));
    std::size_t lines = 0;
    for (auto at = text.find("<line"); at != std::string::npos; at = text.find("<line", at + 1)) ++lines;
    EXPECT_EQ(lines, 1 + 4 * p.vertices.size());
}

TEST(Pdf, isAWholeDocument) {
    for (const char* name : {"24-cell", "120-cell"}) {
        const std::string text = fileOf(named(name), {}, {0, 1, 1}, defaultRequestFor(*formatNamed("pdf")));
        EXPECT_TRUE(text.starts_with("%PDF-1."));
        EXPECT_NE(text.find("%%EOF"), std::string::npos);
    }
}

TEST(Svg, drawsTheDensityOfManyVertices) {
    const std::string text = fileOf(named("120-cell"), {}, {0, 1, 1}, defaultRequestFor(*formatNamed("svg")));
    EXPECT_NE(text.find("id=\"density\""), std::string::npos);
    std::size_t lines = 0;
    for (auto at = text.find("<line "); at != std::string::npos; at = text.find("<line ", at + 1)) ++lines;
    EXPECT_EQ(lines, 4U) << "the axes";
}

}  // namespace
