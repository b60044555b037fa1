#pragma once
// Helpers for the tests of the `slices` message.

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/composer.hpp"
#include "slicing/slicer.hpp"
#include "unit/session/support.hpp"
#include "unit/wire/decoded.hpp"
#include "wire/slices_message.hpp"

namespace oval4d::wire {

/// The slices and the scene of a session's state. The scene refers to `slices`.
struct Picture {
    std::shared_ptr<const polytopes::Polytope> polytope;  // null if the object is not a polytope
    slicing::SliceSet slices;
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

inline Picture pictureOf(const std::vector<std::string>& lines) {
    session::Session session;
    for (const std::string& line : lines) {
        const auto done = apply(session, session::CommandLine{line});
        EXPECT_TRUE(done) << done.error().message;
    }
    return Picture(session.current);
}

inline std::string messageOf(const Picture& picture, Encoding encoding, double id = 3) {
    std::string out = "what was there before";
    SlicesMessageWriter().write(picture.scene, 7, id, encoding, out);
    return out;
}

inline nlohmann::json decodedMessageOf(const Picture& picture, Encoding encoding, double id = 3) {
    return decoded(messageOf(picture, encoding, id), encoding);
}

inline std::vector<Encoding> binaryEncodings() {
    std::vector<Encoding> encodings;
    for (const auto& choice : kEncodings) {
        if (choice.value != Encoding::json) encodings.push_back(choice.value);
    }
    return encodings;
}

inline void expectPoint(const nlohmann::json& point, const double* expected, std::size_t size) {
    ASSERT_EQ(point.size(), size);
    for (std::size_t i = 0; i < size; ++i) EXPECT_EQ(point[i].get<float>(), static_cast<float>(expected[i]));
}

inline void expectSlices(const nlohmann::json& list, const Picture& picture) {
    const slicing::SliceSet& set = picture.slices;
    ASSERT_EQ(list.size(), static_cast<std::size_t>(set.planes.count));
    for (int i = 0; i < set.planes.count; ++i) {
        const nlohmann::json& slice = list[i];
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
            EXPECT_EQ(slice.at("edges")[e], nlohmann::json(set.edges[set.edgeBegin[i] + e]));
            EXPECT_EQ(slice.at("of").at("edges").at(e), set.edgeSource[set.edgeBegin[i] + e]);
        }
        ASSERT_EQ(slice.at("faces").size(), set.faceCount(i));
        for (std::size_t f = 0; f < set.faceCount(i); ++f) {
            const std::size_t face = set.faceBegin[i] + f;
            const std::vector<std::uint32_t> corners(set.corners.begin() + set.cornerBegin[face],
                                                     set.corners.begin() + set.cornerBegin[face + 1]);
            EXPECT_EQ(slice.at("faces")[f], nlohmann::json(corners));
            EXPECT_EQ(slice.at("of").at("faces").at(f), set.faceSource[face]);
        }
    }
}

}  // namespace oval4d::wire
