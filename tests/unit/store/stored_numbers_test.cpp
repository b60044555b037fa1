// Tests of the numbers in stored sessions. Servers of earlier versions have written these numbers, so no line of this
// file may change. A new enumerator, part of the picture, or setting with choices adds a line.

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "scene/look.hpp"
#include "session/setting_table.hpp"
#include "text/choice.hpp"

namespace oval4d::store {
namespace {

using Numbers = std::vector<std::pair<std::string, unsigned>>;

template <text::HasChoices Enum>
Numbers numbersOf() {
    Numbers numbers;
    for (const auto& choice : choicesOf(Enum{})) numbers.emplace_back(choice.name, static_cast<unsigned>(choice.value));
    return numbers;
}

TEST(StoredNumbers, OfEnumeratorsStayTheSame) {
    std::map<std::string, Numbers> numbers{{"highlight", numbersOf<slicing::ElementKind>()}};
    session::forEachSetting([&]<typename Row>(const Row& setting) {
        if constexpr (Row::kIsInState) {
            using Value = std::remove_cvref_t<decltype(setting.ofState(std::declval<session::State&>()))>;
            if constexpr (text::HasChoices<Value>) numbers.emplace(setting.name.text, numbersOf<Value>());
        }
    });
    const std::map<std::string, Numbers> expected{
        {"view", {{"oval", 0}, {"single", 1}, {"matrix", 2}, {"strip", 3}, {"column", 4}, {"grid", 5}}},
        {"color", {{"cell", 0}, {"kind", 1}, {"w", 2}, {"plain", 3}, {"light", 4}, {"growth", 5}, {"value", 6}}},
        {"caps", {{"plain", 0}, {"value", 1}, {"open", 2}}},
        {"projection", {{"off", 0}, {"perspective", 1}, {"orthogonal", 2}}},
        {"background", {{"auto", 0}, {"dark", 1}, {"light", 2}, {"white", 3}, {"transparent", 4}}},
        {"inside", {{"below", 0}, {"above", 1}}},
        {"highlight", {{"vertex", 0}, {"edge", 1}, {"face", 2}, {"cell", 3}}}};
    EXPECT_EQ(numbers, expected);
}

TEST(StoredNumbers, OfPlanesStayTheSame) {
    Numbers numbers;
    for (const geometry::Plane plane : geometry::kPlanes)
        numbers.emplace_back(geometry::planeName(plane), static_cast<unsigned>(plane));
    EXPECT_EQ(numbers, (Numbers{{"xy", 0}, {"xz", 1}, {"xw", 2}, {"yz", 3}, {"yw", 4}, {"zw", 5}}));
}

TEST(StoredNumbers, OfPartsStayTheSame) {
    Numbers numbers;
    for (const scene::NamedPicturePart& part : scene::kParts)
        numbers.emplace_back(part.name, static_cast<unsigned>(part.number));
    EXPECT_EQ(numbers, (Numbers{{"faces", 0},
                                {"bars", 1},
                                {"balls", 2},
                                {"coordinates", 3},
                                {"labels", 4},
                                {"cells", 5},
                                {"back", 6},
                                {"sections", 7}}));
}

}  // namespace
}  // namespace oval4d::store
