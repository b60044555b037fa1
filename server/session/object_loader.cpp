#include "session/object_loader.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "polytopes/construction/convex_hull.hpp"
#include "session/time_steps.hpp"

namespace oval4d::session {

namespace {

// The maximum number of elements of a small object. Transforming a small object takes less than 0.2 ms and 128 KiB.
constexpr std::size_t kSmall = 1000;

const Error kLater{ErrorCode::internal, "the object is not available yet"};

std::size_t totalElementCount(const slicing::Object& object) {
    const auto counts = slicing::elementCounts(object);
    return std::accumulate(counts.begin(), counts.end(), std::size_t{0});
}

}  // namespace

CriticalSearchArguments criticalSearchArguments(const State& state) {
    CriticalSearchArguments arguments{state.object, state.orientation, {}};
    if (slicing::fieldIn(state.object) != nullptr) {
        arguments.settings.levels = state.look.field.levels;
        arguments.settings.inside = state.look.field.inside;
    }
    return arguments;
}

ObjectLoader::ObjectLoader(const Limits& limits, polytopes::PolytopeCache& cache)
    : ObjectLoader(limits, cache, LoadingMode::immediate, readObject) {}

ObjectLoader::ObjectLoader(const Limits& limits, polytopes::PolytopeCache& cache, LoadingMode mode, FileReader reader,
                           CriticalSearchOptions search)
    : limits_(limits), cache_(&cache), mode_(mode), reader_(std::move(reader)), search_(search) {}

Result<slicing::Object> ObjectLoader::build(const polytopes::PolytopeDesign& design) {
    try {
        return slicing::Object(cache_->findOrBuild(design));
    } catch (const polytopes::TooLarge& fault) {
        return Error{ErrorCode::too_large, "the " + design.name + " cannot be built: " + fault.what()};
    } catch (const std::invalid_argument& fault) {
        return Error{ErrorCode::unknown_polytope, fault.what()};
    }
}

Result<slicing::Object> ObjectLoader::polytopeOf(const polytopes::PolytopeDesign& design) {
    if (mode_ == LoadingMode::immediate) return build(design);
    if (built_ && builtName_ == design.name) return *built_;
    if (auto ready = cache_->find(design)) {
        built_ = Result<slicing::Object>(slicing::Object(std::move(ready)));
        builtName_ = design.name;
        return *built_;
    }
    pending_ = design;
    return kLater;
}

Result<ObjectWithWarnings> ObjectLoader::objectFrom(const LoadObject& load) {
    if (fromFile_) return *fromFile_;
    if (auto error = checkLoad(load, limits_)) return *error;
    if (load.format == kFormula) return *(fromFile_ = readFormula(load));  // never deferred, because it is fast
    if (mode_ == LoadingMode::deferred) {
        // A LoadObject for the data folder is copied, because each parsing of a command line makes another one. The
        // copy is small. A LoadObject with data may be large, and is not copied.
        ofDataFolder_ = load.dataName.empty() ? nullptr : std::make_shared<const LoadObject>(load);
        pending_ = ofDataFolder_ ? ofDataFolder_.get() : &load;
        return kLater;
    }
    return *(fromFile_ = reader_(load, limits_));
}

Result<slicing::Object> ObjectLoader::fieldWithTimeSteps(const slicing::Object& field, const slicing::Object& added) {
    if (mode_ == LoadingMode::immediate) return appendTimeSteps(field, added, limits_);
    if (extended_ && extendedFrom_ == field) return *extended_;
    pending_ = TimeStepsToAppend{field, added};
    return kLater;
}

Result<slicing::Object> ObjectLoader::transformedTo(const slicing::Object& source,
                                                    const geometry::ReferenceFrame& frame) {
    if (mode_ == LoadingMode::immediate || frame == geometry::ReferenceFrame{})
        return slicing::transformedTo(source, frame);
    const auto made = std::ranges::find_if(objectsInFrames_, [&](const ObjectInReferenceFrame& each) {
        return each.source == source && each.frame == frame;
    });
    if (made != objectsInFrames_.end()) return made->object;
    ObjectInReferenceFrame wanted{source, frame};
    if (totalElementCount(source) <= kSmall) {
        wanted.object = slicing::transformedTo(source, frame);
        return objectsInFrames_.emplace_back(std::move(wanted)).object;
    }
    pending_ = std::move(wanted);
    return kLater;
}

Result<slicing::CriticalSectionsPtr> ObjectLoader::searchCriticalSections(const CriticalSearchArguments& arguments,
                                                                          std::stop_token stop) {
    const auto& [object, orientation, settings] = arguments;
    if (search_.cache != nullptr) {
        // Another search may have found the critical sections while this search waited for a thread.
        if (auto known = search_.cache->find(object, orientation, settings)) return known;
    }
    auto found = slicing::findCriticalSections(object, orientation, settings, {search_.time, std::move(stop)});
    if (!found) return found.error();
    auto shared = std::make_shared<const slicing::CriticalSections>(std::move(*found));
    if (search_.cache != nullptr) search_.cache->add(object, orientation, settings, shared);
    return slicing::CriticalSectionsPtr(std::move(shared));
}

Result<slicing::CriticalSectionsPtr> ObjectLoader::criticalSections(const State& state) {
    if (critical_ && searched_ == state.object) return *critical_;
    CriticalSearchArguments arguments = criticalSearchArguments(state);
    const bool isField = slicing::fieldIn(state.object) != nullptr;
    if (search_.cache != nullptr) {
        if (auto known = search_.cache->find(arguments.object, arguments.orientation, arguments.settings)) {
            if (mode_ == LoadingMode::immediate) return known;
            critical_ = Result<slicing::CriticalSectionsPtr>(std::move(known));
            searched_ = state.object;
            return *critical_;
        }
    }
    if (mode_ == LoadingMode::immediate || (!isField && totalElementCount(state.object) <= kSmall))
        return searchCriticalSections(arguments, {});
    pending_ = std::move(arguments);
    return kLater;
}

void ObjectLoader::completePending(std::stop_token stop) {
    if (const auto* design = std::get_if<polytopes::PolytopeDesign>(&pending_)) {
        built_ = build(*design);
        builtName_ = design->name;
    } else if (const auto* load = std::get_if<const LoadObject*>(&pending_)) {
        fromFile_ = reader_(**load, limits_);
    } else if (const auto* extension = std::get_if<TimeStepsToAppend>(&pending_)) {
        extended_ = appendTimeSteps(extension->field, extension->added, limits_);
        extendedFrom_ = extension->field;
    } else if (const auto* wanted = std::get_if<ObjectInReferenceFrame>(&pending_)) {
        objectsInFrames_.push_back(
            {wanted->source, wanted->frame, slicing::transformedTo(wanted->source, wanted->frame)});
    } else if (const auto* arguments = std::get_if<CriticalSearchArguments>(&pending_)) {
        critical_ = searchCriticalSections(*arguments, std::move(stop));
        searched_ = arguments->object;
    }
    pending_ = std::monostate{};
}

std::size_t ObjectLoader::estimatedMemory() const {
    constexpr std::size_t kFixed = 64U << 10U;
    // The memory per byte of a text file: for its numbers, a copy of them for repairs, the polytope, and its
    // incidences.
    constexpr std::size_t kPerTextByte = 16;
    // The memory per element of a polytope: for points, incidences, and temporary data while the polytope is built.
    constexpr std::size_t kPerElement = 256;
    if (const auto* load = std::get_if<const LoadObject*>(&pending_)) {
        // The samples are in memory twice: in the message from the process that reads the file, and in the field. A
        // sample of one byte in the file becomes a 32-bit float in both places.
        constexpr std::size_t kCopies = 2, kPerFileByte = kCopies * sizeof(float);
        const std::size_t file = (*load)->file ? (*load)->file->size() : 0;
        return kFixed + kPerTextByte * (*load)->data.size() +
               std::min(kPerFileByte * file, kCopies * limits_.maxFieldBytes);
    }
    if (const auto* extension = std::get_if<TimeStepsToAppend>(&pending_))
        return kFixed + slicing::memoryOf(extension->field) + slicing::memoryOf(extension->added);
    // Counts the memory of the critical values, which is small for a field. Does not count the memory of the search
    // itself, which needs as much as drawing a picture.
    if (const auto* arguments = std::get_if<CriticalSearchArguments>(&pending_))
        return kFixed + sizeof(slicing::CriticalSection) * totalElementCount(arguments->object);
    constexpr std::size_t kPerTransformedElement = 128;
    if (const auto* wanted = std::get_if<ObjectInReferenceFrame>(&pending_))
        return kPerTransformedElement * totalElementCount(wanted->source);
    const auto* design = std::get_if<polytopes::PolytopeDesign>(&pending_);
    if (design == nullptr) return 0;
    const polytopes::ElementCounts counts = polytopes::elementCounts(*design);
    // The memory per point of a convex hull: for simplices, their neighbors, and the perturbed points.
    constexpr std::size_t kPerHullPoint = 10240;
    return kFixed + kPerElement * (counts.vertices + counts.edges + counts.faces + counts.cells) +
           kPerHullPoint * design->recipe->hullPointCount();
}

std::size_t ObjectLoader::loadedObjectMemory() const {
    std::size_t bytes = 0;
    if (fromFile_ && *fromFile_) bytes += unsharedMemory((*fromFile_)->object);
    if (extended_ && *extended_) bytes += unsharedMemory(**extended_);
    return bytes;
}

std::chrono::duration<double> ObjectLoader::estimatedDuration() const {
    // Durations in seconds:
    // - kElement: per element of a polytope that is built;
    // - kByte: per byte of a file that lists the elements of a polytope or the points of a cloud;
    // - kPointByte: per byte of a list of points whose convex hull is computed;
    // - kArrayByte: per byte of an array;
    // - kTransformedElement: per element of an object that is transformed;
    // - kSearch: per search for critical values of w;
    // - kHullPoint: per point of the convex hulls from which a polytope is built.
    constexpr double kElement = 3e-6, kByte = 5e-7, kPointByte = 3e-6, kArrayByte = 5e-9, kTransformedElement = 4e-8,
                     kSearch = 1, kHullPoint = 2e-4;
    double seconds = 2e-4;
    if (const auto* design = std::get_if<polytopes::PolytopeDesign>(&pending_)) {
        const auto [vertices, edges, faces, cells] = polytopes::elementCounts(*design);
        seconds += kElement * static_cast<double>(vertices + edges + faces + cells) +
                   kHullPoint * static_cast<double>(design->recipe->hullPointCount());
    } else if (const auto* load = std::get_if<const LoadObject*>(&pending_)) {
        const LoadObject& file = **load;
        const bool array = file.isArrayInFiles() || isArrayFormat(file.format);
        const double perByte = array ? kArrayByte : buildsHull(file.format) ? kPointByte : kByte;
        seconds += perByte * static_cast<double>(file.data.size() + (file.file ? file.file->size() : 0));
    } else if (const auto* extension = std::get_if<TimeStepsToAppend>(&pending_)) {
        seconds += kArrayByte * static_cast<double>(slicing::memoryOf(extension->field));
    } else if (const auto* wanted = std::get_if<ObjectInReferenceFrame>(&pending_)) {
        seconds += kTransformedElement * static_cast<double>(totalElementCount(wanted->source));
    } else if (isSearchPending()) {
        seconds += kSearch;
    }
    return std::chrono::duration<double>(seconds);
}

std::vector<std::string> ObjectLoader::warnings() const {
    return fromFile_ && *fromFile_ ? (*fromFile_)->warnings : std::vector<std::string>{};
}

}  // namespace oval4d::session
