#include "net/http/request_validation.hpp"

#include <algorithm>
#include <boost/beast/core/string.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <charconv>
#include <limits>
#include <system_error>

#include "net/http/access_control.hpp"
#include "text/ascii.hpp"

namespace oval4d::net {

namespace beast = boost::beast;
namespace http = beast::http;
using http::field;

namespace {

/// Returns whether the key is 16 bytes in base64: 22 digits and two padding characters. The last digit encodes only two
/// bits, so only four digits are possible there (kLast).
bool isWebSocketKey(std::string_view key) {
    constexpr std::size_t kLength = 24, kDigits = 22;
    constexpr std::string_view kLast = "AQgw";
    const auto isBase64 = [](char c) { return text::isDigit(c) || text::isLetter(c) || c == '+' || c == '/'; };
    return key.size() == kLength && std::all_of(key.begin(), key.begin() + kDigits, isBase64) &&
           kLast.find(key[kDigits - 1]) != std::string_view::npos && key.ends_with("==");
}

bool isControl(char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7F; }

std::string_view toStringView(beast::string_view view) { return {view.data(), view.size()}; }

}  // namespace

std::optional<HttpError> validateHeader(const HttpRequest& request, RequestBodyRule body) {
    constexpr unsigned kBad = 400, kExpectationFailed = 417;
    for (const field once : {field::host, field::origin, field::content_length, field::transfer_encoding,
                             field::sec_websocket_key, field::sec_websocket_version, field::authorization}) {
        if (request.count(once) > 1)
            return HttpError{
                kBad, "the header field " + std::string(http::to_string(once)) + " is repeated; it may occur once"};
    }
    for (const auto& each : request) {
        if (std::ranges::any_of(toStringView(each.value()), isControl))
            return HttpError{kBad, "a header field value contains a control character; only tabs are allowed"};
    }
    if (request.version() >= 11 && request.count(field::host) == 0)
        return HttpError{kBad, "an HTTP/1.1 request must have a Host header field"};
    if (const auto host = request.find(field::host);
        host != request.end() && !host->value().empty() && !parseAuthority(toStringView(host->value()))) {
        return HttpError{kBad, "the Host header field must be a host name with an optional port"};
    }
    if (const auto coding = request.find(field::transfer_encoding); coding != request.end()) {
        if (request.version() < 11) return HttpError{kBad, "Transfer-Encoding is not allowed in HTTP/1.0"};
        if (!beast::iequals(coding->value(), "chunked"))
            return HttpError{kBad, "the only supported Transfer-Encoding is chunked"};
        return body == RequestBodyRule::none
                   ? HttpError{413, "request bodies are not accepted"}
                   : HttpError{411, "the length of the body must be given as Content-Length, not in chunks"};
    }
    if (const auto length = request.find(field::content_length); length != request.end()) {
        const std::string_view digits = toStringView(length->value());
        if (digits.empty() || !std::ranges::all_of(digits, text::isDigit))
            return HttpError{kBad, "Content-Length must be a decimal number"};
        if (body == RequestBodyRule::none && digits.find_first_not_of('0') != std::string_view::npos)
            return HttpError{413, "request bodies are not accepted"};
    } else if (body == RequestBodyRule::required) {
        return HttpError{411, "an upload must have a Content-Length"};
    }
    if (const auto expected = request.find(field::expect);
        expected != request.end() && !beast::iequals(expected->value(), "100-continue")) {
        return HttpError{kExpectationFailed, "the only supported Expect value is 100-continue"};
    }
    return {};
}

std::size_t bodyLength(const HttpRequest& request) {
    const auto field = request.find(http::field::content_length);
    if (field == request.end()) return 0;
    const std::string_view digits = toStringView(field->value());
    std::size_t length = 0;
    const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), length);
    return fault == std::errc::result_out_of_range ? std::numeric_limits<std::size_t>::max() : length;
}

bool isWebSocketUpgrade(const HttpRequest& request) {
    const auto lists = [&request](std::string_view name, beast::string_view token) {
        return http::token_list(combinedFieldValue(request, name)).exists(token);
    };
    return request.version() >= 11 && request.method() == http::verb::get && lists("Connection", "upgrade") &&
           lists("Upgrade", "websocket");
}

std::optional<HttpError> validateHandshake(const HttpRequest& request) {
    constexpr unsigned kBad = 400;
    if (const auto version = request.find(field::sec_websocket_version);
        version == request.end() || version->value() != "13") {
        return HttpError{kUpgradeRequired, "the only supported WebSocket version is 13"};
    }
    if (!isWebSocketKey(toStringView(request[field::sec_websocket_key])))
        return HttpError{kBad, "Sec-WebSocket-Key must be 16 bytes in base64"};
    return {};
}

std::string combinedFieldValue(const HttpRequest& request, std::string_view name) {
    std::string list;
    for (const auto& each : request) {
        if (!beast::iequals(each.name_string(), {name.data(), name.size()})) continue;
        if (!list.empty()) list += ", ";
        list += toStringView(each.value());
    }
    return list;
}

}  // namespace oval4d::net
