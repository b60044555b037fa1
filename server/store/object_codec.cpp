#include "store/object_codec.hpp"

#include <memory>
#include <utility>
#include <vector>

#include "geometry/point_cloud.hpp"
#include "polytopes/polytope.hpp"
#include "slicing/visitor.hpp"
#include "store/cbor.hpp"

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
slicing::Object polytopeIn(const json& value) {
    geometry::JaggedArray cells = arrayIn(value.at(4));
    std::vector<std::uint32_t> typeOfCell = readIntegers(value.at(5));
    if (typeOfCell.size() != cells.size()) throwUnreadable("the numbers of cells and of their types differ");
    try {
        return std::make_shared<const Polytope>(polytopes::makePolytope(readName(value.at(1)), verticesIn(value.at(2)),
                                                                        arrayIn(value.at(3)), std::move(cells),
                                                                        std::move(typeOfCell)));
    } catch (const polytopes::InvalidPolytope& fault) {
        throwUnreadable(std::string("a polytope is not valid: ") + fault.what());
    }
}

// Decodes [version, name, points, radii].
slicing::Object cloudIn(const json& value) {
    std::vector<double> radii;
    for (const json& radius : value.at(3)) radii.push_back(readNumber(radius, 0, kMaxCoordinate));
    try {
        return std::make_shared<const geometry::PointCloud>(
            geometry::makePointCloud(readName(value.at(1)), verticesIn(value.at(2)), std::move(radii)));
    } catch (const std::invalid_argument& fault) {
        throwUnreadable(std::string("a point cloud is not valid: ") + fault.what());
    }
}

}  // namespace

std::string encodeObjectRecord(const slicing::Object& object) {
    const slicing::Visitor encode{
        [](const slicing::PolytopePtr& p) {
            return json({kRecordVersion, p->name, encoded(p->vertices), rows(p->faces), rows(p->cells), p->typeOfCell});
        },
        [](const slicing::CloudPtr& cloud) {
            return json({kRecordVersion, cloud->name, encoded(cloud->points), cloud->radii});
        }};
    return encodeCbor(std::visit(encode, object));
}

slicing::Object decodeObjectRecord(std::string_view bytes) {
    return translatingErrors([&] {
        const json value = parseRecord(bytes);
        return value.size() == 4 ? cloudIn(value) : polytopeIn(value);
    });
}

}  // namespace oval4d::store
