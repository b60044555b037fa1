#include "export/formats/writers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

#include "export/formats/vtk_xml.hpp"
#include "export/mesh/field_surfaces.hpp"
#include "export/omissions.hpp"
#include "fields/field.hpp"

namespace oval4d::exports {

namespace {

/// The kind of slice elements in the file: the kind with the highest dimension that slices of the object have.
enum class ListedElementKind : std::uint8_t { vertices, edges, faces };

ListedElementKind listedElementKindOf(const slicing::Object& object) {
    switch (slicing::propertiesOf(object).slices) {
        case slicing::SliceContent::curves:
            return ListedElementKind::edges;
        case slicing::SliceContent::points:
            return ListedElementKind::vertices;
        case slicing::SliceContent::solids:
        case slicing::SliceContent::level_surfaces:
            break;
    }
    return ListedElementKind::faces;
}

/// The arrays in the file.
struct PolyData {
    ListedElementKind elements = ListedElementKind::faces;
    std::vector<double> points;                       // x, y and z of each point
    std::vector<float> normals;                       // x, y and z of the normal at each point
    std::vector<float> values, secondValues, growth;  // secondValues is empty without a second function
    // `corners` has the point index of each corner. `ends` has, for each element, the index after its last corner in
    // `corners`.
    std::vector<std::int64_t> corners, ends;
    std::vector<std::int32_t> n, cell;  // `cell` is empty unless the elements are faces
    std::vector<double> w, level;
    std::vector<std::uint8_t> cap;
};

template <typename Number>
void appendVector(std::vector<Number>& out, const glm::dvec3& v) {
    for (int i = 0; i < 3; ++i) out.push_back(static_cast<Number>(v[i]));
}

glm::dvec3 slicePosition(const SceneToWrite& source, int slice) {
    if (source.contents != ExportContentsKind::oval) return glm::dvec3(0);
    return source.scene.placements[static_cast<std::size_t>(slice)].position / source.scene.scale;
}

void addElements(const SceneToWrite& source, int slice, PolyData& out) {
    const slicing::SliceSet& slices = *source.scene.slices;
    const glm::dvec3 place = slicePosition(source, slice);
    const auto i = static_cast<std::size_t>(slice);
    const auto first = static_cast<std::int64_t>(out.points.size() / 3);
    for (std::uint32_t v = slices.vertexBegin[i]; v < slices.vertexBegin[i + 1]; ++v)
        appendVector(out.points, slices.vertices[v] + place);
    const auto endElement = [&] {
        out.ends.push_back(static_cast<std::int64_t>(out.corners.size()));
        out.n.push_back(slices.planes.first + slice);
        out.w.push_back(slicing::infoOf(source.object).originInFile.w + slices.planes.w(slice));
    };
    switch (out.elements) {
        case ListedElementKind::vertices:
            for (std::uint32_t v = slices.vertexBegin[i]; v < slices.vertexBegin[i + 1]; ++v) {
                out.corners.push_back(first + v - slices.vertexBegin[i]);
                endElement();
            }
            break;
        case ListedElementKind::edges:
            for (std::uint32_t e = slices.edgeBegin[i]; e < slices.edgeBegin[i + 1]; ++e) {
                for (const std::uint32_t end : slices.edges[e]) out.corners.push_back(first + end);
                endElement();
            }
            break;
        case ListedElementKind::faces:
            for (std::uint32_t f = slices.faceBegin[i]; f < slices.faceBegin[i + 1]; ++f) {
                for (std::uint32_t c = slices.cornerBegin[f]; c < slices.cornerBegin[f + 1]; ++c)
                    out.corners.push_back(first + slices.corners[c]);
                endElement();
                out.cell.push_back(static_cast<std::int32_t>(source.scene.coloringCellOfFace(f)));
            }
            break;
    }
}

/// Adds the points of a surface. Returns the index of the first of these points in the file.
std::int64_t addPoints(const FieldSliceSurface& exported, const glm::dvec3& place, PolyData& out) {
    const slicing::SliceSurface& surface = exported.surface;
    const auto first = static_cast<std::int64_t>(out.points.size() / 3);
    for (std::size_t p = 0; p < surface.points.size(); ++p) {
        appendVector(out.points, exported.point(p) + place);
        appendVector(out.normals, glm::dvec3(surface.normals[p]));
        out.values.push_back(surface.values[p]);
        if (!surface.secondValues.empty()) out.secondValues.push_back(surface.secondValues[p]);
        out.growth.push_back(std::isfinite(surface.growth[p]) ? surface.growth[p]
                                                              : std::numeric_limits<float>::quiet_NaN());
    }
    return first;
}

/// Adds a second copy of each point of a cap. The second copy has the mean normal of the cap triangles at the point;
/// the first copy, from addPoints(), has the normal of the level set. `first` is the index in the file of the surface's
/// first point. Returns, for each point of the surface, the index in the file of its second copy, or −1 if the point is
/// in no cap.
std::vector<std::int64_t> addCapPoints(const slicing::SliceSurface& surface, std::int64_t first, PolyData& out) {
    std::vector<std::int64_t> copies(surface.points.size(), -1);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        if (!surface.isCap(t)) continue;
        const auto& [a, b, c] = surface.triangles[t];
        const glm::dvec3 across = glm::cross(glm::dvec3(surface.points[b] - surface.points[a]),
                                             glm::dvec3(surface.points[c] - surface.points[a]));
        for (const std::uint32_t corner : surface.triangles[t]) {
            if (copies[corner] < 0) {
                copies[corner] = static_cast<std::int64_t>(out.values.size());
                const auto from = static_cast<std::size_t>(first) + corner;
                for (std::size_t k = 0; k < 3; ++k) out.points.push_back(out.points[3 * from + k]);
                appendVector(out.normals, glm::dvec3(0));
                out.values.push_back(out.values[from]);
                if (!surface.secondValues.empty()) out.secondValues.push_back(out.secondValues[from]);
                out.growth.push_back(out.growth[from]);
            }
            for (std::size_t k = 0; k < 3; ++k) {
                out.normals[3 * static_cast<std::size_t>(copies[corner]) + k] +=
                    static_cast<float>(across[static_cast<int>(k)]);
            }
        }
    }
    for (const std::int64_t copy : copies) {
        if (copy < 0) continue;
        float* const normal = out.normals.data() + 3 * copy;
        const float length = std::hypot(normal[0], normal[1], normal[2]);
        for (int k = 0; k < 3; ++k) normal[k] = length > 0 ? normal[k] / length : static_cast<float>(k == 2);
    }
    return copies;
}

void addSurface(const SceneToWrite& source, const FieldSliceSurface& exported, int slice, PolyData& out) {
    const slicing::SliceSet& slices = *source.scene.slices;
    const slicing::SliceSurface& surface = exported.surface;
    const std::int64_t first = addPoints(exported, slicePosition(source, slice), out);
    const std::vector<std::int64_t> copies = addCapPoints(surface, first, out);
    const auto& levels = source.scene.look.field.levels;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        for (const std::uint32_t corner : surface.triangles[t])
            out.corners.push_back(surface.isCap(t) ? copies[corner] : first + corner);
        out.ends.push_back(static_cast<std::int64_t>(out.corners.size()));
        out.level.push_back(levels[surface.levelIndex(t)]);
        out.cap.push_back(surface.isCap(t) ? 1 : 0);
        out.n.push_back(slices.planes.first + slice);
        out.w.push_back(slices.planes.w(slice));
    }
}

