// Tests of the functions that all kinds of objects have, and of the encoding of objects as bytes.

#include <algorithm>
#include <array>
#include <cstring>
#include <random>
#include <stdexcept>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "fields/array_field.hpp"
#include "fields/formula_field.hpp"
#include "geometry/point_cloud.hpp"
#include "slicing/object_bytes.hpp"
#include "slicing/section_name.hpp"
#include "slicing/slicer.hpp"
#include "text/message_text.hpp"
#include "unit/slicing/field_support.hpp"
#include "unit/slicing/support.hpp"
#include "unit/slicing/surface_meshes.hpp"

namespace oval4d::slicing {
namespace {

using polytopes::Polytope;
using support::shared;

const Polytope& polytopeIn(const Object& object) { return *std::get<PolytopePtr>(object); }

void expectSameElements(const Polytope& one, const Polytope& other) {
    EXPECT_EQ(one.vertices, other.vertices);
    EXPECT_EQ(one.edges, other.edges);
    EXPECT_EQ(one.faces, other.faces);
    EXPECT_EQ(one.faceEdges, other.faceEdges);
    EXPECT_EQ(one.edgeFaces, other.edgeFaces);
    EXPECT_EQ(one.cells, other.cells);
    EXPECT_EQ(one.cellSigns, other.cellSigns);
    EXPECT_EQ(one.faceCells, other.faceCells);
    EXPECT_EQ(one.typeOfCell, other.typeOfCell);
    EXPECT_EQ(one.convex, other.convex);
}

TEST(Object, TellsWhatItsPolytopeIs) {
    const auto polytope = shared("rectified 5-cell");
    const Object object = polytope, copy = polytope;
    EXPECT_EQ(copy, object);
    EXPECT_EQ(identityOf(copy), polytope.get());
    EXPECT_NE(Object(shared("5-cell")), object);
    EXPECT_EQ(&infoOf(object), polytope.get());
    EXPECT_EQ(elementCounts(object), (std::array<std::size_t, 4>{10, 30, 30, 10}));
    EXPECT_EQ(memoryOf(object), polytopes::memoryOf(*polytope));
    EXPECT_TRUE(std::ranges::equal(typesOfCells(object), polytope->typeOfCell));
    EXPECT_EQ(write4Off(object, polytope->vertices).substr(0, 4), "4OFF");
    std::vector<glm::dvec4> centers;
    findCellCenters(object, centers);
    ASSERT_EQ(centers.size(), 10U);
    for (std::size_t c = 0; c < 10; ++c)
        EXPECT_LT(glm::distance(centers[c], support::centerOfCell(*polytope, c)), 1e-14);
}

TEST(Object, LiesInItsRangeOfW) {
    std::mt19937 random(3);
    for (const char* name : {"5-cell", "24-cell", "120-cell"}) {
        const auto polytope = shared(name);
        const geometry::Rotation turn = support::randomRotation(random);
        const auto [least, most] = rangeOfW(polytope, turn);
        double low = 1e300, high = -1e300;
        for (const auto& v : polytope->vertices) {
            low = std::min(low, turn(v).w);
            high = std::max(high, turn(v).w);
        }
        EXPECT_NEAR(least, low, 1e-12);
        EXPECT_NEAR(most, high, 1e-12);
    }
}

TEST(Object, IsCutAsItsPolytopeIs) {
    std::mt19937 random(4);
    Slicer slicer;
    SliceSet slices, expected;
    for (const char* name : {"5-cell", "{5/2,3,5}", "24-cell"}) {
        const auto polytope = shared(name);
        const geometry::Rotation turn = support::randomRotation(random);
        const geometry::Hyperplanes planes{-3, 7, polytope->circumradius / 4};
        slicer.sliceWithoutSurfaces(polytope, turn, planes, slices);
        CellComplexSlicer().slice(*polytope, turn, planes, expected);
        EXPECT_EQ(slices.vertices, expected.vertices) << name;
        EXPECT_EQ(slices.edges, expected.edges) << name;
        EXPECT_EQ(slices.corners, expected.corners) << name;
        EXPECT_EQ(slices.faceSource, expected.faceSource) << name;
    }
}

/// Returns one object of each kind.
std::vector<Object> objectsOfEachKind() {
    return {shared("5-cell"),
            std::make_shared<const geometry::PointCloud>(
                geometry::makePointCloud("cloud", {{1, 0, 0, 0}, {-1, 0, 0, 0.5}, {0, 0, 1, -0.5}}, {0, 0, 0})),
            std::make_shared<const fields::Field>(*fields::fieldFromFormula("formula", "x^2 + y^2 + z^2 + w^2 - 1")),
            support::cliffordTorus(5, 6)};
}

/// Returns what the slices of the object through its middle are made of, found from these slices.
SliceContent contentOfSlices(const Object& object, double middle) {
    const geometry::Hyperplanes planes{-1, 3, infoOf(object).circumradius / 5, middle};
    SliceSet slices;
    SurfaceDetail detail;
    if (const fields::Field* field = fieldIn(object)) detail = detailOf(*field, planes, 16);
    Slicer().slice(object, {}, planes, {}, detail, slices);
    if (!slices.surfaces.empty()) return SliceContent::level_surfaces;
    const SliceElementCounts size = slices.totalCounts();
    EXPECT_GT(size.vertices, 0U);
    return size.faces > 0 ? SliceContent::solids : size.edges > 0 ? SliceContent::curves : SliceContent::points;
}

TEST(Object, OfEachKindHasTheStatedProperties) {
    const std::vector<Object> objects = objectsOfEachKind();
    for (std::size_t kind = 0; kind < std::variant_size_v<Object>; ++kind) {
        const auto found = std::ranges::find(objects, kind, &Object::index);
        ASSERT_NE(found, objects.end()) << "no example of kind " << kind;
        const Object& object = *found;
        const ObjectKindProperties properties = propertiesOf(object);
        SCOPED_TRACE(properties.noun);
        EXPECT_FALSE(properties.noun.empty());
        const auto [least, most] = rangeOfW(object, {});
        const double middle = (least + most) / 2 + 0.01;
        EXPECT_EQ(contentOfSlices(object, middle), properties.slices);
        EXPECT_EQ(SectionNamer::mayHaveName(object, {}, middle), properties.sectionsHaveNames);
        // This hyperplane lies beyond the object, at less than half the spacing.
        const double spacing = infoOf(object).circumradius / 2;
        SliceSet beyond;
        Slicer().sliceWithoutSurfaces(object, {}, {0, 1, spacing, most + 0.3 * spacing}, beyond);
        EXPECT_EQ(beyond.vertexCount(0) > 0, properties.slicesAreThick);
    }
}

std::string partsOf(const Object& object) {
    std::string bytes;
    serialization::ByteWriter writer(bytes);
    MappedFiles files;
    writeObjectContent(object, writer, files);
    return bytes;
}

Object read(std::string_view bytes, std::size_t maxVertices = 100'000) {
    serialization::ByteReader reader(bytes);
    return readObjectContent(reader, "mine", maxVertices);
}

TEST(ObjectBytes, ObjectsComeAsTheyWere) {
    std::string bytes;
    for (const char* name : {"5-cell", "24-cell", "120-cell", "{5/2,3,5}"}) {
        const auto sent = shared(name);
        MappedFiles files;
        encodeObject(sent, bytes, files);
        const Object decoded = decodeObject(bytes);
        const Polytope& got = polytopeIn(decoded);
        EXPECT_EQ(std::tie(got.name, got.serial, got.cellTypes), std::tie(sent->name, sent->serial, sent->cellTypes));
        EXPECT_EQ(std::tie(got.convexFaces, got.convex, got.circumradius, got.rebuildableFromName),
                  std::tie(sent->convexFaces, sent->convex, sent->circumradius, sent->rebuildableFromName));
        expectSameElements(got, *sent);
    }
}

TEST(ObjectBytes, NoPropertyOfAnObjectIsLost) {
    const std::vector<glm::dvec4> points{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
    geometry::JaggedArray faces;
    faces.add(std::vector<std::uint32_t>{0, 1, 2});
    const auto other = [](auto object) -> Object {
        geometry::ObjectInfo& info = object;
        info = {"other", 7, 3.5, glm::dvec4(1, 2, 3, 4), false, true, {{"cube", 3}, {"prism", 5}}};
        return std::make_shared<const decltype(object)>(std::move(object));
    };
    for (const Object& sent :
         {other(Polytope(*shared("5-cell"))), other(geometry::makePointCloud("cloud", points, {0, 0, 0})),
          other(geometry::makeSurfaceMesh("surface", points, faces)),
          other(*fields::fieldFromFormula("formula", "x"))}) {
        std::string bytes, again;
        MappedFiles files;
        encodeObject(sent, bytes, files);
        const Object copy = decodeObject(bytes);
        const auto& [name, serial, circumradius, originInFile, convex, rebuildable, cellTypes] = infoOf(sent);
        const geometry::ObjectInfo& got = infoOf(copy);
        EXPECT_EQ(std::tie(got.name, got.serial, got.circumradius, got.originInFile),
                  std::tie(name, serial, circumradius, originInFile));
        EXPECT_EQ(std::tie(got.convex, got.rebuildableFromName, got.cellTypes),
                  std::tie(convex, rebuildable, cellTypes));
        encodeObject(copy, again, files);
        EXPECT_EQ(again, bytes);
    }
}

TEST(ObjectBytes, ObjectsKeepTheirPlaceInTheFile) {
    const glm::dvec4 origin(5e6, -1, 0.25, 7);
    Polytope moved = *shared("5-cell");
    moved.originInFile = origin;
    geometry::PointCloud cloud = geometry::makePointCloud("cloud", {{1, 2, 3, 4}, {0, 0, 0, 0}}, {0, 0.5});
    cloud.originInFile = origin;
    for (const Object& sent : {Object(std::make_shared<const Polytope>(moved)),
                               Object(std::make_shared<const geometry::PointCloud>(cloud))}) {
        std::string bytes;
        MappedFiles files;
        encodeObject(sent, bytes, files);
        EXPECT_EQ(infoOf(decodeObject(bytes)).originInFile, origin);
        const Object parts = read(partsOf(sent));
        EXPECT_EQ(infoOf(parts).originInFile, origin);
        EXPECT_EQ(vertexInFile(parts, 0), vertexInFile(sent, 0));
    }
    // An exported file has the coordinates of the file that was loaded.
    const std::string exported = write4Off(std::make_shared<const Polytope>(moved), moved.vertices);
    std::string expected;
    for (int axis = 0; axis < 4; ++axis)
        expected += text::shortestDecimal((moved.vertices[0] + origin)[axis]) + (axis < 3 ? ' ' : '\n');
    EXPECT_NE(exported.find(expected), std::string::npos) << exported;
}

TEST(ObjectBytes, BytesCutShortAreRefused) {
    std::string bytes;
    MappedFiles files;
    encodeObject(shared("5-cell"), bytes, files);
    for (std::size_t size = 0; size < bytes.size(); size += 7)
        EXPECT_THROW((void)decodeObject(std::string_view(bytes).substr(0, size)), std::runtime_error);
}

TEST(ObjectBytes, UnknownKindsAreRefused) {
    std::string bytes, parts = partsOf(shared("5-cell"));
    MappedFiles files;
    encodeObject(shared("5-cell"), bytes, files);
    bytes.front() = parts.front() = static_cast<char>(std::variant_size_v<Object>);
    EXPECT_THROW((void)decodeObject(bytes), std::runtime_error);
    EXPECT_THROW((void)read(parts), std::runtime_error);
}

TEST(ObjectBytes, DamagedBooleansAreRefused) {
    std::string bytes = partsOf(std::make_shared<const fields::Field>(*fields::fieldFromFormula("formula", "x")));
    EXPECT_NO_THROW((void)read(bytes));
    ASSERT_EQ(bytes.back(), 0) << "there is no second array";
    bytes.back() = 2;
    EXPECT_THROW((void)read(bytes), std::runtime_error);
}

TEST(ObjectBytes, PartsMakeTheSameObjectWithANameAndSerialOfItsOwn) {
    for (const char* name : {"5-cell", "24-cell", "120-cell", "runcinated tesseract", "{5/2,3,5}"}) {
        const auto sent = shared(name);
        const Object got = read(partsOf(sent));
        EXPECT_EQ(infoOf(got).name, "mine");
        EXPECT_NE(infoOf(got).serial, sent->serial);
        EXPECT_FALSE(infoOf(got).rebuildableFromName);
        expectSameElements(polytopeIn(got), *sent);
    }
}

TEST(ObjectBytes, PartsWithTooManyVerticesAreRefused) {
    const std::string bytes = partsOf(shared("24-cell"));
    EXPECT_NO_THROW((void)read(bytes, 24));
    EXPECT_THROW((void)read(bytes, 23), std::runtime_error);
}

TEST(ObjectBytes, DamagedPartsAreRefusedOrMakeAnObjectThatCanBeCut) {
    std::mt19937 random(6);
    Slicer slicer;
    SliceSet slices;
    int accepted = 0, refused = 0;
    const auto attempt = [&](const std::string& bytes) {
        try {
            const Object object = read(bytes, 1000);
            ++accepted;
            slicer.sliceWithoutSurfaces(object, {}, {-2, 5, infoOf(object).circumradius / 3}, slices);
        } catch (const std::runtime_error& error) {
            ++refused;
            EXPECT_FALSE(std::string(error.what()).empty());
        }
    };
    for (const char* name : {"5-cell", "tesseract"}) {
        const std::string whole = partsOf(shared(name));
        for (std::size_t size = 0; size < whole.size(); ++size) attempt(whole.substr(0, size));
        EXPECT_EQ(accepted, 0) << "parts that end early";
        for (int round = 0; round < 3000; ++round) {
            std::string bytes = whole;
            for (unsigned changes = 1 + random() % 3; changes > 0; --changes) {
                const std::size_t at = random() % (bytes.size() - 8);
                const std::array<std::uint64_t, 5> odd{0, 1, 0xffffffffU, ~std::uint64_t{0}, random()};
                std::memcpy(&bytes[at], &odd.at(random() % odd.size()), std::size_t{1} << random() % 4);
            }
            attempt(bytes);
        }
        EXPECT_GT(accepted, 10);
        accepted = 0;
    }
    EXPECT_GT(refused, 1000);
}

std::shared_ptr<const fields::Field> arrayOf(const fields::Shape& shape, float factor, fields::Field* into = nullptr) {
    fields::FieldArray array;
    array.shape = shape;
    array.box = {glm::dvec4(-1), glm::dvec4(1, 2, 3, 4)};
    std::vector<float> samples(fields::sampleCount(shape));
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = factor * static_cast<float>(i);
    array.samples = fields::SampleStorage(std::move(samples));
    if (into == nullptr) return std::make_shared<const fields::Field>(*fields::fieldFromArray("run", array));
    EXPECT_FALSE(fields::setSecondArray(*into, array, "pressure"));
    return {};
}

TEST(ObjectBytes, FieldsKeepTheirSecondFunction) {
    const fields::Shape shape{2, 3, 4, 5};
    fields::Field twoArrays = *arrayOf(shape, 1), withFormula = twoArrays;
    arrayOf(shape, -1, &twoArrays);
    EXPECT_FALSE(fields::setSecondFormula(withFormula, "x + a; a=2"));
    const fields::Field formula =
        *fields::fieldFromFormula("formula", "p - a; a=2, p=x*y", fields::kFormulaBox, "p + a*z");
    for (const fields::Field& field : {twoArrays, withFormula, formula}) {
        const Object object = std::make_shared<const fields::Field>(field);
        std::string bytes, parts;
        MappedFiles files;
        encodeObject(object, bytes, files);
        serialization::ByteWriter writer(parts);
        writeObjectContent(object, writer, files);
        serialization::ByteReader reader(parts);
        for (const Object& copy : {decodeObject(bytes), readObjectContent(reader, "copy", 100)}) {
            const fields::Field& back = *fieldIn(copy);
            ASSERT_TRUE(back.second);
            EXPECT_EQ(back.second->formula, field.second->formula);
            EXPECT_EQ(back.second->variable, field.second->variable);
            EXPECT_EQ(back.coloringRange->typicalRange(), field.coloringRange->typicalRange());
            EXPECT_EQ(memoryOf(copy), memoryOf(object));
        }
        for (std::size_t size = 0; size < parts.size(); ++size) {
            serialization::ByteReader cut(std::string_view(parts).substr(0, size));
            EXPECT_THROW(readObjectContent(cut, "cut", 100), std::runtime_error);
        }
    }
    EXPECT_GT(memoryOf(std::make_shared<const fields::Field>(twoArrays)), memoryOf(arrayOf(shape, 1)));
}

TEST(ObjectBytes, FieldsKeepTheirUnits) {
    fields::FieldArray array;
    array.shape = {2, 2, 2, 2};
    array.box = {glm::dvec4(-1), glm::dvec4(1)};
    array.samples = fields::SampleStorage(std::vector<float>(16, 1));
    array.units = {"km", "m", "", "hours since 2020-01-01"};
    array.quantity = {"temperature", "K"};
    array.imageLevel = {2, 3, 1};
    fields::Field field = *fields::fieldFromArray("run", array);
    array.quantity = {"pressure", "Pa"};
    ASSERT_FALSE(fields::setSecondArray(field, array, "p"));
    std::string bytes, parts;
    MappedFiles files;
    encodeObject(std::make_shared<const fields::Field>(field), bytes, files);
    serialization::ByteWriter writer(parts);
    writeObjectContent(std::make_shared<const fields::Field>(field), writer, files);
    serialization::ByteReader reader(parts);
    for (const Object& copy : {decodeObject(bytes), readObjectContent(reader, "copy", 100)}) {
        const fields::Field& back = *fieldIn(copy);
        EXPECT_EQ(back.units, field.units);
        EXPECT_EQ(back.quantity, field.quantity);
        EXPECT_EQ(back.second->quantity, field.second->quantity);
        EXPECT_EQ(back.imageLevel, (fields::MultiscaleImageLevel{2, 3, 1}));
    }
    for (const std::string unit : {"km", "hours since 2020-01-01", "temperature", "Pa"}) {
        std::string damaged = parts;
        const std::size_t at = damaged.find(unit);
        ASSERT_NE(at, std::string::npos) << unit;
        damaged[at] = '\xff';
        serialization::ByteReader again(damaged);
        EXPECT_THROW(readObjectContent(again, "copy", 100), std::runtime_error) << unit;
    }
}

}  // namespace
}  // namespace oval4d::slicing
