#pragma once
// What is to be had over HTTP.

#include <boost/asio/awaitable.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "export/wish.hpp"
#include "net/hub.hpp"
#include "net/peer.hpp"
#include "net/readiness.hpp"
#include "net/services.hpp"
#include "net/target.hpp"
#include "net/web_files.hpp"

namespace oval4d::net {

/// An answer, in HTTP's terms but without HTTP's library.
struct Reply {
    unsigned status = 200;
    std::string type;
    Bytes body;
    std::vector<std::pair<std::string, std::string>> headers;
};

/// `{"type":"error", …}` with the HTTP status that fits the code, or the given one.
Reply errorReply(const protocol::Error& error, unsigned status = 0);

class Routes {
  public:
    Routes(Services services, const WebFiles& files, const Readiness& readiness, const Hub& hub)
        : services_(services), files_(files), readiness_(readiness), hub_(hub) {}

    struct Inquiry {
        std::string method;
        Target target;
        std::string ifNoneMatch, acceptEncoding;
    };
    boost::asio::awaitable<Reply> answer(Inquiry inquiry);

  private:
    boost::asio::awaitable<Reply> frame(session::Query query);
    boost::asio::awaitable<Reply> file(session::Query query, exports::Format format);
    Reply readiness() const;
    Reply metrics();

    const Services services_;
    const WebFiles& files_;
    const Readiness& readiness_;
    const Hub& hub_;
};

}  // namespace oval4d::net
