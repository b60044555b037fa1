#include "store/object_codec.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "fields/array_field.hpp"
#include "fields/formula_field.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/surface_mesh.hpp"
#include "polytopes/polytope.hpp"
#include "store/cbor.hpp"
#include "text/message_text.hpp"

namespace oval4d::store {

namespace {

using nlohmann::json;
using polytopes::Polytope;

constexpr double kMaxCoordinate = 1e15;  // of vertices, points and origins, as an absolute value

json rows(const geometry::JaggedArray& array) {
    json list = json::array();
    for (std::size_t i = 0; i < array.size(); ++i) list.emplace_back(array[i]);
    return list;
}

geometry::JaggedArray arrayIn(const json& value) {
    geometry::JaggedArray array;
    for (const json& row : value) array.add(readIntegers(row));
    return array;
}

json encoded(const std::vector<glm::dvec4>& vertices) {
    json list = json::array();
    for (const glm::dvec4& v : vertices) list.push_back({v.x, v.y, v.z, v.w});
    return list;
}

std::vector<glm::dvec4> verticesIn(const json& value, double most = kMaxCoordinate) {
    std::vector<glm::dvec4> vertices;
    for (const json& v : value)
        vertices.emplace_back(readNumber(v.at(0), most), readNumber(v.at(1), most), readNumber(v.at(2), most),
                              readNumber(v.at(3), most));
    return vertices;
}

// Encodes samples as 32-bit floats in the byte order of x86-64 (little-endian).
json binary(std::span<const float> samples) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(samples.data());
    return json::binary(json::binary_t::container_type(bytes, bytes + samples.size_bytes()));
}

// Decodes the samples of an array, and checks that their number matches `shape`.
fields::FieldArray arrayIn(const json::binary_t& samples, const fields::Box& box, const json& shape) {
    fields::FieldArray array;
    array.box = box;
    array.shape = shape.get<fields::Shape>();
    const std::size_t count = fields::sampleCount(array.shape);
    if (count == 0 || samples.size() != count * sizeof(float)) throwUnreadable("samples of an array are missing");
    std::vector<float> values(count);
    std::memcpy(values.data(), samples.data(), samples.size());
    array.samples = fields::SampleStorage(std::move(values));
    return array;
}

// Encodes the second function of a field: its formula, or [variable, samples] for an array.
json encoded(const fields::SecondFunction& second) {
    if (!second.array) return json(second.formula);
    return json({second.variable, binary(second.array->samples())});
}

// Encodes a quantity as [name, unit].
json encoded(const fields::Quantity& quantity) { return json::array({quantity.name, quantity.unit}); }

std::string readQuantityText(const json& value) {
    auto text = value.get<std::string>();
    if (!fields::isQuantityText(text))
        throwUnreadable("a unit or the name of a quantity is too long or is not printable UTF-8");
    return text;
}

fields::Quantity quantityIn(const json& value) {
    refuseUnknownMembers(value, 2);
    return {readQuantityText(value.at(0)), readQuantityText(value.at(1))};
}

// Returns whether the unit of at least one axis, or the quantity of at least one array, is known.
bool hasQuantities(const fields::Field& field) {
    return field.quantity.isKnown() || (field.second && field.second->quantity.isKnown()) ||
           std::ranges::any_of(field.units, [](const std::string& unit) { return !unit.empty(); });
}

// Reads the second function. If it is an array, its values measure `quantity`.
void readSecond(const json& second, const json& shape, fields::Quantity quantity, fields::Field& field) {
    std::optional<Error> error;
    if (second.is_string()) {
        error = fields::setSecondFormula(field, second.get<std::string>());
        if (error) throwLater("a formula cannot be read: " + error->message);
    } else if (field.array) {
        fields::FieldArray array = arrayIn(second.at(1).get_binary(), field.array->box(), shape);
        array.quantity = std::move(quantity);
        // The name of a variable may be longer than that of an object.
        auto variable = second.at(0).get<std::string>();
        if (!text::isUtf8(variable)) throwUnreadable("the name of a variable is not UTF-8");
        error = fields::setSecondArray(field, array, std::move(variable));
    } else {
        throwUnreadable("a formula has an array");
    }
    if (error) throwUnreadable("a field is not valid: " + error->message);
}

// Encodes a source as [dataName, format, axes, variable, secondFormula, secondVariable, box or null], followed by the
// region if there is one: see fields::FileSource.
json encoded(const fields::FileSource& source) {
    const auto& [dataName, format, axes, variable, secondFormula, secondVariable, box, region] = source;
    json record = json::array({dataName, format, axes, variable, secondFormula, secondVariable,
                               box ? encoded(std::vector{box->min, box->max}) : json()});
    if (region) record.push_back(encoded(std::vector{region->min, region->max}));
    return record;
}

// Reads any box of finite numbers. The functions that make fields from the box check that its bounds are not too large.
fields::Box boxIn(const json& value) {
    const std::vector<glm::dvec4> corners = verticesIn(value, std::numeric_limits<double>::max());
    if (corners.size() != 2) throwUnreadable("a box does not have two corners");
    return {corners[0], corners[1]};
}

slicing::Object openFile(const std::string& name, const json& source, const DataFolderReader& open) {
    constexpr std::size_t kMembers = 8;
    refuseUnknownMembers(source, kMembers);
    session::LoadObject load;
    load.name = name;
    load.dataName = source.at(0).get<std::string>();
    load.format = source.at(1).get<std::string>();
    load.axes = source.at(2).get<std::string>();
    load.variable = source.at(3).get<std::string>();
    load.secondFormula = source.at(4).get<std::string>();
    load.secondVariable = source.at(5).get<std::string>();
    if (!source.at(6).is_null()) load.box = boxIn(source.at(6));
    if (source.size() == kMembers) load.region = boxIn(source.at(7));
    const auto object = open ? open(load) : Error{ErrorCode::not_found, "there is no data folder"};
    if (!object)
        throwUnreadable("its field " + text::inQuotes(load.dataName) + " cannot be read: " + object.error().message);
    return *object;
}

// --- The record of each kind of object
//
// The record of a kind of object is an array that begins with a version and a name. Only the length of the array tells
// the kind. A separate member for the kind is not possible, because earlier versions of the server, which may use the
// same store, would refuse it. The code does not compile if a kind has no RecordCodec, or if records of two kinds have
// the same length.

template <typename ObjectPtr>
struct RecordCodec;

template <>
struct RecordCodec<slicing::PolytopePtr> {
    static constexpr std::array<std::size_t, 1> kLengths{6};

