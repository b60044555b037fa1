// Fuzzes messages to the server, one per line. Each message must be refused with a reason or executed on a session. An
// error must not change the session. After a success, the session must be valid, and its state must survive encoding
// and decoding.

#include "support.hpp"

using namespace oval4d;
using fuzz::require;

namespace {

/// Returns the id that the answer to this message must have. Finds it by parsing the text independently.
std::optional<double> idIn(std::string_view text) {
    const auto message = nlohmann::json::parse(text, nullptr, false);
    if (!message.is_object() || !message.contains("id") || !message["id"].is_number()) return {};
    return message["id"].get<double>();
}

void requireEcho(std::string_view text, std::optional<double> id, const Error* error) {
    const auto asked = idIn(text);
    if (asked) require(id == asked, "an id is echoed");
    if (!id) return;
    require(std::isfinite(*id), "an id is finite");
    const auto answer =
        fuzz::requireJson(error ? wire::errorMessage(*error, id) : wire::answerMessage(wire::Done{1}, id));
    require(answer.at("id").get<double>() == *id, "an id travels whole");
}

}  // namespace

OVAL4D_FUZZER(request) {
    std::string_view rest = fuzz::textOf(data, size);
    session::Session session;
    for (int messages = 0; !rest.empty() && messages < 12; ++messages) {
        const std::string_view text = fuzz::takeUntil(rest, '\n');
        const auto parsed = wire::parseRequest(text);
        if (const auto* bad = std::get_if<wire::BadRequest>(&parsed)) {
            fuzz::requireSentence(bad->error);
            if (!bad->notJson) requireEcho(text, bad->id, &bad->error);
            require(!bad->notJson || bad->error.code == ErrorCode::bad_json, "what is no JSON is bad_json");
            continue;
        }
        const auto& request = std::get<wire::Request>(parsed);
        require(nlohmann::json::accept(text), "what is carried out was JSON");
        requireEcho(text, request.id, nullptr);
        if (const auto* command = std::get_if<session::Command>(&request.body)) {
            fuzz::execute(session, *command);
            if (session.current.turning || session.current.playing) session::advanceMotionBy(session, 0.01);
        }
    }
    fuzz::requireHistory(session);
    fuzz::requireSound(session, fuzz::kLimits);
    fuzz::requireRoundTrip(session.current, session.loaded);
    return 0;
}
