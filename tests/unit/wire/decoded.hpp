#pragma once
// Decodes `slices` messages in every encoding.

#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "wire/request.hpp"

namespace oval4d::wire {

/// Returns a decoded message. The typed arrays of binary encodings become binary values whose subtypes are the numbers
/// of ArrayType. Throws nlohmann::json::exception if the bytes are not a message in this encoding.
inline nlohmann::json decoded(const std::string& message, Encoding encoding) {
    using nlohmann::json;
    switch (encoding) {
        case Encoding::json:
            return json::parse(message);
        case Encoding::cbor:
            return json::from_cbor(message, true, true, json::cbor_tag_handler_t::store);
        case Encoding::msgpack:
            return json::from_msgpack(message);
    }
    throw std::logic_error("this encoding has no decoder in the tests");
}

}  // namespace oval4d::wire
