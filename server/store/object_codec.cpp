#include "store/object_codec.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include <nlohmann/json.hpp>

#include "fields/field_definition.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/surface_mesh.hpp"
#include "polytopes/polytope.hpp"
#include "session/load.hpp"
#include "store/cbor.hpp"
#include "store/member_codec.hpp"
#include "store/object_record_v1.hpp"
#include "text/message_text.hpp"

// The record of an object is a CBOR array with four elements: [version, kind, isFile, members]. `kind` is the number of
// the kind of object (see ObjectKindCodec). `isFile` is true if the members name a file in the data folder instead of
// containing samples. The members are those that visitStoredMembers() visits: members of the object or, for a field, of
// its definition. Records of version 1 are converted before they are read (see object_record_v1.cpp).

namespace oval4d::store {

namespace {

using nlohmann::json;
using polytopes::Polytope;

constexpr int kObjectRecordVersion = 2;
constexpr std::size_t kObjectRecordMembers = 4;

/// Returns whether the record of this object names a file instead of containing samples.
bool hasFileSource(const fields::FieldDefinition& field) { return field.source.has_value(); }
bool hasFileSource(const geometry::ObjectInfo& /*object*/) { return false; }

slicing::Object loadFromDataFolder(const std::string& name, const fields::FieldFileSource& source,
                                   const DataFolderReader& open) {
    const auto object =
        open ? open(session::loadCommandFor(name, source)) : Error{ErrorCode::not_found, "there is no data folder"};
    if (!object)
        throwUnreadableRecord("its field " + text::inQuotes(source.dataName) +
                              " cannot be read: " + object.error().message);
    return *object;
}

// --- The kinds of objects
//
// ObjectKindCodec has a specialization for each kind of objects. `kNumber` is the number of the kind in records, and
// must not change. `Stored` is the struct whose members are stored. toStored() returns this struct for an object, and
// makeObject() makes an object from the struct. The compiler reports a kind without a specialization, and kinds with
// the same number.

template <typename ObjectPtr>
struct ObjectKindCodec;

template <>
struct ObjectKindCodec<slicing::PolytopePtr> {
    static constexpr unsigned kNumber = 0;
    using Stored = Polytope;

    static const Stored& toStored(const Polytope& polytope) { return polytope; }

    static slicing::Object makeObject(Stored stored, const DataFolderReader& /*open*/) {
        checkShortText(stored.name);
        if (stored.typeOfCell.size() != stored.cells.size())
            throwUnreadableRecord("the numbers of cells and of their types differ");
        try {
            Polytope polytope =
                polytopes::makePolytope(std::move(stored.name), std::move(stored.vertices), std::move(stored.faces),
                                        std::move(stored.cells), std::move(stored.typeOfCell));
            polytope.originInFile = stored.originInFile;
            return std::make_shared<const Polytope>(std::move(polytope));
        } catch (const polytopes::InvalidPolytope& fault) {
            throwUnreadableRecord(std::string("a polytope is not valid: ") + fault.what());
        }
    }
};

template <>
struct ObjectKindCodec<slicing::CloudPtr> {
    static constexpr unsigned kNumber = 1;
    using Stored = geometry::PointCloud;

    static const Stored& toStored(const geometry::PointCloud& cloud) { return cloud; }

    static slicing::Object makeObject(Stored stored, const DataFolderReader& /*open*/) {
        checkShortText(stored.name);
        try {
            geometry::PointCloud cloud =
                geometry::makePointCloud(std::move(stored.name), std::move(stored.points), std::move(stored.radii));
            cloud.originInFile = stored.originInFile;
            return std::make_shared<const geometry::PointCloud>(std::move(cloud));
        } catch (const std::invalid_argument& fault) {
            throwUnreadableRecord(std::string("a point cloud is not valid: ") + fault.what());
        }
    }
};

template <>
struct ObjectKindCodec<slicing::FieldPtr> {
    static constexpr unsigned kNumber = 2;
    using Stored = fields::FieldDefinition;

    static Stored toStored(const fields::Field& field) { return fields::definitionOf(field); }

    static slicing::Object makeObject(Stored stored, const DataFolderReader& open) {
        const auto& [info, source, formula, box, array, second] = stored;
        checkShortText(info.name);
        if (info.originInFile != glm::dvec4(0)) throwUnreadableRecord("a field cannot be moved");
        if (source) {
            if (!formula.empty() || array || second) throwUnreadableRecord("a field in a file has other functions");
            return loadFromDataFolder(info.name, *source, open);
        }
        auto field = fields::fieldFromDefinition(stored);
        // Errors other than `bad_field` concern a formula or its box. A later version may accept what this version
        // refuses.
        if (!field && field.error().code != ErrorCode::bad_field)
            throwLaterRecord("a formula cannot be read: " + field.error().message);
        if (!field) throwUnreadableRecord("a field is not valid: " + field.error().message);
        return std::make_shared<const fields::Field>(std::move(*field));
    }
};

template <>
struct ObjectKindCodec<slicing::SurfacePtr> {
    static constexpr unsigned kNumber = 3;
    using Stored = geometry::SurfaceMesh;

