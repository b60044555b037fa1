#include "slicing/object_bytes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>

#include "fields/array_field.hpp"
#include "fields/formula_field.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/surface_mesh.hpp"
#include "polytopes/polytope.hpp"
#include "slicing/overloaded.hpp"

namespace oval4d::slicing {

namespace {

using geometry::JaggedArray;
using polytopes::Polytope;
using serialization::ByteReader;
using serialization::ByteWriter;

// Reading and writing share this code, so that both use the same format. The structured binding does not compile if a
// member is added to JaggedArray but not here.
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
    archive(cloud.points), archive(cloud.radii), archive(cloud.originInFile);
}

template <typename Archive, typename Surface>
void visitSurface(Archive& archive, Surface& surface) {
    archive(surface.name), archive(surface.serial), archive(surface.circumradius), archive(surface.convexFaces);
    archive(surface.originInFile), archive(surface.vertices), archive(surface.edges);
    for (auto* array : {&surface.faces, &surface.faceEdges}) visitArray(archive, *array);
}

// Writes samples inline or, if they are in a file and exceed the limit for inline samples (see writeObjectContent()),
// the index of their file and their place in this file.
class SampleWriter {
  public:
    SampleWriter(ByteWriter& archive, MappedFiles& files, std::size_t maxInMemory)
        : archive_(archive), files_(files), maxInMemory_(maxInMemory) {}

    void write(const fields::SampleStorage& samples) {
        const std::size_t count = samples.values().size();
        const bool inFile = samples.file() && count > maxInMemory_;
        archive_(inFile);
        if (!inFile) {
            maxInMemory_ -= std::min(maxInMemory_, count);
            archive_(samples.values());
            return;
        }
        auto found = std::ranges::find(files_, samples.file());
        if (found == files_.end()) found = files_.insert(found, samples.file());
        archive_(static_cast<std::size_t>(found - files_.begin())), archive_(samples.byteOffsetInFile()),
            archive_(count);
    }

