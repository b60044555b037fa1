#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <sstream>

#include "export/omissions.hpp"
#include "unit/export/support.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::support;
using namespace oval4d::exports;
using namespace oval4d::geometry;
using namespace oval4d::polytopes;
using namespace oval4d::slicing;

TEST(File, isRefusedForWhatIsTooMuchOrNothing) {
    const Polytope& p = named("120-cell");
    const Rotation none;
    const ExportRequest skeleton{
        .format = formatNamed("stl"), .contents = ExportContentsKind::oval, .body = BodyKind::skeleton};
    const Hyperplanes oval{-10, 21, 0.5};
    ExportLimits limits = kUnhurried;
    limits.triangles = 1000;
    EXPECT_NE(fileOf(p, none, oval, skeleton, limits).find("1000 are allowed"), std::string::npos);
    limits = kUnhurried;
    limits.bytes = 1000;
    EXPECT_NE(fileOf(p, none, oval, defaultRequestFor(*formatNamed("off")), limits).find("1000 bytes"),
              std::string::npos);
    limits = {};
    limits.triangles = 100'000'000;
    limits.time = std::chrono::seconds(1);
    std::atomic<int> seconds = 0;  // increases by one whenever the export reads the clock
    limits.now = [&seconds] { return std::chrono::steady_clock::time_point(std::chrono::seconds(++seconds)); };
    EXPECT_NE(fileOf(p, none, oval, skeleton, limits).find("takes longer than"), std::string::npos);
    EXPECT_NE(fileOf(p, none, {90, 1, 1}, {}).find("is empty"), std::string::npos);
    std::stop_source stop;
    stop.request_stop();
    const auto given = exported(p, none, oval, skeleton, limits, stop.get_token());
    ASSERT_TRUE(std::holds_alternative<ExportRefusal>(given));
    EXPECT_EQ(std::get<ExportRefusal>(given).cause, ExportRefusal::Cause::too_long);
}

// A file is refused if the bars of the slice would be too thin. Here, the three bars are much thinner than the slice is
// long.
TEST(File, isRefusedIfItsBarsAreTooThin) {
    const Polytope& p = named("3,12000-duoprism");
    ExportRequest request{.format = formatNamed("stl"), .body = BodyKind::skeleton};
    EXPECT_NE(fileOf(p, {}, {0, 1, 1, 0.1}, request, kUnhurried).find("too thin"), std::string::npos);
    request.body = BodyKind::solid;
    EXPECT_EQ(fileOf(p, {}, {0, 1, 1, 0.1}, request, kUnhurried).find("too thin"), std::string::npos);
}

