#pragma once
// What the store's tests share: sessions with everything in them, and how they compare when read back.

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "session/session.hpp"
#include "store/codec.hpp"

namespace oval4d::store {

/// `other` with the polytopes of `one` wherever they are the same in all that is kept.
inline void sharePolytopes(const session::State& one, session::State& other) {
    if (encodePolytope(*one.polytope) == encodePolytope(*other.polytope)) other.polytope = one.polytope;
}

/// Equal, though the polytopes may have been built twice.
inline bool same(const session::Session& one, session::Session other) {
    if (one.past.size() != other.past.size() || one.future.size() != other.future.size()) return false;
    sharePolytopes(one.now, other.now);
    for (std::size_t i = 0; i < one.past.size(); ++i) sharePolytopes(one.past[i], other.past[i]);
    for (std::size_t i = 0; i < one.future.size(); ++i) sharePolytopes(one.future[i], other.future[i]);
    for (auto& [name, polytope] : other.loaded) {
        const auto found = one.loaded.find(name);
        if (found != one.loaded.end() && encodePolytope(*found->second) == encodePolytope(*polytope)) {
            polytope = found->second;
        }
    }
    return one == other;
}

/// A polytope of the user's own, a different one for each seed: the hull of random points.
inline protocol::Load ownPolytope(const std::string& name, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    std::string text;
    for (int i = 0; i < 12; ++i) {
        for (int j = 0; j < 4; ++j) text += std::to_string(coordinate(random)) + (j < 3 ? " " : "\n");
    }
    return {name, "points", text};
}

/// Presses keys, sets, loads, undoes and turns at random.
inline void wander(session::Session& session, std::mt19937& random, int steps) {
    const std::string keys = "234567rtykjKJhl0G[]{}u.nNopfbe";
    std::uniform_real_distribution<double> angle(-7, 7);
    for (int i = 0; i < steps; ++i) {
        protocol::Command command =
            protocol::Key{std::string(1, keys[random() % keys.size()]), random() % 4 == 0, false};
        protocol::Set set;
        switch (random() % 8) {
            case 0:
                command = protocol::Rotate{{static_cast<geometry::Plane>(random() % 6), angle(random), {}}};
                break;
            case 1:
                set.azimuth = angle(random);
                set.zoom = 1.5;
                set.colouring = static_cast<scene::Colouring>(random() % 4);
                set.hidden = {{0}};
                command = set;
                break;
            case 2:
                command = random() % 4 == 0 ? ownPolytope("mine " + std::to_string(random() % 3), random() % 5)
                                            : protocol::Command(protocol::CommandLine{"polytope truncated 24-cell"});
                break;
            case 3:
                command = protocol::Redo{};
                break;
            default:
                break;
        }
        (void)session::apply(session, command, session::Limits{});  // some find nothing to do, and that is well
        if (session.now.turning) session::advance(session, 0.01);
    }
}

}  // namespace oval4d::store