    static const Stored& toStored(const geometry::SurfaceMesh& surface) { return surface; }

    static slicing::Object makeObject(Stored stored, const DataFolderReader& /*open*/) {
        checkShortText(stored.name);
        if (stored.cells.size() != 0 || !stored.typeOfCell.empty()) throwUnreadableRecord("a surface has cells");
        try {
            geometry::SurfaceMesh surface =
                geometry::makeSurfaceMesh(std::move(stored.name), std::move(stored.vertices), std::move(stored.faces));
            surface.originInFile = stored.originInFile;
            return std::make_shared<const geometry::SurfaceMesh>(std::move(surface));
        } catch (const geometry::InvalidSurface& fault) {
            throwUnreadableRecord(std::string("a surface is not valid: ") + fault.what());
        }
    }
};

// Returns whether the numbers of the kinds differ from each other and are less than 24. In CBOR, such a number is one
// byte, as refersToFile() requires.
template <typename... Kinds>
consteval bool numbersAreDifferentAndSmall(std::type_identity<std::variant<Kinds...>> /*kinds*/) {
    std::array<unsigned, sizeof...(Kinds)> numbers{ObjectKindCodec<Kinds>::kNumber...};
    std::ranges::sort(numbers);
    return std::ranges::adjacent_find(numbers) == numbers.end() && numbers.back() < 24;
}
static_assert(numbersAreDifferentAndSmall(std::type_identity<slicing::Object>()));

/// Decodes the record, in version 2, of an object whose kind is one of `Kinds`.
template <typename... Kinds>
slicing::Object decodeOneOf(std::type_identity<std::variant<Kinds...>> /*kinds*/, const json& record,
                            const DataFolderReader& open) {
    refuseUnknownMembers(record, kObjectRecordMembers);
    const auto number = readInteger<unsigned>(record.at(1));
    std::optional<slicing::Object> object;
    const auto decodeIfKindMatches = [&]<typename Kind>(std::type_identity<Kind> /*kind*/) {
        if (number != ObjectKindCodec<Kind>::kNumber) return;
        typename ObjectKindCodec<Kind>::Stored stored{};
        MemberReader reader(record.at(3));
        visitStoredMembers(stored, reader);
        reader.refuseUnreadMembers();
        if (record.at(2).get<bool>() != hasFileSource(stored))
            throwUnreadableRecord("it is not clear whether an object is in a file");
        object = ObjectKindCodec<Kind>::makeObject(std::move(stored), open);
    };
    (decodeIfKindMatches(std::type_identity<Kinds>()), ...);
    if (!object) throwLaterRecord("there is no kind of object with the number " + std::to_string(number));
    return std::move(*object);
}

}  // namespace

bool refersToFile(std::string_view record) {
    // Compare the first bytes of the record. In CBOR, an array with n < 24 elements begins with the byte 0x80 + n. A
    // number below 24 is one byte, and true is the byte 0xf5 (RFC 8949, section 3). A record of version 1 refers to a
    // file if it has three elements, so that it begins with 0x83.
    constexpr std::size_t kPlaceOfFlag = 3;
    if (record.starts_with('\x83')) return true;
    return record.size() > kPlaceOfFlag && record[0] == '\x84' && record[1] == kObjectRecordVersion &&
           record[kPlaceOfFlag] == '\xf5';
}

std::string encodeObjectRecord(const slicing::Object& object) {
    return std::visit(
        []<typename Kind>(const Kind& data) {
            const auto& stored = ObjectKindCodec<Kind>::toStored(*data);
            MemberWriter writer;
            visitStoredMembers(stored, writer);
            return encodeCbor(json::array(
                {kObjectRecordVersion, ObjectKindCodec<Kind>::kNumber, hasFileSource(stored), writer.takeArray()}));
        },
        object);
}

slicing::Object decodeObjectRecord(std::string_view bytes, const DataFolderReader& open) {
    return callTranslatingErrors([&] {
        json record = parseRecord(bytes, kObjectRecordVersion);
        if (record.at(0) != kObjectRecordVersion) record = convertedFromVersion1(std::move(record));
        return decodeOneOf(std::type_identity<slicing::Object>(), record, open);
    });
}

}  // namespace oval4d::store
