#include "slicing/object_bytes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>

#include "fields/array/sample_storage.hpp"
#include "fields/field.hpp"
#include "fields/field_definition.hpp"
#include "geometry/jagged_array.hpp"
#include "geometry/object_info.hpp"
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

// Which members of an object a message contains: `stored` are those from which the object can be made again, and `all`
// are all members (see serialization/stored_members.hpp).
enum class MemberSelection : std::uint8_t { stored, all };

// Writes the members of an object. The samples of an array are written inline, unless they are in a file and exceed the
// limit for inline samples (see writeObjectContent()). In that case, the index of their file and their place in this
// file are written.
class ObjectWriter {
  public:
    ObjectWriter(ByteWriter& archive, MemberSelection members, MappedFiles& files, std::size_t maxInMemory)
        : archive_(archive), members_(members), files_(files), maxInMemory_(maxInMemory) {}

    template <typename T, typename... Ranges>
    void member(std::size_t /*number*/, const T& value, Ranges... /*range*/) {
        write(value);
    }
    template <typename T, typename... Ranges>
    void memberAddedLater(std::size_t /*number*/, const T& value, Ranges... /*range*/) {
        write(value);
    }
    template <typename T>
    void recomputableMember(const T& value) {
        if (members_ == MemberSelection::all) write(value);
    }

  private:
    template <typename T>
    void write(const T& value) {
        if constexpr (requires { visitStoredMembers(value, *this); }) {
            visitStoredMembers(value, *this);
        } else {
            archive_(value);
        }
    }
    template <typename T>
    void write(const std::optional<T>& value) {
        archive_(value.has_value());
        if (value) write(*value);
    }
    template <typename T, std::size_t kSize>
    void write(const std::array<T, kSize>& values) {
        for (const T& value : values) write(value);
    }
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

    ByteWriter& archive_;
    const MemberSelection members_;
    MappedFiles& files_;
    std::size_t maxInMemory_;  // how many more samples that are in a file may be written inline
};

// Reads the members of an object that an ObjectWriter has written. Throws std::runtime_error if bytes or files are
// missing, or if a row of a jagged array does not lie within its items.
class ObjectReader {
  public:
    ObjectReader(ByteReader& archive, MemberSelection members, const MappedFiles& files)
        : archive_(archive), members_(members), files_(files) {}

    template <typename T, typename... Ranges>
    void member(std::size_t /*number*/, T& value, Ranges... /*range*/) {
        read(value);
    }
    template <typename T, typename... Ranges>
    void memberAddedLater(std::size_t /*number*/, T& value, Ranges... /*range*/) {
        read(value);
    }
    template <typename T>
    void recomputableMember(T& value) {
        if (members_ == MemberSelection::all) read(value);
    }

  private:
    template <typename T>
    void read(T& value) {
        if constexpr (requires { visitStoredMembers(value, *this); }) {
            visitStoredMembers(value, *this);
        } else {
            archive_(value);
        }
    }
    template <typename T>
    void read(std::optional<T>& value) {
        bool isThere = false;
        archive_(isThere);
        value.reset();
        if (isThere) read(value.emplace());
    }
    template <typename T, std::size_t kSize>
    void read(std::array<T, kSize>& values) {
        for (T& value : values) read(value);
    }
    void read(JaggedArray& array) {
        archive_(array);
        if (array.begin.empty() || array.begin.front() != 0 || array.begin.back() != array.items.size() ||
            !std::ranges::is_sorted(array.begin))
            throw std::runtime_error("an inconsistent jagged array");
    }
    void read(fields::SampleStorage& samples) {
        bool inFile = false;
        archive_(inFile);
        if (!inFile) {
            std::vector<float> values;
            archive_(values);
            samples = fields::SampleStorage(std::move(values));
            return;
        }
        std::size_t number = 0, offset = 0, count = 0;
        archive_(number), archive_(offset), archive_(count);
        if (number >= files_.size() || !files_[number]) throw std::runtime_error("samples are missing");
        try {
            samples = fields::SampleStorage(files_[number], offset, count);
        } catch (const std::invalid_argument& invalid) {
            throw std::runtime_error(invalid.what());
        }
    }

    ByteReader& archive_;
    const MemberSelection members_;
    const MappedFiles& files_;
};

// Writes an object. A field is written as its definition, from which the field can be made again.
void writeObject(const Object& object, ObjectWriter& writer) {
    std::visit(Overloaded{[&](const FieldPtr& field) {
                              const fields::FieldDefinition definition = fields::definitionByFunctions(*field);
                              visitStoredMembers(definition, writer);
                          },
                          [&](const auto& data) { visitStoredMembers(*data, writer); }},
               object);
}

// Makes a field from its definition. Throws std::runtime_error if the definition is invalid.
fields::Field makeOrThrow(const fields::FieldDefinition& definition) {
    auto field = fields::fieldFromDefinition(definition);
    if (!field) throw std::runtime_error("an invalid field: " + field.error().message);
    return std::move(*field);
}

// Writes the kind of an object, as the index of its alternative in the variant Object.
void writeObjectKind(const Object& object, ByteWriter& archive) { archive(static_cast<std::uint8_t>(object.index())); }

