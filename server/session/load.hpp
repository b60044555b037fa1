#pragma once
// Bringing polytopes of the user's own into a session.

#include "session/workshop.hpp"

namespace oval4d::session {

/// Reads the polytope that `load` holds. Errors: `unsupported_format`, `bad_polytope` (with the line), `too_large`.
protocol::Result<Reading> readPolytope(const protocol::Load& load, const Limits& limits);

/// The polytope in a file's text, whose format it tells by itself.
protocol::Result<Reading> readPolytope(const std::string& text, const std::string& name, const Limits& limits);

}  // namespace oval4d::session
