#include "net/live/errors.hpp"

#include <spdlog/spdlog.h>

#include "fields/field.hpp"
#include "slicing/object.hpp"
#include "slicing/slice_edges.hpp"
#include "wire/messages.hpp"

namespace oval4d::net {

void sendError(Peer& peer, Metrics& metrics, const Error& error, std::optional<double> id) {
    metrics.countError(error.code);
    peer.send(textMessage(wire::errorMessage(error, id)));
}

Error logAndClassifyFailure(const session::State& state, const std::string& sessionId, std::uint64_t revision,
                            const std::exception& why, const Error& otherwise) {
    const fields::Field* const field = slicing::fieldIn(state.object);
    if (field != nullptr && field->hasLostSamples()) {
        spdlog::warn("picture, file or command not completed session={} revision={} reason=\"{}\"", sessionId, revision,
                     why.what());
        return {ErrorCode::bad_field,
                "the file of this field has been changed or shortened, or cannot be read any more; load it again"};
    }
    if (dynamic_cast<const slicing::TooManySliceEdges*>(&why) != nullptr) return {ErrorCode::too_large, why.what()};
    spdlog::error("picture, file or command failed session={} revision={} fault=\"{}\"", sessionId, revision,
                  why.what());
    return otherwise;
}

}  // namespace oval4d::net
