#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "unit/wire/support.hpp"
#include "wire/msgpack_writer.hpp"

namespace oval4d::wire {
namespace {

using nlohmann::json;

// Numbers have the shortest formats. The expected bytes follow the specification of MessagePack.
TEST(MsgpackWriter, WritesTheShortestFormats) {
    const auto bytes = written<MsgpackWriter>([](MsgpackWriter& w) {
        w.beginObject();
        w.member("a", 127);
        w.member("b", -32);
        w.member("c", -500);
        w.member("d", 0.5);
        w.member("e", 0.1);
        w.member("f", std::uint32_t{0x10000});
        w.member("g", true);
        w.key("h");
        w.beginArray();
        w.value(false);
        w.value("");
        w.endArray();
        w.key("i");
        w.numbers(std::vector<std::uint32_t>{1, 0x100});
        w.key("j");
        w.numbers(std::vector<std::uint32_t>{1, 2, 3});
        w.key("k");
        w.numbers({});
        w.key("l");
        w.id(7);
        w.endObject();
    });
    using namespace std::string_literals;
    EXPECT_EQ(bytes,
              "\xDF\0\0\0\x0C"
              "\xA1"
              "a\x7F"
              "\xA1"
              "b\xE0"
              "\xA1"
              "c\xD1\xFE\x0C"
              "\xA1"
              "d\xCA\x3F\0\0\0"
              "\xA1"
              "e\xCB\x3F\xB9\x99\x99\x99\x99\x99\x9A"
              "\xA1"
              "f\xCE\0\x01\0\0"
              "\xA1"
              "g\xC3"
              "\xA1"
              "h\xDD\0\0\0\x02\xC2\xA0"
              "\xA1"
              "i\xD6\x45\x01\0\0\x01"
              "\xA1"
              "j\xC7\x03\x40\x01\x02\x03"
              "\xA1"
              "k\xC7\0\x40"
              "\xA1"
              "l\x07"s);
}

TEST(MsgpackWriter, WritesIntegersOfAllWidths) {
    const std::vector<std::pair<std::int64_t, std::size_t>> numbersAndBytes{
        {0, 1},       {0x7F, 1},    {0x80, 2},          {0xFF, 2},          {0x100, 3},
        {0xFFFF, 3},  {0x10000, 5}, {0xFFFFFFFF, 5},    {0x100000000, 9},   {INT64_MAX, 9},
        {-1, 1},      {-32, 1},     {-33, 2},           {-0x80, 2},         {-0x81, 3},
        {-0x8000, 3}, {-0x8001, 5}, {-0x80000000LL, 5}, {-0x80000001LL, 9}, {INT64_MIN, 9}};
    for (const auto& [number, size] : numbersAndBytes) {
        const std::string bytes = written<MsgpackWriter>([whole = number](MsgpackWriter& w) { w.value(whole); });
        EXPECT_EQ(bytes.size(), size) << number;
        EXPECT_EQ(json::from_msgpack(bytes), json(number));
    }
}

TEST(MsgpackWriter, WritesTextsAndTypedArraysOfAllLengths) {
    for (const std::size_t length : {0, 1, 2, 3, 4, 8, 16, 17, 31, 32, 255, 256, 0xFFFF, 0x10000}) {
        const std::string text(length, 'x');
        const std::vector<std::uint32_t> numbers(length, 7);
        const json message = json::from_msgpack(written<MsgpackWriter>([&](MsgpackWriter& w) {
            w.beginArray();
            w.value(std::string_view(text));
            w.numbers(numbers);
            w.endArray();
        }));
        ASSERT_EQ(message.size(), 2U) << length;
        EXPECT_EQ(message.front(), json(text));
        const json::binary_t& bytes = message.back().get_binary();
        EXPECT_EQ(bytes.subtype(), 64U);
        EXPECT_EQ(std::vector<std::uint8_t>(bytes), std::vector<std::uint8_t>(length, 7));
    }
}

TEST(MsgpackWriter, CountsWhatIsInEachContainer) {
    const std::string bytes = written<MsgpackWriter>([](MsgpackWriter& w) {
        w.beginObject();
        w.key("list");
        w.beginArray();
        w.beginArray();
        w.value(1);
        w.value(2);
        w.endArray();
        w.beginArray();
        w.endArray();
        w.beginObject();
        w.key("none");
        w.beginObject();
        w.endObject();
        w.member("last", 3);
        w.endObject();
        w.endArray();
        w.member("after", true);
        w.endObject();
    });
    EXPECT_EQ(json::from_msgpack(bytes), json::parse(R"({"list":[[1,2],[],{"none":{},"last":3}],"after":true})"));
}

}  // namespace
}  // namespace oval4d::wire
