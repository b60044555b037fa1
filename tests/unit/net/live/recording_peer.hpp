#pragma once
// A client for tests of sessions. It records the messages that it receives.

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "net/live/peer.hpp"

namespace oval4d::net {

/// Records the messages that a session sends to a client. Each message counts as written to the socket at once. Must be
/// used only on the thread that runs the session's handlers.
class RecordingPeer final : public Peer {
  public:
    explicit RecordingPeer(ClientAccountPtr client) : client_(std::move(client)) {}

    void send(OutgoingMessage message, std::function<void()> written) override {
        const auto& parsed = messages_.emplace_back(nlohmann::json::parse(message.bytes.view()));
        if (written) written();
        if (parsed.at("type") == "slices" && whenPictureArrives) whenPictureArrives(revisionOf(parsed));
    }
    const ClientAccountPtr& client() const override { return client_; }
    void watchForDisconnect() override {}
    void close(std::uint16_t code, std::string /*reason*/) override { closeCode = code; }

    /// Returns the recorded messages of this type, in the order of their arrival.
    std::vector<nlohmann::json> messages(const std::string& type) const {
        std::vector<nlohmann::json> found;
        for (const nlohmann::json& each : messages_) {
            if (each.at("type") == type) found.push_back(each);
        }
        return found;
    }
    /// Returns the revisions of the pictures (`slices` messages), in the order of their arrival.
    std::vector<std::uint64_t> pictures() const {
        std::vector<std::uint64_t> revisions;
        for (const nlohmann::json& each : messages("slices")) revisions.push_back(revisionOf(each));
        return revisions;
    }
    /// Returns one value for each picture of this revision: whether it is a draft.
    std::vector<bool> drafts(std::uint64_t revision) const {
        std::vector<bool> found;
        for (const nlohmann::json& each : messages("slices")) {
            if (revisionOf(each) == revision) found.push_back(each.contains("draft"));
        }
        return found;
    }

    std::function<void(std::uint64_t revision)> whenPictureArrives;  ///< called for each picture; may be empty
    std::uint16_t closeCode = 0;                                     ///< 0 until the session closes the connection

  private:
    static std::uint64_t revisionOf(const nlohmann::json& message) {
        return message.at("revision").get<std::uint64_t>();
    }

    const ClientAccountPtr client_;
    std::vector<nlohmann::json> messages_;
};

}  // namespace oval4d::net
