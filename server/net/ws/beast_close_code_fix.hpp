#pragma once
// Corrects which close codes Beast accepts from clients. Beast 1.81 rejects 1014, which IANA has registered. It accepts
// codes from 5000 on, which RFC 6455, section 7.4.2, does not allow. Beast has no option to change this. So this header
// specializes read_close(), the function template with which Beast reads a close frame, for the buffers that Beast
// passes to it. Every source file that uses a WebSocket stream must include this header, because a file that
// instantiates the original template violates the one-definition rule.

#include <array>
#include <boost/beast/core/buffers_prefix.hpp>
#include <boost/beast/core/static_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <cstdint>
#include <utility>

namespace oval4d::net {

/// Returns whether a close code may be sent (RFC 6455, section 7.4, and IANA's "WebSocket Close Code Number Registry").
/// Allowed are 1000 to 1003, 1007 to 1014, and 3000 to 4999 (for libraries and applications). 1004 is reserved; 1005,
/// 1006 and 1015 must never be sent.
constexpr bool isSendableCloseCode(std::uint16_t code) {
    return (code >= 1000 && code <= 1003) || (code >= 1007 && code <= 1014) || (code >= 3000 && code <= 4999);
}

/// The type of the buffers in which Beast holds the payload of a close frame (an Asio ConstBufferSequence). The payload
/// has at most 125 bytes (RFC 6455, section 5.5).
using ClosePayloadBuffers =
    decltype(boost::beast::buffers_prefix(0, std::declval<boost::beast::static_buffer_base&>().data()));

}  // namespace oval4d::net

namespace boost::beast::websocket::detail {

template <>  // NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name): Beast calls them cr, bs and ec
inline void read_close(close_reason& reason, const oval4d::net::ClosePayloadBuffers& payload, error_code& fault) {
    std::array<char, 125> bytes{};
    const std::size_t size = net::buffer_copy(net::buffer(bytes), payload);
    reason = close_reason{};
    fault = {};
    if (size == 0) return;
    if (size == 1) {
        fault = error::bad_close_size;
        return;
    }
    reason.code =
        static_cast<std::uint16_t>(static_cast<unsigned char>(bytes[0]) << 8U | static_cast<unsigned char>(bytes[1]));
    reason.reason = string_view(bytes.data() + 2, size - 2);
    if (!oval4d::net::isSendableCloseCode(reason.code)) {
        fault = error::bad_close_code;
    } else if (!check_utf8(reason.reason.data(), reason.reason.size())) {
        fault = error::bad_close_payload;
    }
}

}  // namespace boost::beast::websocket::detail
