#pragma once
// Making a file on a worker.

#include <functional>
#include <optional>

#include "net/peer.hpp"
#include "net/services.hpp"
#include "picture/file.hpp"

namespace oval4d::net {

/// Empty only until the job is done.
using MadeFile = std::optional<protocol::Result<Bytes>>;

std::function<MadeFile(picture::Painter&)> fileJob(Services services, const session::State& state,
                                                   const exports::Wish& wish);

}  // namespace oval4d::net
