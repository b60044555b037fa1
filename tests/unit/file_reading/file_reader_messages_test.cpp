// Messages of processes that read files, and how the server handles those of a compromised one.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <stdexcept>
#include <string>

#include "file_reading/file_reader_messages.hpp"
#include "slicing/slicer.hpp"
#include "unit/polytopes/support.hpp"

namespace oval4d::file_reading {
namespace {

using support::shared;

std::string encoded(const Result<session::ObjectWithWarnings>& outcome) {
    std::string bytes;
    encodeOutcome(outcome, bytes);
    return bytes;
}

TEST(ReadingMessages, FilesSurviveARoundTrip) {
    session::Limits limits;
    limits.maxVertices = 7;
    limits.maxHullCells = 8;
    limits.maxFieldBytes = 9;
    limits.maxFirstLevelBytes = 5;
    session::LoadObject load{"mine", "points", std::string("1 2\0 3", 6)};
    load.axes = "xyz";
    load.variable = "a/b";
    load.secondFormula = "x*y";
    load.secondVariable = "a/c";
    load.center = {geometry::Centering::OriginChoice::point, {1, 2, 3, 4}};
    for (const bool hasBox : {false, true}) {
        if (hasBox) load.region = fields::Box{{1, 1, 2, 3}, {4, 5, 6, 7}};
        if (hasBox) load.finer = session::FinerImageLevel{3, 0};
        if (hasBox) load.box = fields::Box{{0, 1, 2, 3}, {4, 5, 6, 7}};
        std::string bytes;
        encodeReadRequest(load, limits, true, bytes);
        FileReadRequest file;
        decodeReadRequest(bytes, file);
        EXPECT_EQ(file.load.format, load.format);
        EXPECT_EQ(file.load.data, load.data);
        EXPECT_EQ(file.load.name, load.name);
        EXPECT_EQ(file.load.axes, load.axes);
        EXPECT_EQ(file.load.variable, load.variable);
        EXPECT_EQ(file.load.secondFormula, load.secondFormula);
        EXPECT_EQ(file.load.secondVariable, load.secondVariable);
        EXPECT_EQ(file.load.center, load.center);
        EXPECT_EQ(file.load.box, load.box);
        EXPECT_EQ(file.load.region, load.region);
        EXPECT_EQ(file.load.finer, load.finer);
        EXPECT_EQ(file.limits.maxVertices, 7U);
        EXPECT_EQ(file.limits.maxHullCells, 8U);
        EXPECT_EQ(file.limits.maxFieldBytes, 9U);
        EXPECT_EQ(file.limits.maxFirstLevelBytes, 5U);
    }
}

TEST(ReadingMessages, RequestsForFilesSurviveARoundTrip) {
    std::string bytes;
    encodeFindRequest({"c/0/1", {5, 7, true}}, bytes);
    const auto [path, part] = decodeFindRequest(bytes);
    EXPECT_EQ(path, "c/0/1");
    EXPECT_EQ(part.offset, 5U);
    EXPECT_EQ(part.size, 7U);
    EXPECT_TRUE(part.fromEnd);
    EXPECT_THROW((void)decodeFindRequest(std::string_view(bytes).substr(1)), std::runtime_error);
    bytes.back() = 2;
    EXPECT_THROW((void)decodeFindRequest(bytes), std::runtime_error);
}

TEST(ReadingMessages, PolytopesSurviveARoundTripExceptTheirSerial) {
    for (const char* name : {"5-cell", "24-cell", "120-cell", "runcinated tesseract", "{5/2,3,5}"}) {
        const auto sent = shared(name);
        const auto got = decodeOutcome(encoded(session::ObjectWithWarnings{sent, {"one", "δ"}}), "mine", {});
        ASSERT_TRUE(got) << name;
        EXPECT_EQ(got->warnings, (std::vector<std::string>{"one", "δ"}));
        const polytopes::Polytope& polytope = *std::get<slicing::PolytopePtr>(got->object);
        EXPECT_EQ(polytope.name, "mine");
        EXPECT_NE(polytope.serial, sent->serial);
        EXPECT_EQ(polytope.vertices, sent->vertices);
        EXPECT_EQ(polytope.edges, sent->edges);
        EXPECT_EQ(polytope.faces, sent->faces);
        EXPECT_EQ(polytope.faceEdges, sent->faceEdges);
        EXPECT_EQ(polytope.edgeFaces, sent->edgeFaces);
        EXPECT_EQ(polytope.cells, sent->cells);
        EXPECT_EQ(polytope.cellSigns, sent->cellSigns);
        EXPECT_EQ(polytope.faceCells, sent->faceCells);
        EXPECT_EQ(polytope.typeOfCell, sent->typeOfCell);
        EXPECT_EQ(polytope.convex, sent->convex);
        EXPECT_LT(encoded(session::ObjectWithWarnings{sent, {}}).size(), maxOutcomeBytes({}, {}));
    }
}

TEST(ReadingMessages, ErrorsAreSafeToSendToClients) {
    for (const ErrorCode code : {ErrorCode::bad_polytope, ErrorCode::too_large, ErrorCode::bad_expression}) {
        const auto got = decodeOutcome(encoded(Error{code, "line 2: wrong"}), "mine", {});
        ASSERT_FALSE(got);
        EXPECT_EQ(got.error().code, code);
        EXPECT_EQ(got.error().message, "line 2: wrong");
    }
    // Other codes become bad_polytope, and bytes that are not valid in JSON are replaced.
    const auto odd =
        decodeOutcome(encoded(Error{ErrorCode::bad_token, "\xff\xed\xa0\x80\n" + std::string(9999, 'x')}), "mine", {});
    ASSERT_FALSE(odd);
    EXPECT_EQ(odd.error().code, ErrorCode::bad_polytope);
    EXPECT_TRUE(odd.error().message.starts_with("?????xxx"));
    EXPECT_LT(odd.error().message.size(), 2100U);
}

TEST(ReadingMessages, RefusesMoreThanTheLimits) {
    session::Limits limits;
    limits.maxVertices = 23;
    const std::string bytes = encoded(session::ObjectWithWarnings{shared("24-cell"), {}});
    EXPECT_TRUE(decodeOutcome(bytes, "mine", {}));
    EXPECT_THROW((void)decodeOutcome(bytes, "mine", limits), std::runtime_error);
    const std::vector<std::string> warnings(1000, "so");
    EXPECT_THROW((void)decodeOutcome(encoded(session::ObjectWithWarnings{shared("5-cell"), warnings}), "mine", {}),
                 std::runtime_error);
}

// Decoding any bytes throws, returns an error, or returns a polytope that can be sliced.
TEST(ReadingMessages, CorruptedBytesAreHarmless) {
    std::mt19937 chance(5);
    slicing::Slicer slicer;
    slicing::SliceSet slices;
    int accepted = 0, refused = 0;
    const auto attempt = [&](const std::string& bytes) {
        try {
            const auto got = decodeOutcome(bytes, "mine", {});
            if (!got) return;
            ++accepted;
            const double radius = slicing::infoOf(got->object).circumradius;
            slicer.sliceWithoutSurfaces(got->object, {}, geometry::Hyperplanes{-2, 5, radius / 3}, slices);
        } catch (const std::runtime_error&) {
            ++refused;
        }
    };
    for (const char* name : {"5-cell", "tesseract", "{5/2,3,5}"}) {
        const std::string whole = encoded(session::ObjectWithWarnings{shared(name), {"so"}});
        for (std::size_t size = 0; size < std::min<std::size_t>(whole.size(), 2000); ++size)
            attempt(whole.substr(0, size));
        const int rounds = whole.size() > 5000 ? 300 : 3000;
        for (int round = 0; round < rounds; ++round) {
            std::string bytes = whole;
            for (unsigned changes = 1 + chance() % 3; changes > 0; --changes) {
                const std::size_t at = chance() % (bytes.size() - 8);
                const std::uint64_t odd[] = {0, 1, 0xffffffffU, ~std::uint64_t{0}, std::uint64_t{1} << 62U, chance()};
                std::memcpy(&bytes[at], &odd[chance() % std::size(odd)], std::size_t{1} << chance() % 4);
            }
            attempt(bytes);
        }
    }
    EXPECT_GT(accepted, 10);
    EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace oval4d::file_reading
