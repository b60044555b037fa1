#include "net/http/reply.hpp"

#include "wire/messages.hpp"

namespace oval4d::net {

namespace {

constexpr const char* kJson = "application/json";

unsigned statusFor(ErrorCode code) {
    switch (code) {
        case ErrorCode::not_found:
            return 404;
        case ErrorCode::bad_token:
            return 401;
        case ErrorCode::too_large:
            return 413;
        case ErrorCode::too_many:
        case ErrorCode::later_version:
            return 503;
        case ErrorCode::internal:
            return 500;
        default:
            return 400;
    }
}

}  // namespace

HttpReply noCacheReply(std::string type, SharedBytes body, unsigned status) {
    return {status, std::move(type), std::move(body), {{"Cache-Control", "no-cache"}, {"Accept-Ranges", "none"}}};
}

HttpReply noCacheTextReply(std::string type, std::string body, unsigned status) {
    return noCacheReply(std::move(type), SharedBytes(std::move(body)), status);
}

HttpReply jsonReply(std::string message) { return noCacheTextReply(kJson, std::move(message)); }

HttpReply errorReply(const Error& error, unsigned status) {
    return noCacheTextReply(kJson, wire::errorMessage(error, {}), status != 0 ? status : statusFor(error.code));
}

HttpReply refusalReply(unsigned status, std::string text) {
    return {status, "text/plain; charset=utf-8", SharedBytes(std::move(text)), {}};
}

HttpReply refusalReply(const HttpError& fault) {
    HttpReply reply = refusalReply(fault.status, fault.reason + "\n");
    if (fault.status == kUpgradeRequired) reply.headers = {{"Upgrade", "websocket"}, {"Sec-WebSocket-Version", "13"}};
    return reply;
}

HttpReply tooManyRequestsReply(std::string text) {
    HttpReply reply = refusalReply(429, std::move(text));
    reply.headers.emplace_back("Retry-After", "10");
    return reply;
}

}  // namespace oval4d::net
