#include "net/jobs/parse_long_message_job.hpp"

#include <string>

namespace oval4d::net {

Error messageTooLongError(const ServerOptions& options) {
    return {ErrorCode::too_large, "a message may have at most " + std::to_string(options.maxRequestBytes) +
                                      " bytes; only a load message may be longer, up to " +
                                      std::to_string(options.maxLoadMessageBytes)};
}

std::function<MessageParseResult(std::size_t worker)> parseLongMessageJob(std::string_view text,
                                                                          const ServerOptions& options) {
    return [text, &options](std::size_t /*worker*/) -> MessageParseResult {
        const auto seen = wire::peekRequest(text);
        if (!seen.type || *seen.type != "load") return wire::BadRequest{seen.id, messageTooLongError(options)};
        return wire::parseRequest(text, options.maxDepth);
    };
}

}  // namespace oval4d::net