// Reads the kind of an object. Returns an Object with a null pointer of this kind. Callers visit the result to choose
// the function that reads the rest of the object. So the code does not compile if a kind has no such function. Throws
// std::runtime_error if the kind is unknown.
template <typename... Kinds>
Object readObjectKind(ByteReader& archive, std::type_identity<std::variant<Kinds...>> /*kinds*/) {
    const std::array<Object, sizeof...(Kinds)> ofEachKind{Kinds()...};
    std::uint8_t kind = 0;
    archive(kind);
    if (kind >= ofEachKind.size()) throw std::runtime_error("an unknown kind of object");
    return ofEachKind.at(kind);
}

}  // namespace

void encodeObject(const Object& object, std::string& out, MappedFiles& files) {
    out.clear();
    files.clear();
    ByteWriter archive(out);
    writeObjectKind(object, archive);
    ObjectWriter writer(archive, MemberSelection::all, files, 0);
    writeObject(object, writer);
}

Object decodeObject(std::string_view bytes, const MappedFiles& files) {
    ByteReader archive(bytes);
    const Object kind = readObjectKind(archive, std::type_identity<Object>());
    ObjectReader reader(archive, MemberSelection::all, files);
    return std::visit(Overloaded{[&](const FieldPtr& /*null*/) -> Object {
                                     fields::FieldDefinition definition;
                                     visitStoredMembers(definition, reader);
                                     auto field = std::make_shared<fields::Field>(makeOrThrow(definition));
                                     static_cast<geometry::ObjectInfo&>(*field) = std::move(definition.info);
                                     return FieldPtr(std::move(field));
                                 },
                                 [&]<typename T>(const std::shared_ptr<const T>& /*null*/) -> Object {
                                     auto data = std::make_shared<T>();
                                     visitStoredMembers(*data, reader);
                                     return std::shared_ptr<const T>(std::move(data));
                                 }},
                      kind);
}

void writeObjectContent(const Object& object, ByteWriter& archive, MappedFiles& files, std::size_t maxInMemory) {
    writeObjectKind(object, archive);
    ObjectWriter writer(archive, MemberSelection::stored, files, maxInMemory);
    writeObject(object, writer);
}

Object readObjectContent(ByteReader& archive, const std::string& name, std::size_t maxVertices,
                         const MappedFiles& files) {
    const Object kind = readObjectKind(archive, std::type_identity<Object>());
    ObjectReader reader(archive, MemberSelection::stored, files);
    const auto readMembers = [&](auto& stored) {
        visitStoredMembers(stored, reader);
        if (!std::isfinite(glm::length(stored.originInFile))) throw std::runtime_error("an origin that is not finite");
    };
    const auto checkCount = [&](const std::vector<glm::dvec4>& vertices) {
        if (vertices.size() > maxVertices) throw std::runtime_error("too many vertices");
    };
    const auto readPolytope = [&](const PolytopePtr& /*null*/) -> Object {
        Polytope stored;
        readMembers(stored), checkCount(stored.vertices);
        if (stored.typeOfCell.size() != stored.cells.size())
            throw std::runtime_error("cell types that do not match the cells");
        try {
            // makePolytope() rejects indices that are out of range, and cells that are not closed surfaces.
            Polytope polytope = polytopes::makePolytope(name, std::move(stored.vertices), std::move(stored.faces),
                                                        std::move(stored.cells), std::move(stored.typeOfCell));
            polytope.originInFile = stored.originInFile;
            return std::make_shared<const Polytope>(std::move(polytope));
        } catch (const std::invalid_argument& invalid) {
            throw std::runtime_error("an invalid polytope: " + std::string(invalid.what()));
        }
    };
    const auto readCloud = [&](const CloudPtr& /*null*/) -> Object {
        geometry::PointCloud stored;
        readMembers(stored), checkCount(stored.points);
        try {
            geometry::PointCloud cloud =
                geometry::makePointCloud(name, std::move(stored.points), std::move(stored.radii));
            cloud.originInFile = stored.originInFile;
            return std::make_shared<const geometry::PointCloud>(std::move(cloud));
        } catch (const std::invalid_argument& invalid) {
            throw std::runtime_error("an invalid point cloud: " + std::string(invalid.what()));
        }
    };
    const auto readSurface = [&](const SurfacePtr& /*null*/) -> Object {
        geometry::SurfaceMesh stored;
        readMembers(stored), checkCount(stored.vertices);
        if (stored.cells.size() != 0 || !stored.typeOfCell.empty()) throw std::runtime_error("a surface with cells");
        try {
            geometry::SurfaceMesh surface =
                geometry::makeSurfaceMesh(name, std::move(stored.vertices), std::move(stored.faces));
            surface.originInFile = stored.originInFile;
            return std::make_shared<const geometry::SurfaceMesh>(std::move(surface));
        } catch (const std::invalid_argument& invalid) {
            throw std::runtime_error("an invalid surface: " + std::string(invalid.what()));
        }
    };
    const auto readField = [&](const FieldPtr& /*null*/) -> Object {
        fields::FieldDefinition definition;
        visitStoredMembers(definition, reader);
        definition.info.name = name;
        return std::make_shared<const fields::Field>(makeOrThrow(definition));
    };
    return std::visit(Overloaded{readPolytope, readCloud, readSurface, readField}, kind);
}

}  // namespace oval4d::slicing
