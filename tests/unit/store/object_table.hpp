#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "slicing/object.hpp"
#include "store/object_codec.hpp"
#include "store/session_codec.hpp"

namespace oval4d::store {

/// A table of encoded objects, which provides the functions that encode and decode sessions.
class ObjectTable {
  public:
    ObjectKeyLookup keyOf = [this](const slicing::Object& object) {
        const auto [found, isNew] =
            keys_.try_emplace(slicing::infoOf(object).serial, "key" + std::to_string(keys_.size()));
        if (isNew) bytes_[found->second] = encodeObjectRecord(object);
        return found->second;
    };
    ObjectLookup objectOf = [this](const std::string& key) {
        auto& object = built_[key];
        if (!object && bytes_.contains(key)) object = decodeObjectRecord(bytes_[key]);
        return object;
    };
    std::size_t size() const { return bytes_.size(); }

  private:
    std::map<std::uint64_t, std::string> keys_;
    std::map<std::string, std::string> bytes_;
    std::map<std::string, std::optional<slicing::Object>> built_;
};

}  // namespace oval4d::store
