// Tests that the `slices` message says the same in all encodings.

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "scene/density_plot.hpp"
#include "unit/wire/slices_picture.hpp"
#include "unit/wire/support.hpp"

namespace oval4d::wire {
namespace {

using nlohmann::json;

// Returns the numbers in a typed array, and checks its type.
template <typename T>
json numbersOf(const json& typed, std::uint64_t tag) {
    const auto& bytes = typed.get_binary();
    EXPECT_EQ(bytes.subtype(), tag);
    EXPECT_EQ(bytes.size() % sizeof(T), 0U);
    std::vector<T> numbers(bytes.size() / sizeof(T));
    if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
    return numbers;
}

// Returns the integers in a typed array. Expects that they have the smallest possible width.
std::vector<std::uint32_t> integersOf(const json& typed) {
    const std::uint64_t tag = typed.get_binary().subtype();
    const json numbers = tag == 64   ? numbersOf<std::uint8_t>(typed, tag)
                         : tag == 69 ? numbersOf<std::uint16_t>(typed, tag)
                                     : numbersOf<std::uint32_t>(typed, 70);
    const std::uint32_t most = numbers.empty() ? 0 : std::ranges::max(numbers.get<std::vector<std::uint32_t>>());
    EXPECT_EQ(tag, most < 0x100 ? 64U : most < 0x10000 ? 69U : 70U);
    return numbers;
}

// A reader that takes elements from the front of a list. The destructor expects that no element is left.
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

// Converts the slices of a binary message to the form of a JSON message.
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

// Converts a decoded binary message to the form of a JSON message. `vertices` is the number of the polytope's vertices.
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
        // Without a rotation, the message contains tints (cells that color faces).
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

TEST(SlicesMessage, HasTheTrianglesOfAProjectedStar) {
    const Picture picture = pictureOf({"polytope small stellated 120-cell", "set slices=5", "rotate xw,yz 0.7 1.1",
                                       "rotate yw 0.3", "project orthogonal", "set cells=on faces=off"});
    const std::size_t faces = picture.polytope->faces.size();
    const json parts = fitting(messageOf(picture, Encoding::json)).at("projection").at("parts");
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_FALSE(parts[1].contains("fill")) << "the faces of the section are not drawn";
    const json& whole = parts[0];
    ASSERT_EQ(whole.at("faces").size(), faces);
    const json& fill = whole.at("fill");
    ASSERT_EQ(fill.at("triangles").size(), 5 * faces) << "a pentagram that is filled roughly has five triangles";
    ASSERT_EQ(fill.at("points").size(), 15 * faces);
    ASSERT_EQ(fill.at("tints").size(), 5 * faces);
    for (std::size_t t = 0; t < 5 * faces; ++t) {
        EXPECT_EQ(fill.at("tints")[t], whole.at("tints")[t / 5]);
        EXPECT_EQ(fill.at("triangles")[t], json({3 * t, 3 * t + 1, 3 * t + 2}));
    }
    for (const Encoding encoding : binaryEncodings()) {
        const json columns = decodedMessageOf(picture, encoding).at("projection").at("parts").at("fill");
        const auto count = static_cast<std::uint32_t>(faces);
        EXPECT_EQ(integersOf(columns.at("counts").at("points")), (std::vector<std::uint32_t>{15 * count, 0}));
        EXPECT_EQ(integersOf(columns.at("counts").at("triangles")), (std::vector<std::uint32_t>{5 * count, 0}));
        EXPECT_EQ(json(integersOf(columns.at("tints"))), fill.at("tints"));
        EXPECT_EQ(columns.at("points").get_binary().size(), 15 * faces * 3 * sizeof(float));
        Reader triangles(integersOf(columns.at("triangles")));
        EXPECT_EQ(triangles.rows(5 * faces, 3), fill.at("triangles"));
    }
    const Picture convex = pictureOf({"polytope 24-cell", "project orthogonal", "set cells=on"});
    const json ofConvex = fitting(messageOf(convex, Encoding::json)).at("projection").at("parts").at(0);
    EXPECT_EQ(ofConvex.at("faces").size(), 96U);
    EXPECT_FALSE(ofConvex.contains("fill"));
}

TEST(SlicesMessage, HasTheTrianglesOfTheFocusSectionOfAStar) {
    const Picture picture = pictureOf({"polytope icosahedral 120-cell", "set slices=5", "rotate xw,yz 0.7 1.1",
                                       "project perspective", "set sections=on"});
    const json message = fitting(messageOf(picture, Encoding::json));
    const json& parts = message.at("projection").at("parts");
    ASSERT_EQ(parts.size(), 6U);
    for (std::size_t part = 0; part < parts.size(); ++part) {
        EXPECT_EQ(parts[part].contains("fill"), part == 3);
        EXPECT_EQ(parts[part].at("opacity") == 0.5, part == 3);
    }
    const json& fill = parts[3].at("fill");
    const json& own = message.at("slices").at(2).at("fill");
    ASSERT_FALSE(own.at("triangles").empty());
    for (const char* member : {"triangles", "tints"}) EXPECT_EQ(fill.at(member), own.at(member));
    EXPECT_EQ(fill.at("points"), own.at("points")) << "the hyperplane w = 0 is not magnified";
    const auto triangles = static_cast<std::uint32_t>(own.at("triangles").size());
    for (const Encoding encoding : binaryEncodings()) {
        const json columns = decodedMessageOf(picture, encoding).at("projection").at("parts").at("fill");
        EXPECT_EQ(integersOf(columns.at("counts").at("triangles")),
                  (std::vector<std::uint32_t>{0, 0, 0, triangles, 0, 0}));
        EXPECT_EQ(json(integersOf(columns.at("tints"))), own.at("tints"));
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
