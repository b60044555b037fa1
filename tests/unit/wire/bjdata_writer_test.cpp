#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "unit/wire/support.hpp"
#include "wire/bjdata_writer.hpp"

namespace oval4d::wire {
namespace {

using nlohmann::json;

// Numbers have the shortest markers. The expected bytes follow the specification of BJData, draft 2.
TEST(BjdataWriter, WritesTheShortestMarkers) {
    const auto bytes = written<BjdataWriter>([](BjdataWriter& w) {
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
        w.numbers({});
        w.key("k");
        w.floatsForPictures(std::vector<float>{0.5F});
        w.key("l");
        w.id(7);
        w.endObject();
    });
    using namespace std::string_literals;
    EXPECT_EQ(bytes,
              "{U\x01"
              "aU\x7F"
              "U\x01"
              "bi\xE0"
              "U\x01"
              "cI\x0C\xFE"
              "U\x01"
              "dd\0\0\0\x3F"
              "U\x01"
              "eD\x9A\x99\x99\x99\x99\x99\xB9\x3F"
              "U\x01"
              "fm\0\0\x01\0"
              "U\x01"
              "gT"
              "U\x01"
              "h[FSU\0]"
              "U\x01"
              "i[$u#U\x02\x01\0\0\x01"
              "U\x01"
              "j[$U#U\0"
              "U\x01"
              "k[$d#U\x01\0\0\0\x3F"
              "U\x01"
              "lU\x07}"s);
}

TEST(BjdataWriter, WritesIntegersOfAllWidths) {
    const std::vector<std::pair<std::int64_t, std::size_t>> numbersAndBytes{
        {0, 2},       {0xFF, 2},          {0x100, 3},         {0xFFFF, 3},
        {0x10000, 5}, {0xFFFFFFFF, 5},    {0x100000000, 9},   {INT64_MAX, 9},
        {-1, 2},      {-0x80, 2},         {-0x81, 3},         {-0x8000, 3},
        {-0x8001, 5}, {-0x80000000LL, 5}, {-0x80000001LL, 9}, {INT64_MIN, 9}};
    for (const auto& [number, size] : numbersAndBytes) {
        const std::string bytes = written<BjdataWriter>([whole = number](BjdataWriter& w) { w.value(whole); });
        EXPECT_EQ(bytes.size(), size) << number;
        EXPECT_EQ(json::from_bjdata(bytes), json(number));
    }
}

TEST(BjdataWriter, WritesTextsAndTypedArraysOfAllLengths) {
    for (const std::size_t length : {0, 1, 255, 256, 0xFFFF, 0x10000}) {
        const std::string text(length, 'x');
        const std::vector<double> numbers(length, 0.1);
        const json message = json::from_bjdata(written<BjdataWriter>([&](BjdataWriter& w) {
            w.beginObject();
            w.member("text", std::string_view(text));
            w.key("numbers");
            w.doubles(numbers);
            w.key(text);
            w.numbers(std::vector<std::uint32_t>(length, 0x10000));
            w.endObject();
        }));
        ASSERT_EQ(message.size(), 3U) << length;
        EXPECT_EQ(message.at("text"), json(text));
        EXPECT_EQ(message.at("numbers"), json(numbers));
        EXPECT_EQ(message.at(text), json(std::vector<std::uint32_t>(length, 0x10000)));
    }
}

}  // namespace
}  // namespace oval4d::wire
