// Tests of formulas that a setting or an address contains together with the name of a field.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "fields/field.hpp"
#include "session/example_fields.hpp"
#include "session/load.hpp"
#include "unit/session/support.hpp"

namespace oval4d::session {
namespace {

ChangeSettings objectNamed(const std::string& name) {
    ChangeSettings set;
    set.object = name;
    return set;
}

ChangeSettings formulaNamed(const std::string& name, const std::string& formula) {
    ChangeSettings set = objectNamed(name);
    set.formula = LoadObject{name, std::string(kFormula), formula};
    set.formula->box = fields::Box{glm::dvec4(-1), glm::dvec4(1)};
    return set;
}

TEST(Formulas, OfASettingAreLoaded) {
    Session session;
    ChangeSettings set = formulaNamed("mine", "x^2 + y^2 + z^2 + w^2");
    set.levels = std::vector<double>{0.25};
    must(session, set);
    EXPECT_EQ(infoOf(session.current).name, "mine");
    EXPECT_EQ(session.current.look.field.levels, std::vector<double>{0.25});
    ASSERT_TRUE(session.loaded.contains("mine"));
    const slicing::Object first = session.current.object;

    must(session, set);
    EXPECT_TRUE(session.current.object == first) << "the same formula is not loaded again";
    must(session, Undo{});
    EXPECT_EQ(infoOf(session.current).name, "5-cell");
    must(session, objectNamed("mine"));
    EXPECT_TRUE(session.current.object == first);

    must(session, formulaNamed("mine", "x + y"));
    EXPECT_EQ(slicing::fieldIn(session.current.object)->formula, "x + y");
    EXPECT_EQ(session.loaded.size(), 1U);
}

TEST(Formulas, OfASettingThatIsRefusedAreNotLoaded) {
    Session session;
    expectRefused(session, formulaNamed("mine", "x +"), ErrorCode::bad_expression, "position 4");
    expectRefused(session, formulaNamed("tesseract", "x"), ErrorCode::bad_polytope, "tesseract");
    ChangeSettings set = formulaNamed("mine", "x");
    set.plain.valueOf<double>("zoom") = 1e9;
    expectRefused(session, set, ErrorCode::out_of_range, "zoom");
    EXPECT_TRUE(session.loaded.empty());
    Limits one;
    one.maxLoaded = 1;
    must(session, formulaNamed("mine", "x"), one);
    expectRefused(session, formulaNamed("other", "y"), ErrorCode::too_many, "at most 1", one);
    must(session, formulaNamed("mine", "y"), one);
}

// The formula of an example field is not loaded again, because all sessions share the example fields.
TEST(Formulas, OfExamplesAreNotLoaded) {
    Session session;
    must(session, objectNamed(exampleFields().front().name));
    const fields::Field& example = *slicing::fieldIn(session.current.object);
    ChangeSettings set = formulaNamed(example.name, example.formula);
    set.formula->box = example.box;
    must(session, set);
    EXPECT_TRUE(session.loaded.empty());
    EXPECT_EQ(slicing::fieldIn(session.current.object), &example);
}

}  // namespace
}  // namespace oval4d::session