    // [version, name, vertices, 2-faces, cells, the type of each cell]
    static json encode(const Polytope& p) {
        return json({kRecordVersion, p.name, encoded(p.vertices), rows(p.faces), rows(p.cells), p.typeOfCell});
    }

    static slicing::Object decode(const json& value, const glm::dvec4& originInFile, const DataFolderReader& /*open*/) {
        geometry::JaggedArray cells = arrayIn(value.at(4));
        std::vector<std::uint32_t> typeOfCell = readIntegers(value.at(5));
        if (typeOfCell.size() != cells.size()) throwUnreadable("the numbers of cells and of their types differ");
        try {
            Polytope polytope = polytopes::makePolytope(readShortText(value.at(1)), verticesIn(value.at(2)),
                                                        arrayIn(value.at(3)), std::move(cells), std::move(typeOfCell));
            polytope.originInFile = originInFile;
            return std::make_shared<const Polytope>(std::move(polytope));
        } catch (const polytopes::InvalidPolytope& fault) {
            throwUnreadable(std::string("a polytope is not valid: ") + fault.what());
        }
    }
};

template <>
struct RecordCodec<slicing::CloudPtr> {
    static constexpr std::array<std::size_t, 1> kLengths{4};

    // [version, name, points, radii]
    static json encode(const geometry::PointCloud& cloud) {
        return json({kRecordVersion, cloud.name, encoded(cloud.points), cloud.radii});
    }

