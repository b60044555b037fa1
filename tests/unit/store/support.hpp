#pragma once
// Shared by the tests of the stores: random sessions, and their comparison after decoding.

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "store/codec.hpp"
#include "store/object_codec.hpp"
#include "unit/session/support.hpp"

namespace oval4d::store {

/// Replaces `other` by `one` if their encodings are equal.
inline void share(const slicing::Object& one, slicing::Object& other) {
    if (encodeObjectRecord(one) == encodeObjectRecord(other)) other = one;
}

/// Whether the sessions are equal, even if they refer to equal objects that were built separately.
inline bool same(const session::Session& one, session::Session other) {
    if (one.undoSteps.size() != other.undoSteps.size() || one.redoSteps.size() != other.redoSteps.size()) return false;
    share(one.current.object, other.current.object);
    for (std::size_t i = 0; i < one.undoSteps.size(); ++i) share(one.undoSteps[i].object, other.undoSteps[i].object);
    for (std::size_t i = 0; i < one.redoSteps.size(); ++i) share(one.redoSteps[i].object, other.redoSteps[i].object);
    for (auto& [name, object] : other.loaded) {
        const auto found = one.loaded.find(name);
        if (found != one.loaded.end()) share(found->second, object);
    }
    return one == other;
}

/// The convex hull of random points, a different one for each seed, as a load command.
inline session::Load ownObject(const std::string& name, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    std::string text;
    for (int i = 0; i < 12; ++i) {
        for (int j = 0; j < 4; ++j) text += std::to_string(coordinate(random)) + (j < 3 ? " " : "\n");
    }
    return {name, "points", text};
}

/// Applies random commands: keys, settings, loads, undo, redo and rotations.
inline void wander(session::Session& session, std::mt19937& random, int steps) {
    const std::string keys = "234567rtykjKJhl0G[]{}u.nNompfbe";
    std::uniform_real_distribution<double> angle(-7, 7);
    for (int i = 0; i < steps; ++i) {
        session::Command command = session::Key{std::string(1, keys[random() % keys.size()]), random() % 4 == 0, false};
        session::Set set;
        switch (random() % 10) {
            case 0:
                command = session::Rotate{{static_cast<geometry::Plane>(random() % 6), angle(random), {}}};
                break;
            case 1:
                set.azimuth = angle(random);
                set.zoom = 1.5;
                set.coloring = static_cast<scene::Coloring>(random() % 4);
                set.hidden = {{0}};
                command = set;
                break;
            case 2:
                command = random() % 4 == 0 ? ownObject("mine " + std::to_string(random() % 3), random() % 5)
                                            : session::Command(session::CommandLine{"polytope truncated 24-cell"});
                break;
            case 3:
                command = session::Redo{};
                break;
            case 4:
                command = session::TurnToward{slicing::ElementKind::edge, {}};
                break;
            case 5:
                set.offset = 0.1 * angle(random);
                set.focusPoint = glm::dvec4(angle(random), angle(random), angle(random), 0);
                command = set;
                break;
            default:
                break;
        }
        (void)session::apply(session, command);  // some commands fail, for example with nothing to undo
        if (session.current.moves()) session::advance(session, 0.01);
    }
}

}  // namespace oval4d::store
