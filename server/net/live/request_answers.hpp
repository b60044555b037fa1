#pragma once
// Answers the questions of clients. Questions do not change the session.

#include <boost/asio/awaitable.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "errors/error.hpp"
#include "export/export_request.hpp"
#include "net/live/message.hpp"
#include "net/live/metered_session.hpp"
#include "net/live/object_loading.hpp"
#include "net/live/peer.hpp"
#include "net/live/session_publisher.hpp"
#include "net/live/snapshot.hpp"
#include "net/services.hpp"
#include "pipeline/pipeline.hpp"
#include "session/session.hpp"
#include "slicing/critical/critical_sections.hpp"
#include "wire/request.hpp"

namespace oval4d::net {

/// Answers questions about what a session shows, and about how busy the server is. Answers that take long are made on
/// workers. Every function runs on the session's strand.
class RequestAnswerer : public std::enable_shared_from_this<RequestAnswerer> {
  public:
    using RequestId = std::optional<double>;  ///< empty if a request has no id

    /// `sessionId` is for the log. `strand`, `publisher` and `loading` belong to the session `metered`.
    RequestAnswerer(Services services, SessionPublisher::Strand strand, std::string sessionId,
                    std::shared_ptr<MeteredSession> metered, std::shared_ptr<SessionPublisher> publisher,
                    std::shared_ptr<ObjectLoading> loading);

    /// Answers a request `get`, and returns when the answer is sent. A request for critical values of w is an
    /// exception: the function returns at once, and the answer follows later. Does nothing if the publisher does not
    /// know the client.
    boost::asio::awaitable<void> answerGet(std::shared_ptr<Peer> peer, wire::Get get, RequestId id);
    void answer(Peer& peer, const wire::Measure& measure, RequestId id);
    void answer(Peer& peer, const wire::Ping& ping, RequestId id);

  private:
    boost::asio::awaitable<void> answerWithPicture(std::shared_ptr<Peer> peer, PictureStreamKey key, RequestId id,
                                                   std::optional<glm::dvec2> point = {});
    boost::asio::awaitable<void> answerWithSample(std::shared_ptr<Peer> peer, glm::dvec4 point, RequestId id);
    std::function<OutgoingMessage(pipeline::Pipeline&)> sampleJob(const glm::dvec4& point, RequestId id) const;
    boost::asio::awaitable<void> answerWithState(std::shared_ptr<Peer> peer, scene::ColorScheme scheme, RequestId id);
    void answerWithViewLink(Peer& peer, RequestId id);
    boost::asio::awaitable<void> answerWithFile(std::shared_ptr<Peer> peer, exports::ExportRequest request,
                                                RequestId id);
    boost::asio::awaitable<void> answerWithCriticalValues(std::shared_ptr<Peer> peer, RequestId id);
    boost::asio::awaitable<Result<slicing::CriticalSectionsPtr>> findCriticalValues(std::shared_ptr<Peer> peer);
    std::function<OutgoingMessage(pipeline::Pipeline&)> requestedPictureJob(const PictureStreamKey& key, RequestId id,
                                                                            std::optional<glm::dvec2> point) const;

    std::uint64_t revision() const { return session_.revision; }

    const Services services_;
    const SessionPublisher::Strand strand_;
    const std::string sessionId_;
    const std::shared_ptr<MeteredSession> metered_;
    const session::Session& session_;  // the value of metered_
    const std::shared_ptr<SessionPublisher> publisher_;
    const std::shared_ptr<ObjectLoading> loading_;
};

}  // namespace oval4d::net
