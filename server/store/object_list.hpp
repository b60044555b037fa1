#pragma once
// Writes and reads the list of objects in a session record. The states in the record contain indices into this list
// instead of objects.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "geometry/reference_frame.hpp"
#include "polytopes/catalogue/polytope_cache.hpp"
#include "slicing/object.hpp"
#include "store/session_codec.hpp"

namespace oval4d::store {

/// A collector of the objects of a session, in a list without duplicates.
class ObjectListEncoder {
  public:
    explicit ObjectListEncoder(const ObjectKeyLookup& keyOf) : keyOf_(keyOf) {}

    /// Returns the index of an object in the list, from 0. Adds the object if it is not in the list.
    std::size_t findOrAddObject(const slicing::Object& object);

    /// Returns the encoded list. An object that can be built from its name has the entry [name], any other object the
    /// entry [name, key].
    const nlohmann::json& encodedList() const { return list_; }

  private:
    const ObjectKeyLookup& keyOf_;
    nlohmann::json list_ = nlohmann::json::array();
    std::map<const void*, std::size_t> indices_;
};

/// The objects of a session that is being decoded: the objects in the list of its record, and these objects transformed
/// to the frames of reference of the session's states.
class ObjectListDecoder {
  public:
    static constexpr std::size_t kMaxTotalVertices = 10'000'000;

    /// Reads a list that ObjectListEncoder::encodedList() has returned. `objectOf` returns the objects that have a key,
    /// and `cache` builds those that have only a name. Throws UnreadableRecord if an object is missing or cannot be
    /// built. Throws NewerVersionRecord if the catalogue lacks a name, or if the objects built from their names have
    /// more than `maxVertices` vertices in total.
    ObjectListDecoder(const nlohmann::json& list, const ObjectLookup& objectOf, polytopes::PolytopeCache& cache,
                      std::size_t maxVertices = kMaxTotalVertices);

    /// Returns the object with this index. The reference is valid as long as this decoder exists. Throws
    /// UnreadableRecord if there is no such object.
    const slicing::Object& at(const nlohmann::json& index) const;

    /// Returns `source` in the coordinates of the frame of reference `frame` (see slicing::transformedTo()). Calls with
    /// equal arguments return the same object, so that states share it. Throws NewerVersionRecord if the transformed
    /// objects and the objects built from their names would have too many vertices in total (`maxVertices` of the
    /// constructor). Checks this before it transforms the object.
    slicing::Object transformedTo(const slicing::Object& source, const geometry::ReferenceFrame& frame);

  private:
    struct TransformedObject {
        slicing::Object source;
        geometry::ReferenceFrame frame;
        slicing::Object image;
    };
    slicing::Object buildNamedPolytope(const std::string& name, polytopes::PolytopeCache& cache);

    // How many vertices the objects that are still to be built or transformed may have in total. The limit exists
    // because a few bytes of a record can request large objects.
    std::size_t vertexBudget_;
    std::vector<slicing::Object> objects_;
    std::vector<TransformedObject> transformed_;
};

}  // namespace oval4d::store
