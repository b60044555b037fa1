#include <algorithm>
#include <sstream>

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
    const ExportRequest skeleton{.format = formatNamed("stl"), .extent = Extent::oval, .body = Body::skeleton};
    const Hyperplanes oval{-10, 21, 0.5};
    Limits limits;
    limits.triangles = 1000;
    EXPECT_NE(fileOf(p, none, oval, skeleton, limits).find("1000 are allowed"), std::string::npos);
    limits = {};
    limits.bytes = 1000;
    EXPECT_NE(fileOf(p, none, oval, {.format = formatNamed("off")}, limits).find("1000 bytes"), std::string::npos);
    limits = {};
    limits.triangles = 100'000'000;
    limits.time = std::chrono::duration<double>(1e-6);
    EXPECT_NE(fileOf(p, none, oval, skeleton, limits).find("takes longer than"), std::string::npos);
    EXPECT_NE(fileOf(p, none, {90, 1, 1}, {}).find("is empty"), std::string::npos);
    std::stop_source stop;
    stop.request_stop();
    const auto given = exported(p, none, oval, skeleton, limits, stop.get_token());
    ASSERT_TRUE(std::holds_alternative<ExportError>(given));
    EXPECT_EQ(std::get<ExportError>(given).cause, ExportError::Cause::too_long);
}

/// Returns the points of each body of an OBJ file.
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
        for (const Body body : {Body::solid, Body::skeleton}) {
            const auto bodies = bodiesIn(fileOf(p, {}, {-(count - 1) / 2, count, spacing},
                                                {.format = formatNamed("obj"), .extent = Extent::oval, .body = body}));
            EXPECT_GE(static_cast<int>(bodies.size()), std::max(1, count - 2));
            // The bounding spheres of the bodies must not overlap.
            std::vector<std::pair<glm::dvec3, double>> balls;
            for (const auto& points : bodies) {
                Box box;
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
