#include "slicing/object_bytes.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "geometry/point_cloud.hpp"
#include "polytopes/polytope.hpp"
#include "slicing/visitor.hpp"

namespace oval4d::slicing {

namespace {

using geometry::JaggedArray;
using polytopes::Polytope;
using serialization::ByteReader;
using serialization::ByteWriter;

// Reading and writing share this code, so that they always agree. The structured binding does not compile if a member
// is added to JaggedArray but not here.
template <typename Archive, typename Array>
void visitArray(Archive& archive, Array& array) {
    auto& [begin, items] = array;
    archive(begin), archive(items);
}

template <typename Archive, typename P>
void visitPolytope(Archive& archive, P& p) {
    archive(p.name), archive(p.serial), archive(p.circumradius), archive(p.convex), archive(p.convexFaces);
    archive(p.rebuildableFromName);
    archive(p.vertices), archive(p.edges);
    for (auto* array : {&p.faces, &p.faceEdges, &p.edgeFaces, &p.cells}) visitArray(archive, *array);
    archive(p.cellSigns), archive(p.faceCells), archive(p.typeOfCell);
}

template <typename Archive, typename Cloud>
void visitCloud(Archive& archive, Cloud& cloud) {
    archive(cloud.name), archive(cloud.serial), archive(cloud.circumradius);
    archive(cloud.points), archive(cloud.radii);
}

enum class Kind : std::uint8_t { polytope, cloud };

void requirePolytope(Kind kind) {
    if (kind != Kind::polytope) throw std::runtime_error("an unknown kind of object");
}

/// Reads a jagged array and checks that all its rows lie within `items`.
JaggedArray arrayFrom(ByteReader& archive) {
    JaggedArray array;
    visitArray(archive, array);
    if (array.begin.empty() || array.begin.front() != 0 || array.begin.back() != array.items.size() ||
        !std::ranges::is_sorted(array.begin))
        throw std::runtime_error("an inconsistent jagged array");
    return array;
}

}  // namespace

void encodeObject(const Object& object, std::string& out) {
    out.clear();
    ByteWriter archive(out);
    std::visit(Visitor{[&](const PolytopePtr& p) {
                           archive(Kind::polytope), visitPolytope(archive, *p);
                           archive(p->cellTypes.size());
                           for (const auto& [name, cells] : p->cellTypes) archive(name), archive(cells);
                       },
                       [&](const CloudPtr& cloud) { archive(Kind::cloud), visitCloud(archive, *cloud); }},
               object);
}

Object decodeObject(std::string_view bytes) {
    ByteReader archive(bytes);
    Kind kind{};
    archive(kind);
    if (kind == Kind::cloud) {
        auto cloud = std::make_shared<geometry::PointCloud>();
        visitCloud(archive, *cloud);
        return CloudPtr(std::move(cloud));
    }
    requirePolytope(kind);
    auto p = std::make_shared<Polytope>();
    visitPolytope(archive, *p);
    std::size_t types = 0;
    for (archive(types); p->cellTypes.size() < types;) {
        auto& [name, cells] = p->cellTypes.emplace_back();
        archive(name), archive(cells);
    }
    return PolytopePtr(std::move(p));
}

void writeParts(const Object& object, ByteWriter& archive) {
    std::visit(
        Visitor{[&](const PolytopePtr& p) {
                    archive(Kind::polytope), archive(p->vertices);
                    visitArray(archive, p->faces), visitArray(archive, p->cells), archive(p->typeOfCell);
                },
                [&](const CloudPtr& cloud) { archive(Kind::cloud), archive(cloud->points), archive(cloud->radii); }},
        object);
}

Object readParts(ByteReader& archive, const std::string& name, std::size_t maxVertices) {
    Kind kind{};
    archive(kind);
    std::vector<glm::dvec4> vertices;
    archive(vertices);
    if (vertices.size() > maxVertices) throw std::runtime_error("too many vertices");
    if (kind == Kind::cloud) {
        std::vector<double> radii;
        archive(radii);
        try {
            return std::make_shared<const geometry::PointCloud>(
                geometry::makePointCloud(name, std::move(vertices), std::move(radii)));
        } catch (const std::invalid_argument& invalid) {
            throw std::runtime_error("an invalid point cloud: " + std::string(invalid.what()));
        }
    }
    requirePolytope(kind);
    JaggedArray faces = arrayFrom(archive), cells = arrayFrom(archive);
    std::vector<std::uint32_t> typeOfCell;
    archive(typeOfCell);
    if (typeOfCell.size() != cells.size()) throw std::runtime_error("cell types that do not match the cells");
    try {
        // Rejects indices that are out of range, and cells that are not closed surfaces.
        return std::make_shared<const Polytope>(polytopes::makePolytope(name, std::move(vertices), std::move(faces),
                                                                        std::move(cells), std::move(typeOfCell)));
    } catch (const std::invalid_argument& invalid) {
        throw std::runtime_error("an invalid polytope: " + std::string(invalid.what()));
    }
}

}  // namespace oval4d::slicing
