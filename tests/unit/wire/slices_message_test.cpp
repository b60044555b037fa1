#include <algorithm>
#include <cstring>
#include <deque>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "scene/composer.hpp"
#include "scene/look.hpp"
#include "slicing/slicer.hpp"
#include "unit/wire/decoded.hpp"
#include "unit/wire/support.hpp"
#include "wire/slices_message.hpp"

namespace oval4d::wire {
namespace {

using nlohmann::json;
using session::Session;
using slicing::SliceSet;

/// The slices and the scene of a session's state. The scene refers to `slices`.
struct Picture {
    std::shared_ptr<const polytopes::Polytope> polytope;  // null for other objects
    SliceSet slices;
    scene::Scene scene;

    explicit Picture(const session::State& state) {
        if (const auto* p = std::get_if<slicing::PolytopePtr>(&state.object)) polytope = *p;
        slicing::SurfaceDetail detail;
        detail.fogSteps.assign(static_cast<std::size_t>(state.slices.count),
                               slicing::infoOf(state.object).circumradius / 8);
        slicing::Slicer().slice(state.object, state.orientation, state.hyperplanes(), state.look.field, detail, slices);
        scene::Composer composer;
        composer.limitFaceFilling(0);
        composer.compose(state.object, state.orientation, slices, state.slices.focus, state.look, {1280, 720}, scene);
    }
    Picture(const Picture&) = delete;
    Picture& operator=(const Picture&) = delete;
};

Picture pictureOf(const std::vector<std::string>& lines) {
    Session session;
    for (const std::string& line : lines) {
        const auto done = apply(session, session::CommandLine{line});
        EXPECT_TRUE(done) << done.error().message;
    }
    return Picture(session.current);
}

std::string messageOf(const Picture& picture, Encoding encoding, double id = 3) {
    std::string out = "what was there before";
    SlicesMessageWriter().write(picture.scene, 7, id, encoding, out);
    return out;
}

json decodedMessageOf(const Picture& picture, Encoding encoding, double id = 3) {
    return decoded(messageOf(picture, encoding, id), encoding);
}

std::vector<Encoding> binaryEncodings() {
    std::vector<Encoding> encodings;
    for (const auto& choice : kEncodings) {
        if (choice.value != Encoding::json) encodings.push_back(choice.value);
    }
    return encodings;
}

void expectPoint(const json& point, const double* expected, std::size_t size) {
    ASSERT_EQ(point.size(), size);
    for (std::size_t i = 0; i < size; ++i) EXPECT_EQ(point[i].get<float>(), static_cast<float>(expected[i]));
}

void expectSlices(const json& list, const Picture& picture) {
    const SliceSet& set = picture.slices;
    ASSERT_EQ(list.size(), static_cast<std::size_t>(set.planes.count));
    for (int i = 0; i < set.planes.count; ++i) {
        const json& slice = list[i];
        const scene::SlicePlacement& placement = picture.scene.placements[i];
        EXPECT_EQ(slice.at("index"), set.planes.first + i);
        EXPECT_EQ(slice.at("w"), set.planes.w(i));
        EXPECT_EQ(slice.at("label"), placement.label);
        EXPECT_EQ(slice.at("focus"), placement.focus);
        EXPECT_EQ(slice.at("drawn"), placement.drawn);
        expectPoint(slice.at("position"), &placement.position.x, 3);
        expectPoint(slice.at("label_at"), &placement.labelAt.x, 3);
        ASSERT_EQ(slice.at("vertices").size(), set.vertexCount(i));
        for (std::size_t v = 0; v < set.vertexCount(i); ++v) {
            expectPoint(slice.at("vertices")[v], &set.vertices[set.vertexBegin[i] + v].x, 3);
            EXPECT_EQ(slice.at("of").at("vertices").at(v), set.vertexSource[set.vertexBegin[i] + v]);
        }
        ASSERT_EQ(slice.at("edges").size(), set.edgeCount(i));
        for (std::size_t e = 0; e < set.edgeCount(i); ++e) {
            EXPECT_EQ(slice.at("edges")[e], json(set.edges[set.edgeBegin[i] + e]));
            EXPECT_EQ(slice.at("of").at("edges").at(e), set.edgeSource[set.edgeBegin[i] + e]);
        }
        ASSERT_EQ(slice.at("faces").size(), set.faceCount(i));
        for (std::size_t f = 0; f < set.faceCount(i); ++f) {
            const std::size_t face = set.faceBegin[i] + f;
            const std::vector<std::uint32_t> corners(set.corners.begin() + set.cornerBegin[face],
                                                     set.corners.begin() + set.cornerBegin[face + 1]);
            EXPECT_EQ(slice.at("faces")[f], json(corners));
            EXPECT_EQ(slice.at("of").at("faces").at(f), set.faceSource[face]);
        }
    }
}

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
    const Picture picture = pictureOf({"polytope 8-cell"});  // spacing 0.2: w = ±1 holds a whole cell
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
    for (const scene::ViewRow& view : scene::kViews) {
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
    EXPECT_EQ(layout.at("columns"), slicing::CoordinateHistograms::kColumns);
    EXPECT_EQ(layout.at("panel"), picture.scene.coordinates.panel);
    EXPECT_GT(layout.at("panel"), 0);
    std::vector<std::uint8_t> tones;
    for (const json& row : message.at("density")) {
        ASSERT_EQ(row.size(), std::size_t{slicing::CoordinateHistograms::kColumns});
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

// A writer caches parts of previous messages; this must not change its output.
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

// Returns the numbers of a typed array.
template <typename T>
json numbersOf(const json& typed, std::uint64_t tag) {
    const auto& bytes = typed.get_binary();
    EXPECT_EQ(bytes.subtype(), tag);
    EXPECT_EQ(bytes.size() % sizeof(T), 0U);
    std::vector<T> numbers(bytes.size() / sizeof(T));
    if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
    return numbers;
}

// Returns the integers of a typed array, whose width is the least possible.
std::vector<std::uint32_t> integersOf(const json& typed) {
    const std::uint64_t tag = typed.get_binary().subtype();
    const json numbers = tag == 64   ? numbersOf<std::uint8_t>(typed, tag)
                         : tag == 69 ? numbersOf<std::uint16_t>(typed, tag)
                                     : numbersOf<std::uint32_t>(typed, 70);
    const std::uint32_t most = numbers.empty() ? 0 : std::ranges::max(numbers.get<std::vector<std::uint32_t>>());
    EXPECT_EQ(tag, most < 0x100 ? 64U : most < 0x10000 ? 69U : 70U);
    return numbers;
}

// Takes elements from the front of a list; expects at the end that none is left.
class Reader {
  public:
    explicit Reader(json list) : list_(std::move(list)) {}
    ~Reader() { EXPECT_EQ(at_, list_.size()) << "nothing is left over"; }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    json next() { return list_.at(at_++); }
    json next(std::size_t count) {
        json part = json::array();
        while (part.size() < count) part.push_back(next());
        return part;
    }
    json rows(std::size_t count, std::size_t size) {
        json list = json::array();
        while (list.size() < count) list.push_back(next(size));
        return list;
    }

  private:
    json list_;
    std::size_t at_ = 0;
};

constexpr std::uint64_t kFloat32 = 85, kFloat64 = 86;

// Converts the slices of a binary message to the form of the JSON message.
json slicesOf(const json& columns) {
    const auto floats = [&](const char* name) { return numbersOf<float>(columns.at(name), kFloat32); };
    const auto ofEach = [&](const char* name, const char* kind) { return integersOf(columns.at(name).at(kind)); };
    Reader w(numbersOf<double>(columns.at("w"), kFloat64));
    Reader labelSize(numbersOf<double>(columns.at("label_size"), kFloat64));
    Reader position(floats("position")), labelAt(floats("label_at")), vertices(floats("vertices"));
    Reader edges(integersOf(columns.at("edges"))), corners(integersOf(columns.at("corners")));
    Reader sides(integersOf(columns.at("sides")));
    const bool tinted = columns.contains("tints");
    Reader tints(tinted ? json(integersOf(columns.at("tints"))) : json::array());
    Reader vertexSource(ofEach("of", "vertices")), edgeSource(ofEach("of", "edges")), faceSource(ofEach("of", "faces"));
    Reader vertexCount(ofEach("counts", "vertices")), edgeCount(ofEach("counts", "edges"));
    Reader faceCount(ofEach("counts", "faces"));
    json slices = json::array();
    for (std::size_t i = 0; i < columns.at("index").size(); ++i) {
        json slice{{"w", w.next()}, {"label_size", labelSize.next()}};
        for (const char* name : {"index", "label", "focus", "drawn"}) slice[name] = columns.at(name).at(i);
        slice["position"] = position.next(3);
        slice["label_at"] = labelAt.next(3);
        const std::size_t v = vertexCount.next(), e = edgeCount.next(), f = faceCount.next();
        slice["vertices"] = vertices.rows(v, 3);
        slice["edges"] = edges.rows(e, 2);
        slice["faces"] = json::array();
        while (slice["faces"].size() < f) slice["faces"].push_back(corners.next(sides.next()));
        slice["of"] = {
            {"vertices", vertexSource.next(v)}, {"edges", edgeSource.next(e)}, {"faces", faceSource.next(f)}};
        if (tinted) slice["tints"] = tints.next(f);
        slices.push_back(std::move(slice));
    }
    return slices;
}

// Returns a decoded binary message in the form of the JSON message. `vertices` is the number of the polytope's
// vertices.
json asJson(json message, std::size_t vertices) {
    Reader coordinates(numbersOf<float>(message.at("coordinates"), kFloat32));
    message["coordinates"] = coordinates.rows(vertices, 4);
    if (message.contains("density")) {
        Reader density(numbersOf<std::uint8_t>(message.at("density"), 64));
        message["density"] = density.rows(scene::DensityPlot::kRows, scene::DensityPlot::kColumns);
    }
    message["scene"]["colors"]["cells"] = integersOf(message.at("scene").at("colors").at("cells"));
    message["slices"] = slicesOf(message.at("slices"));
    return message;
}

TEST(SlicesMessage, AllEncodingsSayTheSame) {
    for (const char* name : {"5-cell", "8-cell", "120-cell"}) {
        // Unrotated, so that the message has tints.
        const Picture picture = pictureOf({std::string("polytope ") + name});
        const json plain = json::parse(messageOf(picture, Encoding::json));
        for (const Encoding encoding : binaryEncodings()) {
            const json message = asJson(decodedMessageOf(picture, encoding), picture.slices.rotatedVertices.size());
            fitting(message.dump());
            expectSlices(message.at("slices"), picture);
            EXPECT_EQ(message.at("scene"), plain.at("scene"));
            for (std::size_t i = 0; i < plain.at("slices").size(); ++i) {
                const json& slice = plain.at("slices").at(i);
                const json& other = message.at("slices").at(i);
                EXPECT_EQ(other.at("label_size"), slice.at("label_size"));
                EXPECT_EQ(other.value("tints", other.at("of").at("faces")),
                          slice.value("tints", other.at("of").at("faces")));
            }
        }
    }
}

TEST(SlicesMessage, GivesIdsBackAsTheyWere) {
    const Picture picture = pictureOf({});
    for (const double whole : {0.0, 1.0, 23.0, 24.0, 1e6, 123456789012.0, 0x1p53, -1.0, -1e6, -0x1p53}) {
        const auto integer = static_cast<std::int64_t>(whole);
        const std::string plain = messageOf(picture, Encoding::json, whole);
        EXPECT_NE(plain.find("\"id\":" + std::to_string(integer) + ','), std::string::npos) << plain.substr(0, 80);
        for (const auto& [name, encoding] : kEncodings) {
            const json id = decodedMessageOf(picture, encoding, whole).at("id");
            EXPECT_TRUE(id.is_number_integer()) << name << ' ' << id;
            EXPECT_EQ(id.get<std::int64_t>(), integer) << name;
        }
    }
    EXPECT_NE(messageOf(picture, Encoding::json, 1.5).find(R"("id":1.5,)"), std::string::npos);
    for (const auto& [name, encoding] : kEncodings)
        EXPECT_EQ(decodedMessageOf(picture, encoding, 1.5).at("id"), 1.5) << name;
}

TEST(SlicesMessage, CborIsShorter) {
    for (const auto& entry : polytopes::catalogue().first(6)) {
        const Picture picture =
            pictureOf({"polytope " + std::string(entry.name), "rotate xw,yz 0.7 1.1", "rotate xy,zw 0.3 0.2"});
        EXPECT_LT(2 * messageOf(picture, Encoding::cbor).size(), messageOf(picture, Encoding::json).size())
            << entry.name;
    }
}

}  // namespace
}  // namespace oval4d::wire
