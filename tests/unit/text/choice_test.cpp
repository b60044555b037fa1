#include <array>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "text/choice.hpp"
#include "text/message_text.hpp"

namespace oval4d::text {
namespace {

enum class Fruit { apple, pear, plum };
constexpr auto kFruits =
    std::to_array<NamedValue<Fruit>>({{"apple", Fruit::apple}, {"pear", Fruit::pear}, {"pome", Fruit::apple}});

static_assert(valueNamed(kFruits, "pear") == Fruit::pear);
static_assert(nameOf(kFruits, Fruit::pear) == "pear");

TEST(NamedValue, FindsValuesByNameAndAlias) {
    EXPECT_EQ(valueNamed(kFruits, "apple"), Fruit::apple);
    EXPECT_EQ(valueNamed(kFruits, "pome"), Fruit::apple);
    EXPECT_FALSE(valueNamed(kFruits, "Apple"));
    EXPECT_FALSE(valueNamed(kFruits, "plum"));
    EXPECT_FALSE(valueNamed(kFruits, ""));
}

TEST(NamedValue, NamesAValueByItsFirstRow) {
    EXPECT_EQ(nameOf(kFruits, Fruit::apple), "apple");
    EXPECT_EQ(nameOf(kFruits, Fruit::plum), "");
}

TEST(NamedValue, ListsAllNames) {
    EXPECT_EQ(namesOf(kFruits), (std::vector<std::string_view>{"apple", "pear", "pome"}));
}

TEST(NamedValue, IsOneOfTheAlternatives) {
    using Names = std::vector<std::string_view>;
    EXPECT_EQ(alternatives(Names{}), "");
    EXPECT_EQ(alternatives(Names{"a"}), "a");
    EXPECT_EQ(alternatives(Names{"a", "b"}), "a or b");
    EXPECT_EQ(alternatives(namesOf(kFruits)), "apple, pear or pome");
}

}  // namespace
}  // namespace oval4d::text
