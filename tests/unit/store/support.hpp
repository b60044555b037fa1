#pragma once
// Helpers for the tests of session stores: random sessions, and comparing them after decoding.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "store/object_codec.hpp"
#include "store/session_codec.hpp"
#include "unit/session/support.hpp"

namespace oval4d::store {

/// Makes `other` refer to the same object as `one` if both objects have the same encoding.
inline void share(const slicing::Object& one, slicing::Object& other) {
    if (encodeObjectRecord(one) == encodeObjectRecord(other)) other = one;
}

/// Makes `other` refer to the objects of `one` that are equal to its own. A state has a source object, and this object
/// transformed to a frame of reference. The transformed objects are equal if the sources and the frames are equal.
inline void share(const session::State& one, session::State& other) {
    share(one.source, other.source);
    if (one.source == other.source && one.referenceFrame == other.referenceFrame) other.object = one.object;
}

/// Returns whether two sessions are equal. Objects count as equal if their encodings are equal.
inline bool same(const session::Session& one, session::Session other) {
    if (one.undoSteps.size() != other.undoSteps.size() || one.redoSteps.size() != other.redoSteps.size()) return false;
    share(one.current, other.current);
    for (std::size_t i = 0; i < one.undoSteps.size(); ++i) share(one.undoSteps[i], other.undoSteps[i]);
    for (std::size_t i = 0; i < one.redoSteps.size(); ++i) share(one.redoSteps[i], other.redoSteps[i]);
    for (auto& [name, object] : other.loaded) {
        const auto found = one.loaded.find(name);
        if (found != one.loaded.end()) share(found->second, object);
    }
    return one == other;
}

/// Returns a command that loads the convex hull of 12 random points. The points depend only on `seed`. If the seed is
/// odd, the hull turns about a point other than the origin.
inline session::LoadObject ownObject(const std::string& name, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    std::string text;
    for (int i = 0; i < 12; ++i) {
        for (int j = 0; j < 4; ++j) text += std::to_string(coordinate(random)) + (j < 3 ? " " : "\n");
    }
    session::LoadObject load{name, "points", text};
    if (seed % 2 == 1) load.center = {geometry::Centering::OriginChoice::point, {0.5, 0, -0.25, 1}};
    return load;
}

/// Applies random commands: keys, settings, loads, undo, redo and rotations.
inline void applyRandomCommands(session::Session& session, std::mt19937& random, int steps) {
    const std::string keys = "234567rtykjKJhl0G[]{}u.nNompfbe";
    std::uniform_real_distribution<double> angle(-7, 7);
    for (int i = 0; i < steps; ++i) {
        session::Command command =
            session::KeyPress{std::string(1, keys[random() % keys.size()]), random() % 4 == 0, false};
        session::ChangeSettings set;
        switch (random() % 10) {
            case 0:
                command = session::Rotate{{static_cast<geometry::Plane>(random() % 6), angle(random), {}}};
                break;
            case 1:
                set.plain.valueOf<double>("azimuth") = angle(random);
                set.plain.valueOf<double>("zoom") = 1.5;
                set.plain.valueOf<scene::Coloring>("color") = static_cast<scene::Coloring>(random() % 7);
                set.plain.valueOf<scene::SurfaceCapStyle>("caps") = static_cast<scene::SurfaceCapStyle>(random() % 3);
                set.plain.valueOf<scene::Background>("background") =
                    static_cast<scene::Background>(random() % scene::kBackgrounds.size());
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
            case 6:
                if (random() % 3 != 0) break;
                set.pace = std::exp(angle(random) / 4);
                set.follow = glm::dvec3(angle(random), 0, angle(random));
                set.boost = glm::dvec3(angle(random), angle(random), 0) / 10.0;
                command = set;
                break;
            default:
                break;
        }
        (void)session::apply(session, command);  // some commands fail, for example with nothing to undo
        if (session.current.isMoving()) session::advanceMotionBy(session, 0.01);
    }
}

}  // namespace oval4d::store
