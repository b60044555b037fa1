#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "unit/wire/support.hpp"
#include "wire/bjdata_writer.hpp"
#include "wire/cbor_writer.hpp"
#include "wire/json_writer.hpp"
#include "wire/msgpack_writer.hpp"

namespace oval4d::wire {
namespace {

/// Returns an encoded object with four members. `writeInner` writes two of them.
template <typename W, typename WriteInner>
std::string objectAround(WriteInner writeInner) {
    return written<W>([&](W& w) {
        w.beginObject();
        w.member("first", 1);
        writeInner(w);
        w.member("last", true);
        w.endObject();
    });
}

template <typename W>
void expectMembersAsIfWrittenThere() {
    const auto writeMembers = [](W& w) {
        w.member("text", "x");
        w.key("list");
        w.beginArray();
        for (const std::uint32_t number : {1U, 2U}) w.value(number);
        w.endArray();
    };
    const std::string object = written<W>([&](W& w) {
        w.beginObject();
        writeMembers(w);
        w.endObject();
    });
    EXPECT_EQ(objectAround<W>([&](W& w) { w.appendMembersOf(object); }), objectAround<W>(writeMembers));
}

TEST(Writers, MembersOfAnObjectAreAsIfWrittenThere) {
    expectMembersAsIfWrittenThere<JsonWriter>();
    expectMembersAsIfWrittenThere<CborWriter>();
    expectMembersAsIfWrittenThere<MsgpackWriter>();
    expectMembersAsIfWrittenThere<BjdataWriter>();
}

// Numbers and arrays have the shortest heads. The expected bytes follow RFC 8949 and RFC 8746.
TEST(CborWriter, WritesTheShortestHeads) {
    const auto bytes = written<CborWriter>([](CborWriter& w) {
        w.beginObject();
        w.member("a", 23);
        w.member("b", -500);
        w.member("c", 0.5);
        w.member("d", std::uint32_t{0x10000});
        w.key("e");
        const std::vector<std::uint32_t> numbers{1, 0x100};
        w.numbers(numbers);
        w.key("f");
        w.numbers({});
        w.key("g");
        w.id(7);
        w.endObject();
    });
    using namespace std::string_literals;
    EXPECT_EQ(bytes,
              "\xBF"
              "\x61"
              "a\x17"
              "\x61"
              "b\x39\x01\xF3"
              "\x61"
              "c\xFA\x3F\0\0\0"
              "\x61"
              "d\x1A\0\x01\0\0"
              "\x61"
              "e\xD8\x45\x44\x01\0\0\x01"
              "\x61"
              "f\xD8\x40\x40"
              "\x61"
              "g\x07"
              "\xFF"s);
}

}  // namespace
}  // namespace oval4d::wire
