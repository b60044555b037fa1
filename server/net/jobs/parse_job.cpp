#include "net/jobs/parse_job.hpp"

#include <string>

namespace oval4d::net {

Error tooLong(const Options& options) {
    return {ErrorCode::too_large, "a message may have at most " + std::to_string(options.maxRequestBytes) +
                                      " bytes; only a load message may be longer, up to " +
                                      std::to_string(options.maxMessage)};
}

std::function<Parsed(std::size_t worker)> parseJob(std::string_view text, const Options& options) {
    return [text, &options](std::size_t /*worker*/) -> Parsed {
        const auto seen = wire::peekRequest(text);
        if (!seen.type || *seen.type != "load") return wire::BadRequest{seen.id, tooLong(options)};
        return wire::parseRequest(text, options.maxDepth);
    };
}

}  // namespace oval4d::net
