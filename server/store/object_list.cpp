#include "store/object_list.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <variant>

#include "fields/field.hpp"
#include "polytopes/catalogue/catalogue.hpp"
#include "polytopes/polytope.hpp"
#include "store/cbor.hpp"
#include "text/message_text.hpp"

namespace oval4d::store {

using nlohmann::json;

namespace {

// Returns the memory, in bytes, that slicing::transformedTo() needs for a copy of `source`. A transformed field has its
// own domain, but shares the functions of `source` and the samples of their arrays.
std::size_t memoryOfTransformed(const slicing::Object& source) {
    const fields::Field* const field = slicing::fieldIn(source);
    return field == nullptr ? slicing::memoryOf(source) : sizeof *field + polytopes::memoryOf(*field->domain);
}

}  // namespace

std::size_t ObjectListEncoder::findOrAddObject(const slicing::Object& object) {
    const auto [found, isNew] = indices_.try_emplace(slicing::identityOf(object), list_.size());
    if (isNew) {
        const geometry::ObjectInfo& info = slicing::infoOf(object);
        json entry = json::array({info.name});
        if (!info.rebuildableFromName) entry.push_back(keyOf_(object));
        list_.push_back(std::move(entry));
    }
    return found->second;
}

ObjectListDecoder::ObjectListDecoder(const json& list, const ObjectLookup& objectOf, polytopes::PolytopeCache& cache,
                                     std::size_t maxVertices)
    : vertexBudget_(maxVertices) {
    for (const json& entry : list) {
        refuseUnknownMembers(entry, 2);
        if (entry.size() == 1) {
            objects_.push_back(buildNamedPolytope(readShortText(entry.at(0)), cache));
        } else if (auto object = objectOf(readShortText(entry.at(1)))) {
            objects_.push_back(std::move(*object));
        } else {
            throwUnreadableRecord("an object is missing");
        }
    }
}

const slicing::Object& ObjectListDecoder::at(const json& index) const {
    const auto i = readInteger<std::size_t>(index);
    if (i >= objects_.size()) throwUnreadableRecord("an object is missing");
    return objects_[i];
}

slicing::Object ObjectListDecoder::transformedTo(const slicing::Object& source, const geometry::ReferenceFrame& frame) {
    if (frame == geometry::ReferenceFrame{}) return source;
    const auto known = std::ranges::find_if(
        transformed_, [&](const TransformedObject& image) { return image.source == source && image.frame == frame; });
    if (known != transformed_.end()) return known->image;
    // The limit on vertices must also limit the memory of transformed objects, because an object may have few vertices
    // but many 2-faces. So a transformed object counts as at least one vertex per kBytesOfVertex bytes, the typical
    // memory of a vertex with its share of the other elements. Samples of an array do not count, because all
    // transformed objects share them.
    constexpr std::size_t kBytesOfVertex = 100;
    const std::size_t vertices =
        std::max(slicing::elementCounts(source)[0], memoryOfTransformed(source) / kBytesOfVertex);
    if (vertices > vertexBudget_) throwLaterRecord("its objects have too many vertices");
    vertexBudget_ -= vertices;
    transformed_.push_back({source, frame, slicing::transformedTo(source, frame)});
    return transformed_.back().image;
}

/// Returns the polytope with this name (see polytopes::designNamed()), and subtracts its number of vertices from
/// `vertexBudget_`. Throws NewerVersionRecord if no polytope has this name, or if it has more vertices than
/// `vertexBudget_`. Throws UnreadableRecord if the polytope cannot be built.
slicing::Object ObjectListDecoder::buildNamedPolytope(const std::string& name, polytopes::PolytopeCache& cache) {
    constexpr std::size_t kMaxVertices = 1'000'000;  // for one polytope; the limit for clients is far lower
    const auto named = polytopes::designNamed(name, kMaxVertices);
    const auto* design = std::get_if<polytopes::PolytopeDesign>(&named);
    if (design == nullptr) throwLaterRecord("the catalogue has no polytope called " + text::inQuotes(name));
    const std::size_t vertices = polytopes::elementCounts(*design).vertices;
    if (vertices > vertexBudget_) throwLaterRecord("its polytopes have too many vertices");
    vertexBudget_ -= vertices;
    try {
        return cache.findOrBuild(*design);
    } catch (const std::invalid_argument& fault) {
        throwUnreadableRecord("a polytope cannot be built: " + std::string(fault.what()));
    }
}

}  // namespace oval4d::store