    static slicing::Object decode(const json& value, const glm::dvec4& originInFile, const DataFolderReader& /*open*/) {
        std::vector<double> radii;
        for (const json& radius : value.at(3)) radii.push_back(readNumber(radius, 0, kMaxCoordinate));
        try {
            geometry::PointCloud cloud =
                geometry::makePointCloud(readShortText(value.at(1)), verticesIn(value.at(2)), std::move(radii));
            cloud.originInFile = originInFile;
            return std::make_shared<const geometry::PointCloud>(std::move(cloud));
        } catch (const std::invalid_argument& fault) {
            throwUnreadable(std::string("a point cloud is not valid: ") + fault.what());
        }
    }
};

template <>
struct RecordCodec<slicing::FieldPtr> {
    static constexpr std::size_t kFileLength = 3, kLength = 5, kLengthWithSecond = 7, kLengthWithQuantities = 9;
    static constexpr std::array kLengths{kFileLength, kLength, kLengthWithSecond, kLengthWithQuantities};

    // The record of a field is one of these arrays:
    // - [version, name, file in the data folder]
    // - [version, name, formula or samples, box, shape]; the shape of a formula is an empty array
    // - these five members, the second function, and the text "field", without which the record would have the length
    //   of a polytope's record
    // - these seven members (null if there is no second function), [units of x, y, z and w, quantity of the values],
    //   and the quantity of the second function (see encoded(const fields::Quantity&)); only for arrays, if a unit or a
    //   quantity is known
    static json encode(const fields::Field& field) {
        if (field.source) return json({kRecordVersion, field.name, encoded(*field.source)});
        const fields::Box& box = field.array ? field.array->box() : field.box;
        json record({kRecordVersion, field.name, field.array ? binary(field.array->samples()) : json(field.formula),
                     encoded(std::vector{box.min, box.max}), field.array ? json(field.array->shape()) : json::array()});
        const bool measures = hasQuantities(field);
        if (field.second || measures) {
            record.push_back(field.second ? encoded(*field.second) : json());
            record.push_back("field");
        }
        if (measures) {
            json units(field.units);
            units.push_back(encoded(field.quantity));
            record.push_back(std::move(units));
            record.push_back(encoded(field.second ? field.second->quantity : fields::Quantity()));
        }
        return record;
    }

    static slicing::Object decode(const json& value, const glm::dvec4& originInFile, const DataFolderReader& open) {
        if (originInFile != glm::dvec4(0)) throwUnreadable("a field cannot be moved");
        const std::string name = readShortText(value.at(1));
        const json& source = value.at(2);
        if (value.size() == kFileLength) return openFile(name, source, open);
        const fields::Box box = boxIn(value.at(3));
        const json& shape = value.at(4);
        const bool measures = value.size() == kLengthWithQuantities, isFormula = source.is_string();
        const bool hasSecond = value.size() == kLengthWithSecond || (measures && !value.at(5).is_null());
        if (isFormula && measures) throwUnreadable("a formula has units");
        fields::FieldArray array;
        fields::Quantity ofSecond;
        if (!isFormula) array = arrayIn(source.get_binary(), box, shape);
        if (measures) {
            const json& units = value.at(7);
            refuseUnknownMembers(units, array.units.size() + 1);
            for (std::size_t axis = 0; axis < array.units.size(); ++axis)
                array.units.at(axis) = readQuantityText(units.at(axis));
            array.quantity = quantityIn(units.at(array.units.size()));
            ofSecond = quantityIn(value.at(8));
        }
        auto field = isFormula ? fields::fieldFromFormula(name, source.get<std::string>(), box,
                                                          hasSecond ? value.at(5).get<std::string>() : std::string())
                               : fields::fieldFromArray(name, array);
        if (!field && isFormula) throwLater("a formula cannot be read: " + field.error().message);
        if (!field) throwUnreadable("a field is not valid: " + field.error().message);
        if (hasSecond && !isFormula) readSecond(value.at(5), shape, std::move(ofSecond), *field);
        return std::make_shared<const fields::Field>(std::move(*field));
    }
};

template <>
struct RecordCodec<slicing::SurfacePtr> {
    static constexpr std::array<std::size_t, 1> kLengths{8};

