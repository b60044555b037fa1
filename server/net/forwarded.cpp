#include "net/forwarded.hpp"

#include <algorithm>
#include <string>

#include <boost/system/error_code.hpp>

#include "text/ascii.hpp"
#include "text/words.hpp"

namespace oval4d::net {

namespace {

// Shortens `text` to the host, which is its first `hostLength` bytes. Returns whether the rest was empty or a valid
// ":port".
bool cutToHost(std::string_view& text, std::size_t hostLength) {
    constexpr std::size_t kMaxDigits = 5;
    const std::string_view rest = text.substr(hostLength);
    text = text.substr(0, hostLength);
    return rest.empty() || (rest.starts_with(':') && rest.size() > 1 && rest.size() <= 1 + kMaxDigits &&
                            std::ranges::all_of(rest.substr(1), text::isDigit));
}

}  // namespace

std::optional<boost::asio::ip::address> forwardedAddress(std::string_view entry) {
    entry = text::trimmed(entry);
    if (entry.size() > 1 && entry.starts_with('"') && entry.ends_with('"')) entry = entry.substr(1, entry.size() - 2);
    const bool hasBrackets = entry.starts_with('[');
    if (hasBrackets) {
        const std::size_t bracket = entry.find(']');
        if (bracket == std::string_view::npos || !cutToHost(entry, bracket + 1)) return {};
        entry = entry.substr(1, entry.size() - 2);
    } else if (std::ranges::count(entry, ':') == 1) {
        if (!cutToHost(entry, entry.find(':'))) return {};
    }
    boost::system::error_code fault;
    const auto address = boost::asio::ip::make_address(std::string(entry), fault);
    if (fault || (hasBrackets && !address.is_v6())) return {};
    return address;
}

}  // namespace oval4d::net
