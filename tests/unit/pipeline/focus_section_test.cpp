#include "pipeline/focus_section.hpp"

#include <gtest/gtest.h>

#include "session/example_fields.hpp"
#include "unit/polytopes/support.hpp"

namespace oval4d::pipeline {
namespace {

TEST(FocusSectionNamer, IsFastWhereThereIsLittleToCut) {
    EXPECT_TRUE(FocusSectionNamer::isFast(support::shared("24-cell")));
    EXPECT_FALSE(FocusSectionNamer::isFast(support::shared("600-cell")));
    const slicing::Object field = session::exampleFields().front().field;
    EXPECT_TRUE(FocusSectionNamer::isFast(field));
    scene::PictureRequest picture;
    picture.source = picture.object = field;
    EXPECT_EQ(FocusSectionNamer().name(picture).names, slicing::SliceAndHullNames{})
        << "sections of fields have no names";
}

}  // namespace
}  // namespace oval4d::pipeline
