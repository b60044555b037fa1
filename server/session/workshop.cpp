#include "session/workshop.hpp"

#include <stdexcept>
#include <utility>

#include "geometry/catalogue.hpp"
#include "session/load.hpp"

namespace oval4d::session {

namespace {

using protocol::Error;
using protocol::ErrorCode;
using protocol::Result;

const Error kLater{ErrorCode::internal, "this is still being made"};

Result<PolytopePtr> builtFrom(const geometry::Design& design) {
    try {
        return geometry::polytopeOf(design);
    } catch (const std::invalid_argument& fault) {
        return Error{ErrorCode::unknown_polytope, fault.what()};
    }
}

}  // namespace

Result<PolytopePtr> Workshop::polytope(const geometry::Design& design) {
    if (pace_ == Pace::at_once) return builtFrom(design);
    if (polytope_ && built_ == design.name) return *polytope_;
    if (auto ready = geometry::polytopeIfBuilt(design)) return ready;
    order_ = design;
    return kLater;
}

Result<Reading> Workshop::reading(const protocol::Load& load) {
    if (!reading_ && pace_ == Pace::later) {
        order_ = &load;
        return kLater;
    }
    if (!reading_) reading_ = readPolytope(load, limits_);
    return *reading_;
}

void Workshop::work() {
    if (const auto* design = std::get_if<geometry::Design>(&order_)) {
        polytope_ = builtFrom(*design);
        built_ = design->name;
    } else if (const auto* load = std::get_if<const protocol::Load*>(&order_)) {
        reading_ = readPolytope(**load, limits_);
    }
    order_ = std::monostate{};
}

std::vector<std::string> Workshop::warnings() const {
    return reading_ && *reading_ ? (*reading_)->warnings : std::vector<std::string>{};
}

}  // namespace oval4d::session
