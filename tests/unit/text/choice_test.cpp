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

// A table is complete if it contains every enumerator at least once, and no name twice.
using FruitRow = NamedValue<Fruit>;
constexpr auto kAllFruits = std::to_array<FruitRow>(
    {{"pear", Fruit::pear}, {"apple", Fruit::apple}, {"plum", Fruit::plum}, {"pome", Fruit::pear}});
static_assert(isComplete(kAllFruits));
static_assert(completeTable<FruitRow>({{"a", Fruit::apple}, {"b", Fruit::pear}, {"c", Fruit::plum}}).size() == 3);
static_assert(!isComplete(kFruits));
static_assert(!isComplete(
    std::to_array<FruitRow>({{"a", Fruit::apple}, {"b", Fruit::pear}, {"c", Fruit::plum}, {"a", Fruit::plum}})));
static_assert(!isComplete(std::to_array<FruitRow>(
    {{"a", Fruit::apple}, {"b", Fruit::pear}, {"c", Fruit::plum}, {"d", static_cast<Fruit>(3)}})));
static_assert(!isComplete(std::to_array<FruitRow>(
    {{"a", Fruit::apple}, {"b", Fruit::pear}, {"c", Fruit::plum}, {"d", static_cast<Fruit>(kMaxEnumerators)}})));

static_assert(hasNoAliases(std::to_array<FruitRow>({{"pear", Fruit::pear}, {"plum", Fruit::plum}})));
static_assert(!hasNoAliases(kAllFruits));
enum class Equal { first = 1, second = 1 };
static_assert(!hasNoAliases(std::to_array<NamedValue<Equal>>({{"first", Equal::first}, {"second", Equal::second}})));

// The numbers of enumerators may have gaps.
enum class Sparse : unsigned char { two = 2, last = kMaxEnumerators - 1 };
static_assert(isComplete(std::to_array<NamedValue<Sparse>>({{"two", Sparse::two}, {"last", Sparse::last}})));
static_assert(!isComplete(std::to_array<NamedValue<Sparse>>({{"two", Sparse::two}})));

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
    EXPECT_EQ(joinedWithOr(Names{}), "");
    EXPECT_EQ(joinedWithOr(Names{"a"}), "a");
    EXPECT_EQ(joinedWithOr(Names{"a", "b"}), "a or b");
    EXPECT_EQ(joinedWithOr(namesOf(kFruits)), "apple, pear or pome");
}

}  // namespace
}  // namespace oval4d::text
