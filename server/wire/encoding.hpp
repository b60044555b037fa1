#pragma once
// The encodings of `slices` messages (the slices of a picture, sent to clients), and their writers.

#include <array>
#include <cstdint>
#include <string>

#include "text/choice.hpp"
#include "wire/bjdata_writer.hpp"
#include "wire/cbor_writer.hpp"
#include "wire/json_writer.hpp"
#include "wire/msgpack_writer.hpp"

namespace oval4d::wire {

/// An encoding of `slices` messages.
enum class Encoding : std::uint8_t { json, cbor, msgpack, bjdata };
inline constexpr auto kEncodings = text::completeTable<text::NamedValue<Encoding>>(
    {{"json", Encoding::json}, {"cbor", Encoding::cbor}, {"msgpack", Encoding::msgpack}, {"bjdata", Encoding::bjdata}});

/// Calls `write` with a writer for the encoding. The writer overwrites `out`.
template <typename Write>
void writeEncoded(Encoding encoding, std::string& out, const Write& write) {
    switch (encoding) {
        case Encoding::json:
            return write(JsonWriter(out));
        case Encoding::cbor:
            return write(CborWriter(out));
        case Encoding::msgpack:
            return write(MsgpackWriter(out));
        case Encoding::bjdata:
            return write(BjdataWriter(out));
    }
}

}  // namespace oval4d::wire