    // [version, name, vertices, 2-faces, and four times null, without which the record would have the length of a
    // cloud's record]
    static json encode(const geometry::SurfaceMesh& surface) {
        return json({kRecordVersion, surface.name, encoded(surface.vertices), rows(surface.faces), nullptr, nullptr,
                     nullptr, nullptr});
    }

    static slicing::Object decode(const json& value, const glm::dvec4& originInFile, const DataFolderReader& /*open*/) {
        for (std::size_t i = 4; i < value.size(); ++i) {
            if (!value.at(i).is_null()) throwLater("a surface has members that this version does not know");
        }
        try {
            geometry::SurfaceMesh surface =
                geometry::makeSurfaceMesh(readShortText(value.at(1)), verticesIn(value.at(2)), arrayIn(value.at(3)));
            surface.originInFile = originInFile;
            return std::make_shared<const geometry::SurfaceMesh>(std::move(surface));
        } catch (const geometry::InvalidSurface& fault) {
            throwUnreadable(std::string("a surface is not valid: ") + fault.what());
        }
    }
};

// The length of the record of an object that was moved when it was loaded: [version, [origin in the file, record of the
// object]]. See ObjectInfo::originInFile.
constexpr std::size_t kMovedLength = 2;

json encodedWithOrigin(const glm::dvec4& originInFile, json record) {
    if (originInFile == glm::dvec4(0)) return record;
    return json({kRecordVersion, json::array({encoded(std::vector{originInFile}), std::move(record)})});
}

template <typename... Kinds>
consteval bool lengthsDiffer(std::type_identity<std::variant<Kinds...>> /*kinds*/) {
    std::vector<std::size_t> lengths{kMovedLength};
    (lengths.insert(lengths.end(), RecordCodec<Kinds>::kLengths.begin(), RecordCodec<Kinds>::kLengths.end()), ...);
    std::ranges::sort(lengths);
    return std::ranges::adjacent_find(lengths) == lengths.end();
}
static_assert(lengthsDiffer(std::type_identity<slicing::Object>()));

/// Decodes the record of an object of one of these kinds.
template <typename... Kinds>
slicing::Object decodeOneOf(std::type_identity<std::variant<Kinds...>> /*kinds*/, const json& record,
                            const glm::dvec4& originInFile, const DataFolderReader& open) {
    std::optional<slicing::Object> object;
    const auto decodeIfLengthMatches = [&]<typename Kind>(std::type_identity<Kind> /*kind*/) {
        if (std::ranges::find(RecordCodec<Kind>::kLengths, record.size()) != RecordCodec<Kind>::kLengths.end())
            object = RecordCodec<Kind>::decode(record, originInFile, open);
    };
    (decodeIfLengthMatches(std::type_identity<Kinds>()), ...);
    if (!object)
        throwLater("there is no kind of object with a record of " + std::to_string(record.size()) + " members");
    return std::move(*object);
}

}  // namespace

bool refersToFile(std::string_view record) {
    // If an array has fewer than 24 elements, its first byte is 0x80 plus their number (RFC 8949, section 3.1).
    constexpr char kFileRecord = static_cast<char>(0x80 + RecordCodec<slicing::FieldPtr>::kFileLength);
    return record.starts_with(kFileRecord);
}

std::string encodeObjectRecord(const slicing::Object& object) {
    return std::visit(
        []<typename Kind>(const Kind& data) {
            return encodeCbor(encodedWithOrigin(slicing::infoOf(data).originInFile, RecordCodec<Kind>::encode(*data)));
        },
        object);
}

slicing::Object decodeObjectRecord(std::string_view bytes, const DataFolderReader& open) {
    return callTranslatingErrors([&] {
        const json value = parseRecord(bytes);
        constexpr std::type_identity<slicing::Object> kKinds;
        if (value.size() != kMovedLength) return decodeOneOf(kKinds, value, glm::dvec4(0), open);
        const std::vector<glm::dvec4> origins = verticesIn(value.at(1).at(0));
        if (origins.size() != 1) throwUnreadable("an object does not have one origin");
        return decodeOneOf(kKinds, value.at(1).at(1), origins.front(), open);
    });
}

}  // namespace oval4d::store
