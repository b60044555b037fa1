#include <algorithm>
#include <deque>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "scene/look.hpp"
#include "unit/wire/slices_picture.hpp"
#include "unit/wire/support.hpp"
#include "wire/slices_message.hpp"

namespace oval4d::wire {
namespace {

using nlohmann::json;
using session::Session;

TEST(SlicesMessage, IsWhatWasCut) {
    for (const auto& entry : polytopes::catalogue().first(6)) {
        const Picture picture =
            pictureOf({"polytope " + std::string(entry.name), "rotate xw,yz 0.7 1.1", "rotate yw 0.3"});
        const json message = fitting(messageOf(picture, Encoding::json));
        EXPECT_EQ(message.at("revision"), 7);
        EXPECT_EQ(message.at("id"), 3);
        expectSlices(message.at("slices"), picture);
        ASSERT_EQ(message.at("coordinates").size(), picture.slices.rotatedVertices.size());
        for (std::size_t v = 0; v < picture.slices.rotatedVertices.size(); ++v) {
            expectPoint(message.at("coordinates")[v], &picture.slices.rotatedVertices[v].x, 4);
        }
        EXPECT_EQ(message.at("scene").at("colors").at("cells"), json(picture.scene.cellColors));
        EXPECT_EQ(message.at("scene").at("scale"), picture.scene.scale);
        EXPECT_EQ(message.at("scene").at("camera").at("eye"),
                  json({picture.scene.camera.eye.x, picture.scene.camera.eye.y, picture.scene.camera.eye.z}));
    }
}

TEST(SlicesMessage, SaysWhichCellColorsAFaceInTheHyperplane) {
    const Picture picture = pictureOf({"polytope 8-cell"});  // spacing 0.2; the slice w = ±1 is a whole cell
    const json slices = fitting(messageOf(picture, Encoding::json)).at("slices");
    expectSlices(slices, picture);
    int tinted = 0;
    for (const json& slice : slices) {
        const json& of = slice.at("of").at("faces");
        if (!slice.contains("tints")) {
            for (const json& cell : of) EXPECT_LT(cell.get<int>(), 8);
            continue;
        }
        ++tinted;
        ASSERT_EQ(slice.at("tints").size(), of.size());
        for (std::size_t f = 0; f < of.size(); ++f) {
            const auto tint = slice.at("tints")[f].get<std::uint32_t>();
            ASSERT_GE(of[f].get<std::uint32_t>(), 8U);
            const auto faces = picture.polytope->cells[tint];
            EXPECT_NE(std::find(faces.begin(), faces.end(), of[f].get<std::uint32_t>() - 8), faces.end())
                << "the cell has the 2-face";
        }
    }
    EXPECT_EQ(tinted, 2);
}

TEST(SlicesMessage, HasNoNegativeZeroInPositions) {
    for (const scene::ViewTableRow& view : scene::kViews) {
        SCOPED_TRACE(view.name);
        const Picture picture = pictureOf({"view " + std::string(view.name), "project perspective"});
        const std::string text = messageOf(picture, Encoding::json);
        std::size_t found = 0;
        for (const std::string_view member : {R"("position":[)", R"("label_at":[)"}) {
            for (std::size_t at = text.find(member); at != std::string::npos; at = text.find(member, at)) {
                at += member.size();
                ++found;
                const std::string numbers = ',' + text.substr(at, text.find(']', at) - at) + ',';
                EXPECT_EQ(numbers.find(",-0,"), std::string::npos) << member << numbers;
            }
        }
        EXPECT_EQ(found, 2 * picture.scene.placements.size() + 1) << "of the slices, their labels and the projection";
    }
}

TEST(SlicesMessage, LeavesOutCoordinatesThatAreNotShown) {
    EXPECT_FALSE(fitting(messageOf(pictureOf({"set coordinates=off"}), Encoding::json)).contains("coordinates"));
}

TEST(SlicesMessage, HasTheDensityOfManyVertices) {
    const Picture few = pictureOf({"polytope 600-cell", "rotate xw,yz 0.7 1.1"});
    const json none = fitting(messageOf(few, Encoding::json));
    EXPECT_FALSE(none.contains("density"));
    EXPECT_EQ(none.at("scene").at("coordinates").at("columns"), 0);

    const Picture many = pictureOf({"polytope 120-cell", "rotate xw,yz 0.7 1.1"});
    const json message = fitting(messageOf(many, Encoding::json));
    const auto columns = message.at("scene").at("coordinates").at("columns").get<std::size_t>();
    EXPECT_EQ(columns, static_cast<std::size_t>(scene::DensityPlot::kColumns));
    EXPECT_EQ(message.at("coordinates").size(), 600U);
    std::vector<std::uint8_t> pixels;
    for (const json& row : message.at("density")) {
        ASSERT_EQ(row.size(), columns);
        for (const json& pixel : row) pixels.push_back(pixel.get<std::uint8_t>());
    }
    EXPECT_EQ(pixels, many.scene.plotTones);

    for (const Encoding encoding : binaryEncodings()) {
        const json density = decodedMessageOf(many, encoding).at("density");
        EXPECT_EQ(density.get_binary().subtype(), 64U);
        EXPECT_EQ(std::vector<std::uint8_t>(density.get_binary()), pixels);
    }

    const json hidden = fitting(messageOf(pictureOf({"polytope 120-cell", "set coordinates=off"}), Encoding::json));
    EXPECT_FALSE(hidden.contains("density"));
}

TEST(SlicesMessage, HasTheUnitsOfTheAxesAndTheQuantity) {
    Picture picture = pictureOf({"formula x^2+y^2+z^2 < 0.1 + w^2", "set faces=off"});
    const json without = fitting(messageOf(picture, Encoding::json));
    EXPECT_FALSE(without.at("scene").contains("units"));
    EXPECT_FALSE(without.at("histogram").contains("quantity"));
    picture.scene.axisUnits[0] = {"m", true};
    picture.scene.axisUnits[3] = {"µs", false};
    picture.scene.histogram.quantity = "temperature, K";
    const json units = json::parse(R"({"x":"m","w":"µs"})");
    const json message = fitting(messageOf(picture, Encoding::json));
    EXPECT_EQ(message.at("scene").at("units"), units);
    EXPECT_EQ(message.at("histogram").at("quantity"), "temperature, K");
    for (const Encoding encoding : binaryEncodings()) {
        const json binary = decodedMessageOf(picture, encoding);
        EXPECT_EQ(binary.at("scene").at("units"), units);
        EXPECT_EQ(binary.at("histogram").at("quantity"), "temperature, K");
    }
}

TEST(SlicesMessage, HasTheHistogramOfAField) {
    const std::vector<std::string> lines{"formula x^2+y^2+z^2 < 0.1 + w^2", "set faces=off", "set levels=0,1",
                                         "rotate xw,yz 0.7 1.1"};
    const Picture picture = pictureOf(lines);
    const json message = fitting(messageOf(picture, Encoding::json));
    EXPECT_FALSE(message.contains("coordinates"));
    const json& layout = message.at("scene").at("coordinates");
    EXPECT_EQ(layout.at("columns"), slicing::CoordinateValueHistograms::kColumns);
    EXPECT_EQ(layout.at("panel"), picture.scene.coordinates.panel);
    EXPECT_GT(layout.at("panel"), 0);
    std::vector<std::uint8_t> tones;
    for (const json& row : message.at("density")) {
        ASSERT_EQ(row.size(), std::size_t{slicing::CoordinateValueHistograms::kColumns});
        for (const json& tone : row) tones.push_back(tone.get<std::uint8_t>());
    }
    EXPECT_EQ(tones, picture.scene.plotTones);
    const json& histogram = message.at("histogram");
    EXPECT_EQ(histogram.at("range"), (json{picture.scene.histogram.least, picture.scene.histogram.greatest}));
    EXPECT_EQ(histogram.at("reach"), json(picture.scene.histogram.reach));
    ASSERT_EQ(histogram.at("levels").size(), 2U);
    EXPECT_EQ(histogram.at("levels")[1].at("value"), 1);

    for (const Encoding encoding : binaryEncodings()) {
        const json binary = decodedMessageOf(picture, encoding);
        EXPECT_EQ(std::vector<std::uint8_t>(binary.at("density").get_binary()), tones);
        EXPECT_EQ(binary.at("histogram"), histogram);
        EXPECT_FALSE(binary.contains("coordinates"));
    }

    std::vector<std::string> without = lines;
    without.emplace_back("set coordinates=off");
    const json hidden = fitting(messageOf(pictureOf(without), Encoding::json));
    EXPECT_FALSE(hidden.contains("density"));
    EXPECT_FALSE(hidden.contains("histogram"));
}

TEST(SlicesMessage, HasTheFogOfAField) {
    const Picture picture =
        pictureOf({"formula x^2+y^2+z^2 < 0.1 + w^2", "fog -1:0.9,0:0.3:ff8000,2:0", "rotate xw 0.7"});
    const json message = fitting(messageOf(picture, Encoding::json));
    EXPECT_EQ(message.at("scene").at("fog").at("table"), json(picture.scene.fog));
    std::vector<std::uint8_t> values;
    std::vector<std::uint32_t> sizes;
    std::size_t foggy = 0;
    for (std::size_t i = 0; i < message.at("slices").size(); ++i) {
        const json& slice = message.at("slices")[i];
        const slicing::SliceFog& fog = picture.slices.fogs[i];
        for (int axis = 0; axis < 3; ++axis) sizes.push_back(static_cast<std::uint32_t>(fog.size[axis]));
        ASSERT_EQ(slice.contains("fog"), !fog.empty());
        if (fog.empty()) continue;
        ++foggy;
        const json& sent = slice.at("fog");
        EXPECT_EQ(sent.at("size"), (json{fog.size.x, fog.size.y, fog.size.z}));
        EXPECT_EQ(sent.at("step"), fog.step);
        expectPoint(sent.at("min"), &fog.min.x, 3);
        ASSERT_EQ(sent.at("walls").size(), fog.walls.size());
        for (std::size_t k = 0; k < fog.walls.size(); ++k) {
            const glm::dvec4 wall(fog.walls[k].normal, fog.walls[k].offset);
            expectPoint(sent.at("walls")[k], &wall.x, 4);
        }
        std::vector<std::uint8_t> own;
        for (const json& row : sent.at("values")) {
            EXPECT_EQ(row.size(), static_cast<std::size_t>(fog.size.x));
            for (const json& value : row) own.push_back(value.get<std::uint8_t>());
        }
        EXPECT_EQ(own, fog.values);
        values.insert(values.end(), own.begin(), own.end());
    }
    EXPECT_GT(foggy, 5U);
    for (const Encoding encoding : binaryEncodings()) {
        const json columns = decodedMessageOf(picture, encoding).at("slices").at("fog");
        EXPECT_EQ(std::vector<std::uint8_t>(columns.at("values").get_binary()), values);
        EXPECT_EQ(columns.at("size").get_binary().size(), sizes.size()) << "a byte each";
    }
    const json none = fitting(messageOf(pictureOf({"formula x^2+y^2+z^2 < 0.1 + w^2"}), Encoding::json));
    EXPECT_FALSE(none.at("scene").contains("fog"));
    EXPECT_FALSE(none.at("slices")[10].contains("fog"));
}

TEST(SlicesMessage, EmptySlicesAreEmptyLists) {
    const Picture picture = pictureOf({"focus 100"});
    const json slices = fitting(messageOf(picture, Encoding::json)).at("slices");
    EXPECT_EQ(slices.size(), 21U);
    for (const json& slice : slices) {
        EXPECT_EQ(slice.at("vertices"), json::array());
        EXPECT_EQ(slice.at("faces"), json::array());
    }
    for (const Encoding encoding : binaryEncodings()) {
        const json columns = decodedMessageOf(picture, encoding).at("slices");
        EXPECT_TRUE(columns.at("vertices").get_binary().empty());
        EXPECT_EQ(columns.at("index").size(), 21U);
    }
}

TEST(SlicesMessage, ReusesItsMemory) {
    const Picture picture = pictureOf({"polytope 24-cell", "rotate xw 0.5"});
    std::string out;
    SlicesMessageWriter().write(picture.scene, 1, {}, Encoding::json, out);
    const std::string first = out;
    const char* memory = out.data();
    SlicesMessageWriter().write(picture.scene, 1, {}, Encoding::json, out);
    EXPECT_EQ(out, first);
    EXPECT_EQ(static_cast<const void*>(out.data()), memory);
}

// A message does not depend on earlier messages, although the writer caches parts of them.
TEST(SlicesMessage, DoesNotDependOnTheMessagesBefore) {
    std::deque<Picture> pictures;
    for (const char* text :
         {"rotate xw 0.5", "rotate xw 0.7", "focus 3", "view single", "set slices=5", "set spacing=0.3",
          "set coordinates=off", "set balls=off", "polytope 8-cell", "color kind"}) {
        Session session;
        session::line(session, text);
        pictures.emplace_back(session.current);
    }
    SlicesMessageWriter writer;
    for (int round = 0; round < 2; ++round) {
        for (const Picture& picture : pictures) {
            for (const auto& [name, encoding] : kEncodings) {
                std::string out;
                writer.write(picture.scene, 7, 3, encoding, out);
                ASSERT_EQ(out, messageOf(picture, encoding)) << name;
            }
        }
    }
}

}  // namespace
}  // namespace oval4d::wire