  private:
    ByteWriter& archive_;
    MappedFiles& files_;
    std::size_t maxInMemory_;  // how many more samples may be written inline although they are in a file
};

void writeField(const fields::Field& field, ByteWriter& archive, MappedFiles& files, std::size_t maxInMemory) {
    SampleWriter writer(archive, files, maxInMemory);
    archive(field.formula), archive(field.array ? field.array->box() : field.box);
    if (field.array) {
        archive(field.array->shape());
        writer.write(field.array->storage());
        for (const std::string& unit : field.units) archive(unit);
        archive(field.quantity), archive(field.isPart);
        archive(field.imageLevel.level), archive(field.imageLevel.levels);
    }
    const fields::SecondFunction* const second = field.second.get();
    archive(second == nullptr ? std::string() : second->formula);
    archive(second == nullptr ? std::string() : second->variable);
    const bool hasArray = second != nullptr && second->array != nullptr;
    archive(hasArray);
    if (hasArray) {
        writer.write(second->array->storage());
        archive(second->quantity);
    }
}

// Reads the samples of an array whose shape is already set. Throws std::runtime_error if samples are missing.
void readSamples(ByteReader& archive, const MappedFiles& files, fields::FieldArray& array) {
    bool inFile = false;
    archive(inFile);
    if (inFile) {
        std::size_t number = 0, offset = 0, count = 0;
        archive(number), archive(offset), archive(count);
        if (number >= files.size() || !files[number] || count != fields::sampleCount(array.shape))
            throw std::runtime_error("samples are missing");
        try {
            array.samples = fields::SampleStorage(files[number], offset, count);
        } catch (const std::invalid_argument& invalid) {
            throw std::runtime_error(invalid.what());
        }
        return;
    }
    std::vector<float> samples;
    archive(samples);
    if (samples.size() != fields::sampleCount(array.shape)) throw std::runtime_error("samples are missing");
    array.samples = fields::SampleStorage(std::move(samples));
}

// Reads the name of a quantity or a unit. Throws std::runtime_error if fields::quantityText() would change it.
void readQuantityText(ByteReader& archive, std::string& text) {
    archive(text);
    if (!fields::isQuantityText(text))
        throw std::runtime_error("a unit or the name of a quantity is too long or not printable");
}

void readQuantity(ByteReader& archive, fields::Quantity& quantity) {
    readQuantityText(archive, quantity.name);
    readQuantityText(archive, quantity.unit);
}

// Throws std::runtime_error if the field is invalid.
fields::Field readField(const std::string& name, ByteReader& archive, const MappedFiles& files) {
    const auto require = [](const std::optional<Error>& error) {
        if (error) throw std::runtime_error("an invalid field: " + error->message);
    };
    std::string formula, second, variable;
    fields::FieldArray array;
    bool hasArray = false;
    archive(formula), archive(array.box);
    if (formula.empty()) {
        archive(array.shape), readSamples(archive, files, array);
        for (std::string& unit : array.units) readQuantityText(archive, unit);
        readQuantity(archive, array.quantity);
        archive(array.isPart);
        auto& [level, levels] = array.imageLevel;
        archive(level), archive(levels);
        if (level >= std::max(levels, 1U)) throw std::runtime_error("a level that an image does not have");
    }
    archive(second), archive(variable), archive(hasArray);
    auto field = formula.empty() ? fields::fieldFromArray(name, array)
                                 : fields::fieldFromFormula(name, formula, array.box, second);
    if (!field) require(field.error());
    if (formula.empty() && !second.empty()) require(fields::setSecondFormula(*field, second));
    if (hasArray) {
        if (!formula.empty()) throw std::runtime_error("a formula with an array");
        readSamples(archive, files, array);
        readQuantity(archive, array.quantity);
        require(fields::setSecondArray(*field, array, variable));
    }
    return std::move(*field);
}

// The kind of an object is written as the index of its alternative in Object.
void writeKind(const Object& object, ByteWriter& archive) { archive(static_cast<std::uint8_t>(object.index())); }

// Reads the kind of an object. Returns a null pointer to an object of this kind. Callers visit it to choose the
// function that reads the rest, so that the code does not compile if a kind has no function. Throws std::runtime_error
// if the kind is unknown.
template <typename... Kinds>
Object readKind(ByteReader& archive, std::type_identity<std::variant<Kinds...>> /*kinds*/) {
    const std::array<Object, sizeof...(Kinds)> ofEachKind{Kinds()...};
    std::uint8_t kind = 0;
    archive(kind);
    if (kind >= ofEachKind.size()) throw std::runtime_error("an unknown kind of object");
    return ofEachKind.at(kind);
}

/// Reads a jagged array. Throws std::runtime_error unless each of its rows lies within `items`.
JaggedArray arrayFrom(ByteReader& archive) {
    JaggedArray array;
    visitArray(archive, array);
    if (array.begin.empty() || array.begin.front() != 0 || array.begin.back() != array.items.size() ||
        !std::ranges::is_sorted(array.begin))
        throw std::runtime_error("an inconsistent jagged array");
    return array;
}

}  // namespace

void encodeObject(const Object& object, std::string& out, MappedFiles& files) {
    out.clear();
    files.clear();
    ByteWriter archive(out);
    writeKind(object, archive);
    std::visit(Overloaded{[&](const PolytopePtr& p) {
                              visitPolytope(archive, *p);
                              archive(p->cellTypes.size());
                              for (const auto& [name, cells] : p->cellTypes) archive(name), archive(cells);
                              archive(p->originInFile);
                          },
                          [&](const CloudPtr& cloud) { visitCloud(archive, *cloud); },
                          [&](const FieldPtr& field) {
                              writeField(*field, archive, files, 0);
                              archive(field->name), archive(field->serial);
                          },
                          [&](const SurfacePtr& surface) { visitSurface(archive, *surface); }},
               object);
}

Object decodeObject(std::string_view bytes, const MappedFiles& files) {
    ByteReader archive(bytes);
    return std::visit(Overloaded{[&](const PolytopePtr& /*null*/) -> Object {
                                     auto p = std::make_shared<Polytope>();
                                     visitPolytope(archive, *p);
                                     std::size_t types = 0;
                                     for (archive(types); p->cellTypes.size() < types;) {
                                         auto& [name, cells] = p->cellTypes.emplace_back();
                                         archive(name), archive(cells);
                                     }
                                     archive(p->originInFile);
                                     return PolytopePtr(std::move(p));
                                 },
                                 [&](const CloudPtr& /*null*/) -> Object {
                                     auto cloud = std::make_shared<geometry::PointCloud>();
                                     visitCloud(archive, *cloud);
                                     return CloudPtr(std::move(cloud));
                                 },
                                 [&](const FieldPtr& /*null*/) -> Object {
                                     auto field = std::make_shared<fields::Field>(readField("", archive, files));
                                     archive(field->name), archive(field->serial);
                                     return FieldPtr(std::move(field));
                                 },
                                 [&](const SurfacePtr& /*null*/) -> Object {
                                     auto surface = std::make_shared<geometry::SurfaceMesh>();
                                     visitSurface(archive, *surface);
                                     return SurfacePtr(std::move(surface));
                                 }},
                      readKind(archive, std::type_identity<Object>()));
}

