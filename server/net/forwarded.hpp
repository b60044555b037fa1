#pragma once
// Parses the addresses in the HTTP header field X-Forwarded-For.

#include <optional>
#include <string_view>

#include <boost/asio/ip/address.hpp>

namespace oval4d::net {

/// Returns the address in an entry of X-Forwarded-For. The entry is an IPv4 or IPv6 address, with or without a port,
/// and with or without double quotes (RFC 7239, section 6). An IPv6 address may have brackets; with a port, it must
/// have them. Returns an empty optional for other entries, such as "unknown" or obfuscated identifiers ("_hidden").
std::optional<boost::asio::ip::address> forwardedAddress(std::string_view entry);

}  // namespace oval4d::net
