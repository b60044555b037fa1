#include "pipeline/focus_section.hpp"

#include <gtest/gtest.h>

#include "session/example_fields.hpp"
#include "unit/polytopes/support.hpp"

namespace oval4d::pipeline {
namespace {

session::State stateOf(const slicing::Object& object) {
    session::State state = session::initialState();
    state.source = state.object = object;
    return state;
}

TEST(FocusSectionNamer, IsFastWhereThereIsLittleToCut) {
    EXPECT_TRUE(FocusSectionNamer::isFast(session::initialState()));
    EXPECT_TRUE(FocusSectionNamer::isFast(stateOf(support::shared("24-cell"))));
    EXPECT_FALSE(FocusSectionNamer::isFast(stateOf(support::shared("600-cell"))));
    const session::State field = stateOf(session::exampleFields().front().field);
    EXPECT_TRUE(FocusSectionNamer::isFast(field));
    EXPECT_EQ(FocusSectionNamer().names(field), slicing::SectionNamePair{}) << "sections of fields have no names";
}

}  // namespace
}  // namespace oval4d::pipeline