void writeObjectContent(const Object& object, ByteWriter& archive, MappedFiles& files, std::size_t maxInMemory) {
    writeKind(object, archive);
    std::visit(Overloaded{[&](const PolytopePtr& p) {
                              archive(p->vertices), archive(p->originInFile);
                              visitArray(archive, p->faces), visitArray(archive, p->cells), archive(p->typeOfCell);
                          },
                          [&](const CloudPtr& cloud) {
                              archive(cloud->points), archive(cloud->originInFile), archive(cloud->radii);
                          },
                          [&](const FieldPtr& field) { writeField(*field, archive, files, maxInMemory); },
                          [&](const SurfacePtr& surface) {
                              archive(surface->vertices), archive(surface->originInFile);
                              visitArray(archive, surface->faces);
                          }},
               object);
}

Object readObjectContent(ByteReader& archive, const std::string& name, std::size_t maxVertices,
                         const MappedFiles& files) {
    std::vector<glm::dvec4> vertices;
    glm::dvec4 originInFile(0);
    const auto readVerticesAndOrigin = [&] {
        archive(vertices);
        if (vertices.size() > maxVertices) throw std::runtime_error("too many vertices");
        archive(originInFile);
        if (!std::isfinite(glm::length(originInFile))) throw std::runtime_error("an origin that is not finite");
    };
    const auto readPolytope = [&](const PolytopePtr& /*null*/) -> Object {
        readVerticesAndOrigin();
        JaggedArray faces = arrayFrom(archive), cells = arrayFrom(archive);
        std::vector<std::uint32_t> typeOfCell;
        archive(typeOfCell);
        if (typeOfCell.size() != cells.size()) throw std::runtime_error("cell types that do not match the cells");
        try {
            // makePolytope() rejects indices that are out of range, and cells that are not closed surfaces.
            Polytope polytope = polytopes::makePolytope(name, std::move(vertices), std::move(faces), std::move(cells),
                                                        std::move(typeOfCell));
            polytope.originInFile = originInFile;
            return std::make_shared<const Polytope>(std::move(polytope));
        } catch (const std::invalid_argument& invalid) {
            throw std::runtime_error("an invalid polytope: " + std::string(invalid.what()));
        }
    };
    const auto readCloud = [&](const CloudPtr& /*null*/) -> Object {
        readVerticesAndOrigin();
        std::vector<double> radii;
        archive(radii);
        try {
            geometry::PointCloud cloud = geometry::makePointCloud(name, std::move(vertices), std::move(radii));
            cloud.originInFile = originInFile;
            return std::make_shared<const geometry::PointCloud>(std::move(cloud));
        } catch (const std::invalid_argument& invalid) {
            throw std::runtime_error("an invalid point cloud: " + std::string(invalid.what()));
        }
    };
    const auto readSurface = [&](const SurfacePtr& /*null*/) -> Object {
        readVerticesAndOrigin();
        try {
            geometry::SurfaceMesh surface = geometry::makeSurfaceMesh(name, std::move(vertices), arrayFrom(archive));
            surface.originInFile = originInFile;
            return std::make_shared<const geometry::SurfaceMesh>(std::move(surface));
        } catch (const std::invalid_argument& invalid) {
            throw std::runtime_error("an invalid surface: " + std::string(invalid.what()));
        }
    };
    return std::visit(Overloaded{readPolytope, readCloud, readSurface,
                                 [&](const FieldPtr& /*null*/) -> Object {
                                     return std::make_shared<const fields::Field>(readField(name, archive, files));
                                 }},
                      readKind(archive, std::type_identity<Object>()));
}

}  // namespace oval4d::slicing
