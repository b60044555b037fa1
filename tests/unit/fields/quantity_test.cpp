#include "fields/quantity.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "text/message_text.hpp"

namespace oval4d::fields::test {
namespace {

TEST(Quantity, TextsAreShortAndPrintable) {
    const std::string longest(kMaxQuantityText, 'm');
    for (const std::string& text : {std::string(), std::string("K"), std::string("µg m⁻³"), longest}) {
        EXPECT_EQ(sanitizeQuantityText(text), text);
        EXPECT_TRUE(isQuantityText(text)) << text;
    }
    EXPECT_EQ(sanitizeQuantityText("  "), "");
    EXPECT_EQ(sanitizeQuantityText("\xff"
                                   "K\n"),
              "?K?");
    EXPECT_FALSE(isQuantityText("\xff"));
    for (const char* character : {"m", "é", "€", "𝛼"}) {
        for (std::size_t shift = 0; shift < 4; ++shift) {
            std::string text(shift, '.');
            while (text.size() <= kMaxQuantityText) text += character;
            EXPECT_FALSE(isQuantityText(text)) << text;
            const std::string cut = sanitizeQuantityText(text);
            EXPECT_TRUE(text::isUtf8(cut)) << cut;
            EXPECT_LE(cut.size(), kMaxQuantityText) << cut;
            EXPECT_TRUE(cut.ends_with("…")) << cut;
            EXPECT_TRUE(isQuantityText(cut)) << cut;
        }
    }
}

TEST(Quantity, ProductsHaveProductsOfUnits) {
    const auto product = [](const std::vector<std::string>& units) { return unitOfProduct(units); };
    EXPECT_EQ(product({}), "");
    EXPECT_EQ(product({"m"}), "m");
    EXPECT_EQ(product({"m", "m"}), "m²");
    EXPECT_EQ(product({"m", "s", "m"}), "m² s");
    EXPECT_EQ(product({"m s-1"}), "m s-1");
    EXPECT_EQ(product({"m s-1", "m s-1", "m s-1"}), "(m s-1)³");
    EXPECT_EQ(product({"m", "m", "m", "m", "m"}), "m^5");
    EXPECT_EQ(product({"m", ""}), "");
}

TEST(Quantity, LabelsHaveWhatIsKnown) {
    EXPECT_EQ(labelOf({"temperature", "K"}), "temperature, K");
    EXPECT_EQ(labelOf({"temperature", ""}), "temperature");
    EXPECT_EQ(labelOf({"", "K"}), "K");
    EXPECT_EQ(labelOf({}), "");
}

}  // namespace
}  // namespace oval4d::fields::test
