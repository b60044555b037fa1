#include "session/object_loader.hpp"

#include <stdexcept>
#include <utility>

namespace oval4d::session {

namespace {

const Error kLater{ErrorCode::internal, "the object is not available yet"};

}  // namespace

ObjectLoader::ObjectLoader(const Limits& limits, polytopes::PolytopeCache& cache)
    : ObjectLoader(limits, cache, Mode::immediate, readObject) {}

ObjectLoader::ObjectLoader(const Limits& limits, polytopes::PolytopeCache& cache, Mode mode, FileReader reader)
    : limits_(limits), cache_(cache), mode_(mode), reader_(std::move(reader)) {}

Result<slicing::Object> ObjectLoader::build(const polytopes::Design& design) {
    try {
        return slicing::Object(cache_.get(design));
    } catch (const std::invalid_argument& fault) {
        return Error{ErrorCode::unknown_polytope, fault.what()};
    }
}

Result<slicing::Object> ObjectLoader::polytopeOf(const polytopes::Design& design) {
    if (mode_ == Mode::immediate) return build(design);
    if (built_ && builtName_ == design.name) return *built_;
    if (auto ready = cache_.find(design)) return slicing::Object(std::move(ready));
    pending_ = design;
    return kLater;
}

Result<LoadedObject> ObjectLoader::objectFrom(const Load& load) {
    if (fromFile_) return *fromFile_;
    if (auto error = checkLoad(load, limits_)) return *error;
    if (mode_ == Mode::deferred) {
        pending_ = &load;
        return kLater;
    }
    return *(fromFile_ = reader_(load.format, load.data, load.name, limits_));
}

void ObjectLoader::loadPendingObject() {
    if (const auto* design = std::get_if<polytopes::Design>(&pending_)) {
        built_ = build(*design);
        builtName_ = design->name;
    } else if (const auto* load = std::get_if<const Load*>(&pending_)) {
        const Load& file = **load;
        fromFile_ = reader_(file.format, file.data, file.name, limits_);
    }
    pending_ = std::monostate{};
}

std::size_t ObjectLoader::bytesNeeded() const {
    constexpr std::size_t kFixed = 64U << 10U;
    constexpr std::size_t kPerTextByte = 16;  // the numbers, a copy of them for repairs, the polytope, its incidences
    constexpr std::size_t kPerElement = 256;  // points, incidences, and temporary data of the construction
    if (const auto* load = std::get_if<const Load*>(&pending_)) return kFixed + kPerTextByte * (*load)->data.size();
    const auto* design = std::get_if<polytopes::Design>(&pending_);
    if (design == nullptr) return 0;
    const polytopes::ElementCounts counts = polytopes::elementCounts(*design);
    return kFixed + kPerElement * (counts.vertices + counts.edges + counts.faces + counts.cells);
}

std::chrono::duration<double> ObjectLoader::estimatedDuration() const {
    // Seconds for each element of a polytope that is built, for each byte of a file that lists elements or the points
    // of a cloud, and for each byte of a list of points whose convex hull is computed.
    constexpr double kElement = 3e-6, kByte = 5e-7, kPointByte = 3e-6;
    double seconds = 2e-4;
    if (const auto* design = std::get_if<polytopes::Design>(&pending_)) {
        const auto [vertices, edges, faces, cells] = polytopes::elementCounts(*design);
        seconds += kElement * static_cast<double>(vertices + edges + faces + cells);
    } else if (const auto* load = std::get_if<const Load*>(&pending_)) {
        seconds += (buildsHull((*load)->format) ? kPointByte : kByte) * static_cast<double>((*load)->data.size());
    }
    return std::chrono::duration<double>(seconds);
}

std::vector<std::string> ObjectLoader::warnings() const {
    return fromFile_ && *fromFile_ ? (*fromFile_)->warnings : std::vector<std::string>{};
}

}  // namespace oval4d::session
