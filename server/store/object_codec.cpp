#include "store/object_codec.hpp"

#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "fields/array_field.hpp"
#include "fields/formula_field.hpp"
#include "geometry/point_cloud.hpp"
#include "polytopes/polytope.hpp"
#include "slicing/visitor.hpp"
#include "store/cbor.hpp"
#include "text/message_text.hpp"

namespace oval4d::store {

namespace {

using nlohmann::json;
using polytopes::Polytope;

constexpr double kMaxCoordinate = 1e15;

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

std::vector<glm::dvec4> verticesIn(const json& value) {
    std::vector<glm::dvec4> vertices;
    for (const json& v : value)
        vertices.emplace_back(readNumber(v.at(0), kMaxCoordinate), readNumber(v.at(1), kMaxCoordinate),
                              readNumber(v.at(2), kMaxCoordinate), readNumber(v.at(3), kMaxCoordinate));
    return vertices;
}

// Decodes [version, name, vertices, 2-faces, cells, the type of each cell].
slicing::Object polytopeIn(const json& value, const glm::dvec4& originInFile) {
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

// Decodes [version, name, points, radii].
slicing::Object cloudIn(const json& value, const glm::dvec4& originInFile) {
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

// Encodes samples as 32-bit floats in the byte order of x86-64.
json binary(std::span<const float> samples) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(samples.data());
    return json::binary(json::binary_t::container_type(bytes, bytes + samples.size_bytes()));
}

// Decodes the samples of an array.
fields::ReadField arrayIn(const json::binary_t& samples, const fields::Box& box, const json& shape) {
    fields::ReadField array;
    array.box = box;
    array.shape = shape.get<fields::Shape>();
    const std::size_t count = fields::sampleCount(array.shape);
    if (count == 0 || samples.size() != count * sizeof(float)) throwUnreadable("samples of an array are missing");
    std::vector<float> values(count);
    std::memcpy(values.data(), samples.data(), samples.size());
    array.samples = fields::Samples(std::move(values));
    return array;
}

// Encodes a second function: its formula, or its variable and samples.
json encoded(const fields::SecondFunction& second) {
    if (!second.array) return json(second.formula);
    return json({second.variable, binary(second.array->samples())});
}

void readSecond(const json& second, const json& shape, fields::Field& field) {
    std::optional<Error> error;
    if (second.is_string()) {
        error = fields::setSecondFormula(field, second.get<std::string>());
    } else if (field.array) {
        const fields::ReadField array = arrayIn(second.at(1).get_binary(), field.array->box(), shape);
        error = fields::setSecondArray(field, array, readShortText(second.at(0)));
    } else {
        throwUnreadable("a formula has an array");
    }
    if (error) throwUnreadable("a field is not valid: " + error->message);
}

// Decodes [version, name, formula or samples, box, shape, second function, "field"]; the shape of a formula is empty.
// The last two are absent if there is no second function.
slicing::Object fieldIn(const json& value) {
    const std::vector<glm::dvec4> box = verticesIn(value.at(3));
    if (box.size() != 2) throwUnreadable("a box does not have two corners");
    const std::string name = readShortText(value.at(1));
    const json &source = value.at(2), &shape = value.at(4);
    const bool hasSecond = value.size() > 5, isFormula = source.is_string();
    auto field = isFormula ? fields::fieldFromFormula(name, source.get<std::string>(), {box[0], box[1]},
                                                      hasSecond ? value.at(5).get<std::string>() : std::string())
                           : fields::fieldFromArray(name, arrayIn(source.get_binary(), {box[0], box[1]}, shape));
    if (!field) throwUnreadable("a field is not valid: " + field.error().message);
    if (hasSecond && !isFormula) readSecond(value.at(5), shape, *field);
    return std::make_shared<const fields::Field>(std::move(*field));
}

// A record of a file in the data folder is an array of this many members, as its first byte says; see RFC 8949.
constexpr std::size_t kFileMembers = 3;
constexpr char kFileRecord = static_cast<char>(0x80 + kFileMembers);

// Encodes [version, name, [path, format, axes, variable, formula and variable of the values, box or null]].
json encoded(const std::string& name, const fields::FileSource& source) {
    const auto& [path, format, axes, variable, values, valuesVariable, box] = source;
    return json({kRecordVersion, name,
                 json::array({path, format, axes, variable, values, valuesVariable,
                              box ? encoded({box->min, box->max}) : json()})});
}

slicing::Object fileIn(const json& value, const FileOpener& open) {
    const json& source = value.at(2);
    session::LoadObject load;
    load.name = readShortText(value.at(1));
    load.path = source.at(0).get<std::string>();
    load.format = source.at(1).get<std::string>();
    load.axes = source.at(2).get<std::string>();
    load.variable = source.at(3).get<std::string>();
    load.values = source.at(4).get<std::string>();
    load.valuesVariable = source.at(5).get<std::string>();
    if (!source.at(6).is_null()) {
        const std::vector<glm::dvec4> box = verticesIn(source.at(6));
        if (box.size() != 2) throwUnreadable("a box does not have two corners");
        load.box = fields::Box{box[0], box[1]};
    }
    const auto object = open ? open(load) : Error{ErrorCode::not_found, "there is no data folder"};
    if (!object)
        throwUnreadable("its field " + text::inQuotes(load.path) + " cannot be read: " + object.error().message);
    return *object;
}

// A record of an object that was moved when it was loaded has this many members: [version, [origin in the file, the
// record of the object]]. Records of all other objects have more.
constexpr std::size_t kMovedMembers = 2;
constexpr std::size_t kCloudMembers = 4, kPolytopeMembers = 6;

json encodedWithOrigin(const glm::dvec4& originInFile, json record) {
    if (originInFile == glm::dvec4(0)) return record;
    return json({kRecordVersion, json::array({encoded(std::vector{originInFile}), std::move(record)})});
}

}  // namespace

bool namesFile(std::string_view record) { return record.starts_with(kFileRecord); }

std::string encodeObjectRecord(const slicing::Object& object) {
    const slicing::Visitor encode{
        [](const slicing::PolytopePtr& p) {
            return encodedWithOrigin(p->originInFile, json({kRecordVersion, p->name, encoded(p->vertices),
                                                            rows(p->faces), rows(p->cells), p->typeOfCell}));
        },
        [](const slicing::CloudPtr& cloud) {
            return encodedWithOrigin(cloud->originInFile,
                                     json({kRecordVersion, cloud->name, encoded(cloud->points), cloud->radii}));
        },
        [](const slicing::FieldPtr& field) {
            if (field->source) return encoded(field->name, *field->source);
            const fields::Box& box = field->array ? field->array->box() : field->box;
            json record({kRecordVersion, field->name,
                         field->array ? binary(field->array->samples()) : json(field->formula),
                         encoded({box.min, box.max}), field->array ? json(field->array->shape()) : json::array()});
            if (field->second) {
                record.push_back(encoded(*field->second));
                record.push_back("field");
            }
            return record;
        }};
    return encodeCbor(std::visit(encode, object));
}

slicing::Object decodeObjectRecord(std::string_view bytes, const FileOpener& open) {
    return translatingErrors([&] {
        json value = parseRecord(bytes);
        glm::dvec4 originInFile(0);
        if (value.size() == kMovedMembers) {
            const std::vector<glm::dvec4> origins = verticesIn(value.at(1).at(0));
            if (origins.size() != 1) throwUnreadable("an object does not have one origin");
            originInFile = origins.front();
            value = json(value.at(1).at(1));
            if (value.size() != kCloudMembers && value.size() != kPolytopeMembers)
                throwUnreadable("an object with an origin is neither a polytope nor a point cloud");
        }
        if (value.size() == kFileMembers) return fileIn(value, open);
        const bool isField = value.size() == 5 || value.size() == 7;
        return value.size() == kCloudMembers ? cloudIn(value, originInFile)
               : isField                     ? fieldIn(value)
                                             : polytopeIn(value, originInFile);
    });
}

}  // namespace oval4d::store