template <typename Number>
void appendArray(std::string& out, std::string_view name, const std::vector<Number>& numbers, int components = 1,
                 const fields::Quantity& quantity = {}) {
    appendVtkArray(out, name, components, std::span<const Number>(numbers), quantity);
}

// Returns the XML element Piece with all arrays of `data`. `field` is null if the object is not a field. `units` are
// the units of the axes. `asDoubles` says whether coordinates are written as 64-bit floats, otherwise as 32-bit floats.
std::string pieceElement(const PolyData& data, const fields::Field* field, const fields::PictureUnits& units,
                         bool asDoubles) {
    const auto countOf = [&](ListedElementKind elements) {
        return "=\"" + std::to_string(data.elements == elements ? data.ends.size() : 0) + '"';
    };
    std::string out = "<Piece NumberOfPoints=\"" + std::to_string(data.points.size() / 3) + "\" NumberOfVerts" +
                      countOf(ListedElementKind::vertices) + " NumberOfLines" + countOf(ListedElementKind::edges) +
                      " NumberOfStrips=\"0\" NumberOfPolys" + countOf(ListedElementKind::faces) + ">\n";
    if (field != nullptr) {
        out += "<PointData Scalars=\"value\" Normals=\"normals\">\n";
        appendArray(out, "value", data.values, 1, field->quantity);
        if (field->second) appendArray(out, "second_value", data.secondValues, 1, field->second->quantity);
        appendArray(out, "normals", data.normals, 3);
        appendArray(out, "growth", data.growth);
        out += "</PointData>\n<CellData Scalars=\"level\">\n";
        appendArray(out, "level", data.level, 1, field->quantity);
        appendArray(out, "cap", data.cap);
    } else if (data.elements == ListedElementKind::faces) {
        out += "<CellData Scalars=\"cell\">\n";
        appendArray(out, "cell", data.cell);
    } else {
        out += "<CellData Scalars=\"w\">\n";
    }
    appendArray(out, "n", data.n);
    appendArray(out, "w", data.w, 1, {"", units[3].isToScale ? units[3].text : ""});
    out += "</CellData>\n<Points>\n";
    if (asDoubles) {
        appendArray(out, "points", data.points, 3, {"", fields::lengthUnit(units)});
    } else {
        std::vector<float> points(data.points.size());
        std::ranges::transform(data.points, points.begin(), [](double each) { return static_cast<float>(each); });
        appendArray(out, "points", points, 3, {"", fields::lengthUnit(units)});
    }
    const std::string list = data.elements == ListedElementKind::vertices ? "Verts"
                             : data.elements == ListedElementKind::edges  ? "Lines"
                                                                          : "Polys";
    out += "</Points>\n<" + list + ">\n";
    appendArray(out, "connectivity", data.corners);
    appendArray(out, "offsets", data.ends);
    return out + "</" + list + ">\n</Piece>\n";
}

}  // namespace

std::string vtp(const SceneToWrite& source) {
    const fields::Field* const field = slicing::fieldIn(source.object);
    const bool isField = field != nullptr;
    PolyData data;
    if (!isField) data.elements = listedElementKindOf(source.object);
    std::optional<FieldSurfaceSource> surfaces;
    if (isField) surfaces.emplace(source.scene, *field, source.orientation, source.exact, source.budget);
    std::vector<int> empty;
    for (int i = 0; i < source.scene.slices->planes.count; ++i) {
        source.budget.checkTimeAndStop();
        source.budget.checkTrianglesAndMemory(data.ends.size());
        const std::size_t before = data.ends.size();
        isField ? addSurface(source, surfaces->surfaceOfSlice(i), i, data) : addElements(source, i, data);
        if (data.ends.size() == before) empty.push_back(i);
    }
    if (!empty.empty()) {
        const char* const fault = data.elements == ListedElementKind::faces ? "without faces" : "empty";
        source.warnings.push_back(omittedSlicesWarning(source.scene.slices->planes, empty, fault,
                                                       slicing::infoOf(source.object).originInFile.w));
    }
    return vtkFile("PolyData", "", pieceElement(data, field, source.scene.axisUnits, isField && source.exact));
}

}  // namespace oval4d::exports