// Exporting the measurements of a field takes long, but respects the limits on time and memory.
TEST(File, ofAFieldIsBounded) {
    const SlicedBall ball({-2, 5, 0.2});
    const auto refusal = [&](const char* format, const ExportLimits& limits, std::stop_token stop = {}) {
        const ExportRequest request{.format = formatNamed(format), .contents = ExportContentsKind::oval};
        const auto made = ball.exported(request, limits, std::move(stop));
        return std::holds_alternative<ExportedFile>(made) ? "none" : std::get<ExportRefusal>(made).message;
    };
    std::stop_source stop;
    stop.request_stop();
    for (const char* format : {"csv", "pov", "stl", "vtp"}) {
        SCOPED_TRACE(format);
        EXPECT_EQ(refusal(format, kUnhurried), "none");
        EXPECT_NE(refusal(format, {.triangles = 1000, .time = kUnhurried.time}).find("1000"), std::string::npos);
        EXPECT_NE(refusal(format, {.time = std::chrono::duration<double>(1e-6)}).find("takes longer"),
                  std::string::npos);
        EXPECT_NE(refusal(format, kUnhurried, stop.get_token()).find("stopping"), std::string::npos);
        EXPECT_NE(refusal(format, {.time = kUnhurried.time,
                                   .grantTotalBytes = [](std::size_t bytes) { return bytes < 50'000; }})
                      .find("no room"),
                  std::string::npos);
    }
}

TEST(File, tellsWhatItLacks) {
    const Polytope& p = named("16-cell");
    const double top = std::sqrt(2);  // the w of a vertex, at which the slice is one point
    const Hyperplanes planes{0, 5, 0.1, 0, {0.5, -2, top, 0, 3}};
    const auto warnings = [&](const ExportRequest& request) {
        return std::get<ExportedFile>(exported(p, {}, planes, request)).warnings;
    };
    using Warnings = std::vector<std::string>;
    EXPECT_EQ(warnings({.format = formatNamed("stl"), .contents = ExportContentsKind::oval}),
              (Warnings{"2 of 5 slices are empty and left out: w = −2, 3",
                        "1 of 5 slices is flat or too thin and left out: w = 1.41421"}));
    EXPECT_EQ(
        warnings({.format = formatNamed("stl"), .contents = ExportContentsKind::oval, .body = BodyKind::skeleton}),
        Warnings{"2 of 5 slices are empty and left out: w = −2, 3"});
    EXPECT_EQ(warnings({.format = formatNamed("vtp"), .contents = ExportContentsKind::oval}),
              Warnings{"3 of 5 slices are without faces and left out: w = −2, 1.41421, 3"});
    EXPECT_EQ(warnings({.format = formatNamed("csv"), .contents = ExportContentsKind::oval}), Warnings{});
    // The slice at 1.2 is too small for letters, and the other slice is large enough.
    const Hyperplanes labeled{0, 2, 0.1, 0, {0, 1.2}};
    const auto made = exported(
        p, {}, labeled,
        {.format = formatNamed("stl"), .contents = ExportContentsKind::oval, .label = LabelPlacement::engraved});
    EXPECT_EQ(std::get<ExportedFile>(made).warnings,
              Warnings{"only 1 of 2 bodies have a label, because the others have no face that is flat and large "
                       "enough"});
}

TEST(File, listsOnlySomeOfManySlices) {
    std::vector<int> slices;
    for (int i = 0; i < 30; ++i) slices.push_back(i);
    EXPECT_EQ(omittedSlicesWarning({-2, 40, 0.5}, slices, "empty"),
              "30 of 40 slices are empty and left out: w = −1, −0.5, 0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5 and 18 "
              "more");
    EXPECT_EQ(omittedSlicesWarning({4, 1, 0.5}, std::vector<int>{0}, "empty"),
              "the slice is empty and left out: w = 2");
    EXPECT_EQ(omittedSlicesWarning({4, 1, 0.5}, std::vector<int>{0}, "empty", 98),
              "the slice is empty and left out: w = 100");
}

TEST(File, namesBodiesByTheirW) {
    // The names of bodies have enough decimals to distinguish the slices.
    const std::string text = fileOf(named("16-cell"), {}, {0, 3, 0.1, 0, {0.25, -0.5, 0.2504}},
                                    {.format = formatNamed("obj"), .contents = ExportContentsKind::oval});
    for (const char* name : {"o 16-cell,_w_=_0.25000\n", "o 16-cell,_w_=_\u22120.50000\n", "o 16-cell,_w_=_0.25040\n"})
        EXPECT_NE(text.find(name), std::string::npos) << name;
}

/// Returns the points of each body in an OBJ file.
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
        if (support::kSanitized && count > 21) continue;
        const double spacing = count == 1 ? 1 : 2 * p.circumradius / (count - 1);
        for (const BodyKind body : {BodyKind::solid, BodyKind::skeleton}) {
            const ExportRequest request{
                .format = formatNamed("obj"), .contents = ExportContentsKind::oval, .body = body};
            const auto bodies = bodiesIn(fileOf(p, {}, {-(count - 1) / 2, count, spacing}, request));
            EXPECT_GE(static_cast<int>(bodies.size()), std::max(1, count - 2));
            // The bounding spheres of the bodies must not overlap.
            std::vector<std::pair<glm::dvec3, double>> balls;
            for (const auto& points : bodies) {
                BoundingBox box;
                for (const auto& v : points) box.include(v);
                const glm::dvec3 middle = (box.min + box.max) / 2.0;
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
