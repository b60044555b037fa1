// The numbers that stored sessions contain. Servers of earlier versions have written them: a line of this file is never
// changed or removed, and a new enumerator or part adds one.

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "scene/look.hpp"
#include "text/choice.hpp"

namespace oval4d::store {
namespace {

using Numbers = std::vector<std::pair<std::string, unsigned>>;

template <text::HasChoices Enum>
Numbers numbersOf() {
    Numbers numbers;
    for (const auto& choice : choicesOf(Enum{})) {
        const bool isAlias = choice.name != text::nameOf(choicesOf(Enum{}), choice.value);
        if (!isAlias) numbers.emplace_back(choice.name, static_cast<unsigned>(choice.value));
    }
    return numbers;
}

TEST(StoredNumbers, OfEnumeratorsStayTheSame) {
    EXPECT_EQ(numbersOf<scene::View>(),
              (Numbers{{"oval", 0}, {"single", 1}, {"matrix", 2}, {"strip", 3}, {"column", 4}, {"grid", 5}}));
    EXPECT_EQ(numbersOf<scene::Coloring>(),
              (Numbers{{"cell", 0}, {"kind", 1}, {"w", 2}, {"plain", 3}, {"light", 4}, {"growth", 5}, {"value", 6}}));
    EXPECT_EQ(numbersOf<scene::CapStyle>(), (Numbers{{"plain", 0}, {"value", 1}, {"open", 2}}));
    EXPECT_EQ(numbersOf<scene::ProjectionKind>(), (Numbers{{"off", 0}, {"perspective", 1}, {"orthogonal", 2}}));
    EXPECT_EQ(numbersOf<scene::Background>(),
              (Numbers{{"auto", 0}, {"dark", 1}, {"light", 2}, {"white", 3}, {"transparent", 4}}));
    EXPECT_EQ(numbersOf<fields::Inside>(), (Numbers{{"below", 0}, {"above", 1}}));
    EXPECT_EQ(numbersOf<slicing::ElementKind>(), (Numbers{{"vertex", 0}, {"edge", 1}, {"face", 2}, {"cell", 3}}));
}

TEST(StoredNumbers, OfPlanesStayTheSame) {
    Numbers numbers;
    for (const geometry::Plane plane : geometry::kPlanes)
        numbers.emplace_back(geometry::name(plane), static_cast<unsigned>(plane));
    EXPECT_EQ(numbers, (Numbers{{"xy", 0}, {"xz", 1}, {"xw", 2}, {"yz", 3}, {"yw", 4}, {"zw", 5}}));
}

TEST(StoredNumbers, OfPartsStayTheSame) {
    Numbers numbers;
    for (const scene::NamedPart& part : scene::kParts)
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
