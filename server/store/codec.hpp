#pragma once
// Sessions as bytes, and back.

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "session/session.hpp"

namespace oval4d::store {

/// Bytes that are not a session, or of a later version than this program's.
class Unreadable : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Names, within one session's record, a polytope that has no name of its own in the catalogue.
using KeyOf = std::function<std::string(const session::PolytopePtr&)>;
/// The polytope of such a key; throws Unreadable if there is none.
using PolytopeOf = std::function<session::PolytopePtr(const std::string&)>;

/// What a command changes in any case, a few hundred bytes: the present state and its revision.
std::string encodeHead(const session::Session& session, const KeyOf& keyOf);

/// The whole session, with the last `maxUndo` steps that can be undone and as many that can be redone.
std::string encodeWhole(const session::Session& session, std::size_t maxUndo, const KeyOf& keyOf);

/// The session of `whole`, brought to the state of `head` where that is newer; what lies between them is one step of
/// the history. Throws Unreadable.
session::Session decode(std::string_view whole, std::string_view head, const PolytopeOf& polytopeOf);

std::string encodePolytope(const geometry::Polytope& polytope);

/// Checked as one that is loaded from a file; throws Unreadable.
session::PolytopePtr decodePolytope(std::string_view bytes);

}  // namespace oval4d::store
