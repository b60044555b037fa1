// Tests that apply() uses what needsLoading() has computed for a command, and does not compute it again.

#include <gtest/gtest.h>

#include <utility>

#include "session/load.hpp"
#include "session/object_loader.hpp"
#include "unit/session/support.hpp"

namespace oval4d::session {
namespace {

// The outcome of a command is computed once, because compiling a formula and sampling its field take milliseconds.
TEST(CommandOutcome, IsComputedOnlyOnce) {
    for (const Command& command : {Command(ShowLinkedView{"formula=x*y-z*w"}), Command(CommandLine{"polytope 24-cell"}),
                                   Command(KeyPress{"n", false, false}), Command(ShowLinkedView{"formula=x*"})}) {
        Session session;
        Session expected = session;
        ObjectLoader loader(Limits{}, support::cache(), ObjectLoader::LoadingMode::deferred, readObject);
        ComputedOutcome outcome;
        while (needsLoading(session, command, Limits{}, loader, outcome)) loader.completePending();
        ASSERT_TRUE(outcome);
        EXPECT_EQ(session, expected);
        const ComputedOutcome known = outcome;
        const auto done = apply(session, command, Limits{}, loader, std::move(outcome));
        ASSERT_EQ(static_cast<bool>(done), static_cast<bool>(*known));
        if (!done) {
            EXPECT_EQ(done.error().message, known->error().message);
            EXPECT_EQ(session, expected);
            continue;
        }
        EXPECT_EQ(session.current, (*known)->next) << "also the object is the same, and not an equal one";
        ASSERT_TRUE(session::apply(expected, command));
        EXPECT_EQ(slicing::infoOf(session.current.object).name, slicing::infoOf(expected.current.object).name);
        EXPECT_EQ(session.revision, expected.revision);
        EXPECT_EQ(session.loaded.size(), expected.loaded.size());
    }
}

}  // namespace
}  // namespace oval4d::session
