#pragma once
// Helpers for the tests of sessions.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>

#include <gtest/gtest.h>

#include "session/object_loader.hpp"
#include "session/query.hpp"
#include "session/session.hpp"
#include "session/setting_table.hpp"
#include "unit/polytopes/support.hpp"

namespace oval4d::session {

inline const geometry::ObjectInfo& infoOf(const State& state) { return slicing::infoOf(state.object); }

/// Executes a command. Loads the objects that it needs on the calling thread, with the test program's cache of
/// polytopes.
inline Result<std::monostate> apply(Session& session, const Command& command, const Limits& limits = {}) {
    ObjectLoader loader(limits, support::cache());
    return apply(session, command, limits, loader);
}

inline Result<State> stateFromQuery(const QueryParameters& query, const Limits& limits = {}) {
    ObjectLoader loader(limits, support::cache());
    return stateFromQuery(query, limits, loader);
}

inline void expectNear(const State& a, const State& b, double tolerance) {
    EXPECT_EQ(a.object, b.object);
    const glm::dmat4 m = a.orientation.matrix();
    const glm::dmat4 n = b.orientation.matrix();
    for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 4; ++r) EXPECT_NEAR(m[c][r], n[c][r], tolerance);
    }
    State rest = b;
    forEachSetting([&]<typename Row>(const Row& setting) {
        if constexpr (Row::kHasRange) {
            EXPECT_NEAR(setting.ofState(a), setting.ofState(b), tolerance) << setting.name.text;
            setting.ofState(rest) = setting.ofState(a);
        }
    });
    EXPECT_NEAR(a.slices.spacing, b.slices.spacing, tolerance);
    EXPECT_EQ(a.slices.count, b.slices.count);
    EXPECT_EQ(a.slices.focus, b.slices.focus);
    EXPECT_EQ(a.look, rest.look);
    EXPECT_EQ(a.turning, b.turning);
    EXPECT_EQ(a.playing, b.playing);
}

/// Executes a command, and expects that it succeeds.
inline void must(Session& session, const Command& command, const Limits& limits = {}) {
    const auto done = apply(session, command, limits);
    ASSERT_TRUE(done) << done.error().message;
}

inline void press(Session& session, const std::string& keys) {
    for (const char key : keys) must(session, KeyPress{std::string(1, key), false, false});
}

inline void line(Session& session, const std::string& text) { must(session, CommandLine{text}); }

/// Executes a command, and expects that it fails with this code and with `says` in the message. The session must not
/// change, except that the refused action of a key ends a sequence of keys.
inline void expectRefused(Session& session, const Command& command, ErrorCode code, const std::string& says,
                          const Limits& limits = {}) {
    Session expected = session;
    const auto done = apply(session, command, limits);
    ASSERT_FALSE(done) << "expected: " << says;
    if (std::holds_alternative<KeyPress>(command) && code != ErrorCode::unknown_key) expected.pendingKey.clear();
    EXPECT_EQ(protocolName(done.error().code), protocolName(code)) << done.error().message;
    EXPECT_NE(done.error().message.find(says), std::string::npos) << done.error().message;
    EXPECT_TRUE(session == expected) << done.error().message;
}

/// Executes a command as a server does, and sets `done` to the result. Returns how many times the server must wait for
/// `loader` to load an object.
inline int ordersOf(Session& session, const Command& command, ObjectLoader& loader, Result<std::monostate>& done) {
    const Session before = session;
    int orders = 0;
    ComputedOutcome outcome;
    for (; needsLoading(session, command, Limits{}, loader, outcome); ++orders) loader.completePending();
    EXPECT_EQ(session, before);
    done = apply(session, command, Limits{}, loader, std::move(outcome));
    EXPECT_FALSE(loader.isPending()) << "a command needs nothing that needsLoading() has not found";
    return orders;
}

}  // namespace oval4d::session
