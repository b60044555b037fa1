#pragma once
// The addresses in X-Forwarded-For.

#include <optional>
#include <string_view>

#include <boost/asio/ip/address.hpp>

namespace oval4d::net {

/// Returns the address in an entry of X-Forwarded-For, as proxies write it: an IPv4 address, or an IPv6 address with or
/// without brackets, each with or without a port, with or without double quotes (RFC 7239, section 6). An IPv6 address
/// with a port needs brackets. Returns an empty optional for other entries, such as "unknown" and obfuscated
/// identifiers ("_hidden").
std::optional<boost::asio::ip::address> forwardedAddress(std::string_view entry);

}  // namespace oval4d::net
