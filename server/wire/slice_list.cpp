#include "wire/slice_list.hpp"

#include <algorithm>
#include <type_traits>

#include "wire/json_writer.hpp"

namespace oval4d::wire {

namespace {

using scene::Scene;
using scene::SlicePlacement;
using slicing::SliceSet;
using IndexSpan = std::span<const std::uint32_t>;

template <typename T>
std::span<const T> subspanOf(const std::vector<T>& all, std::uint32_t begin, std::uint32_t end) {
    return std::span<const T>(all).subspan(begin, end - begin);
}

// The sources of the vertices, edges and faces of one slice or several. A source is a number that tells from which
// element of the object the vertex, edge or face was cut (see SliceSet).
struct ElementSourceNumbers {
    IndexSpan vertices, edges, faces;
};

ElementSourceNumbers elementSourcesOf(const SliceSet& slices, std::size_t from, std::size_t to) {
    return {subspanOf(slices.vertexSource, slices.vertexBegin[from], slices.vertexBegin[to]),
            subspanOf(slices.edgeSource, slices.edgeBegin[from], slices.edgeBegin[to]),
            subspanOf(slices.faceSource, slices.faceBegin[from], slices.faceBegin[to])};
}

template <typename W>
void writeElementSources(W& w, const ElementSourceNumbers& of) {
    w.key("of");
    w.beginObject();
    w.key("vertices");
    w.numbers(of.vertices);
    w.key("edges");
    w.numbers(of.edges);
    w.key("faces");
    w.numbers(of.faces);
    w.endObject();
}

// Writes, for each face of slices or parts `from` … `to` − 1, the cell that determines its color. Writes nothing if
// each face is cut from this cell.
template <typename W>
void writeColorCells(W& w, const SliceSet& slices, const std::vector<std::uint32_t>& faceCells, std::size_t from,
                     std::size_t to) {
    if (faceCells.empty()) return;
    const IndexSpan sources = subspanOf(slices.faceSource, slices.faceBegin[from], slices.faceBegin[to]);
    const IndexSpan cells = subspanOf(faceCells, slices.faceBegin[from], slices.faceBegin[to]);
    if (std::ranges::equal(sources, cells)) return;
    w.key("tints");
    w.numbers(cells);
}

// Writes the visibility of each element. Writes nothing if all elements are fully visible.
template <typename W>
void writeVisibilities(W& w, const slicing::VisibilityBySource& visibilities, const ElementSourceNumbers& of) {
    if (visibilities.allVisible()) return;
    const auto write = [&](std::string_view name, IndexSpan elements, const std::vector<slicing::Visibility>& by) {
        std::vector<std::uint32_t> list;
        for (const std::uint32_t element : elements) list.push_back(static_cast<std::uint32_t>(by[element]));
        w.key(name);
        w.numbers(list);
    };
    w.key("seen");
    w.beginObject();
    write("vertices", of.vertices, visibilities.vertices);
    write("edges", of.edges, visibilities.edges);
    write("faces", of.faces, visibilities.faces);
    w.endObject();
}

// Writes the sizes and opacities of the balls of slices `from` … `to` − 1. Writes nothing if all balls are equal.
template <typename W>
void writeBalls(W& w, const SliceSet& slices, std::size_t from, std::size_t to) {
    if (slices.ballScale.empty()) return;
    const std::uint32_t begin = slices.vertexBegin[from], end = slices.vertexBegin[to];
    w.key("balls");
    w.beginObject();
    w.key("scale");
    w.floatsForPictures(subspanOf(slices.ballScale, begin, end));
    w.key("opacity");
    w.floatsForPictures(subspanOf(slices.ballOpacity, begin, end));
    w.endObject();
}

// The triangles that clients draw instead of faces that may cross each other or themselves (see Scene::fill and
// ObjectProjection::fill). A "part" is a part of the projection. Indices in a triangle count from the first point of
// the triangle's slice or part.
struct FilledFaceTriangles {
    std::vector<glm::dvec3> points;
    std::vector<IndexTriple> triangles;
    std::vector<std::uint32_t> colorCells, visibilities;
};

// Adds to `fill` the triangles of the faces of one slice or part, except hidden faces. `slice` is the index of the
// slice or part. `colorCells` contains, for each face, the cell that determines its color.
void addFill(const slicing::FilledFaces& from, const std::vector<std::uint32_t>& colorCells,
             const slicing::VisibilityBySource& visibilities, std::size_t slice, FilledFaceTriangles& fill) {
    const std::size_t begin = fill.points.size();
    for (std::uint32_t f = from.faceBegin[slice]; f < from.faceBegin[slice + 1]; ++f) {
        const slicing::Visibility visibility = visibilities.face(from.faces[f].source);
        if (visibility == slicing::Visibility::hidden) continue;
        for (std::uint32_t k = from.pieceBegin[f]; k < from.pieceBegin[f + 1]; ++k) {
            const auto first = static_cast<std::uint32_t>(fill.points.size() - begin);
            const auto corners = subspanOf(from.corners, from.cornerBegin[k], from.cornerBegin[k + 1]);
            fill.points.insert(fill.points.end(), corners.begin(), corners.end());
            for (std::uint32_t c = 2; c < corners.size(); ++c) {
                fill.triangles.push_back({first, first + c - 1, first + c});
                fill.colorCells.push_back(colorCells[f]);
                fill.visibilities.push_back(static_cast<std::uint32_t>(visibility));
            }
        }
    }
}

template <typename W>
void writeTriangles(W& w, const FilledFaceTriangles& fill, const slicing::VisibilityBySource& visibilities) {
    w.key("points");
    w.vectors(std::span<const glm::dvec3>(fill.points));
    w.key("triangles");
    w.triples(fill.triangles);
    w.key("tints");
    w.numbers(fill.colorCells);
    if (!visibilities.allVisible()) {
        w.key("seen");
        w.numbers(fill.visibilities);
    }
}

// Writes the triangles of one slice or part. Writes nothing if there are no filled faces.
void writeFill(JsonWriter& w, const slicing::FilledFaces& faces, const std::vector<std::uint32_t>& colorCells,
               const slicing::VisibilityBySource& visibilities, std::size_t i) {
    if (faces.empty() || faces.faceBegin[i] == faces.faceBegin[i + 1]) return;
    FilledFaceTriangles fill;
    addFill(faces, colorCells, visibilities, i, fill);
    w.key("fill");
    w.beginObject();
    writeTriangles(w, fill, visibilities);
    w.endObject();
}

void writePlacement(JsonWriter&& w, const SlicePlacement& placement) {
    w.beginObject();
    w.member("index", placement.index);
    w.member("w", placement.w);
    w.key("position");
    w.vector(placement.position);
    w.member("label", std::string_view(placement.label));
    w.key("label_at");
    w.vector(placement.labelAt);
    w.member("label_size", placement.labelSize);
    w.member("focus", placement.focus);
    w.member("drawn", placement.drawn);
    w.endObject();
}

// Writes the elements of one slice, or of one part of the projection.
void writeElements(JsonWriter& w, const SliceSet& slices, const std::vector<std::uint32_t>& faceCells,
                   const slicing::VisibilityBySource& visibilities, std::size_t i) {
    const std::uint32_t f0 = slices.faceBegin[i], f1 = slices.faceBegin[i + 1];
    const ElementSourceNumbers of = elementSourcesOf(slices, i, i + 1);
    w.key("vertices");
    w.vectors(subspanOf(slices.vertices, slices.vertexBegin[i], slices.vertexBegin[i + 1]));
    w.key("edges");
    w.pairs(subspanOf(slices.edges, slices.edgeBegin[i], slices.edgeBegin[i + 1]));
    w.key("faces");
    w.jaggedArray({subspanOf(slices.cornerBegin, f0, f1 + 1),
                   subspanOf(slices.corners, slices.cornerBegin[f0], slices.cornerBegin[f1])});
    writeElementSources(w, of);
    writeColorCells(w, slices, faceCells, i, i + 1);
    writeBalls(w, slices, i, i + 1);
    writeVisibilities(w, visibilities, of);
}

void writeSlice(JsonWriter& w, std::string_view placement, const Scene& scene, std::size_t i, SurfaceWriter& surfaces,
                FogWriter& fogs) {
    w.beginObject();
    w.appendMembersOf(placement);
    writeElements(w, *scene.slices, scene.faceCells, scene.visibilities, i);
    writeFill(w, scene.fill, scene.fillCells, scene.visibilities, i);
    surfaces.write(w, scene, i);
    fogs.write(w, scene, i);
    w.endObject();
}

// Writes one property of all placements. Vectors and doubles become a typed array, other values an ordinary array.
template <typename Property>
void writeColumn(BinaryWriter& w, std::string_view name, const std::vector<SlicePlacement>& placements,
                 Property property) {
    using Value = std::decay_t<decltype(property(placements[0]))>;
    constexpr bool kVectors = std::is_same_v<Value, glm::dvec3>;
    w.key(name);
    if constexpr (kVectors || std::is_same_v<Value, double>) {
        std::vector<Value> list;
        for (const SlicePlacement& placement : placements) list.push_back(property(placement));
        if constexpr (kVectors) {
            w.vectors(std::span<const Value>(list));
        } else {
            w.doubles(list);
        }
    } else {
        w.beginArray();
        for (const SlicePlacement& placement : placements) w.value(property(placement));
        w.endArray();
    }
}

template <typename W>
void writePartLook(W& w, const scene::ProjectionPartLook& part) {
    w.member("ball", part.ballRadius);
    w.member("bar", part.barRadius);
    w.member("ball_color", part.ballColor);
    w.member("bar_color", part.barColor);
    w.member("opacity", part.faceOpacity);
}

}  // namespace

void SliceListWriter::write(JsonWriter& w, const Scene& scene, PlacementTexts& texts) {
    w.beginArray();
    texts.perSlice.resize(scene.placements.size());
    for (std::size_t i = 0; i < scene.placements.size(); ++i) {
        const SlicePlacement& placement = scene.placements[i];
        const auto text =
            texts.perSlice[i].textFor(placement, [&](std::string& out) { writePlacement(JsonWriter(out), placement); });
        writeSlice(w, text, scene, i, surfaces_, fogs_);
    }
    w.endArray();
}

void SliceListWriter::writePlacements(BinaryWriter& w, const std::vector<SlicePlacement>& placements) {
    w.beginObject();
    writeColumn(w, "index", placements, [](const SlicePlacement& placement) { return placement.index; });
    writeColumn(w, "w", placements, [](const SlicePlacement& placement) { return placement.w; });
    writeColumn(w, "position", placements, [](const SlicePlacement& placement) { return placement.position; });
    writeColumn(w, "label", placements,
                [](const SlicePlacement& placement) { return std::string_view(placement.label); });
    writeColumn(w, "label_at", placements, [](const SlicePlacement& placement) { return placement.labelAt; });
    writeColumn(w, "label_size", placements, [](const SlicePlacement& placement) { return placement.labelSize; });
    writeColumn(w, "focus", placements, [](const SlicePlacement& placement) { return placement.focus; });
    writeColumn(w, "drawn", placements, [](const SlicePlacement& placement) { return placement.drawn; });
    w.endObject();
}

void SliceListWriter::writeRangeLengths(BinaryWriter& w, std::string_view name, IndexSpan begin) {
    sizes_.resize(begin.size() - 1);
    for (std::size_t i = 0; i < sizes_.size(); ++i) sizes_[i] = begin[i + 1] - begin[i];
    w.key(name);
    w.numbers(sizes_);
}

void SliceListWriter::writeElements(BinaryWriter& w, const SliceSet& slices,
                                    const std::vector<std::uint32_t>& faceCells,
                                    const slicing::VisibilityBySource& visibilities) {
    const std::size_t count = slices.vertexBegin.size() - 1;
    const ElementSourceNumbers of = elementSourcesOf(slices, 0, count);
    w.key("counts");
    w.beginObject();
    writeRangeLengths(w, "vertices", slices.vertexBegin);
    writeRangeLengths(w, "edges", slices.edgeBegin);
    writeRangeLengths(w, "faces", slices.faceBegin);
    w.endObject();
    w.key("vertices");
    w.vectors(std::span<const glm::dvec3>(slices.vertices));
    w.key("edges");
    w.pairs(slices.edges);
    writeRangeLengths(w, "sides", slices.cornerBegin);
    w.key("corners");
    w.numbers(slices.corners);
    writeElementSources(w, of);
    writeColorCells(w, slices, faceCells, 0, count);
    writeBalls(w, slices, 0, count);
    writeVisibilities(w, visibilities, of);
}

void SliceListWriter::writeFills(BinaryWriter& w, const slicing::FilledFaces& faces,
                                 const std::vector<std::uint32_t>& colorCells,
                                 const slicing::VisibilityBySource& visibilities) {
    if (faces.empty()) return;
    FilledFaceTriangles fill;
    std::vector<std::uint32_t> points{0}, triangles{0};
    for (std::size_t i = 0; i + 1 < faces.faceBegin.size(); ++i) {
        addFill(faces, colorCells, visibilities, i, fill);
        points.push_back(static_cast<std::uint32_t>(fill.points.size()));
        triangles.push_back(static_cast<std::uint32_t>(fill.triangles.size()));
    }
    w.key("fill");
    w.beginObject();
    w.key("counts");
    w.beginObject();
    writeRangeLengths(w, "points", points);
    writeRangeLengths(w, "triangles", triangles);
    w.endObject();
    writeTriangles(w, fill, visibilities);
    w.endObject();
}

void SliceListWriter::writeAllSlices(BinaryWriter& w, std::string_view placements, const Scene& scene) {
    w.beginObject();
    w.appendMembersOf(placements);
    writeElements(w, *scene.slices, scene.faceCells, scene.visibilities);
    writeFills(w, scene.fill, scene.fillCells, scene.visibilities);
    surfaces_.write(w, scene);
    fogs_.write(w, scene);
    w.endObject();
}

void SliceListWriter::writeProjection(JsonWriter& w, const Scene& scene) {
    const scene::ObjectProjection& projection = scene.projection;
    w.beginArray();
    for (std::size_t i = 0; i < projection.parts.size(); ++i) {
        w.beginObject();
        writePartLook(w, projection.parts[i]);
        wire::writeElements(w, projection.elements, projection.faceCells, scene.visibilities, i);
        writeFill(w, projection.fill, projection.fillCells, scene.visibilities, i);
        w.endObject();
    }
    w.endArray();
}

void SliceListWriter::writeProjection(BinaryWriter& w, const Scene& scene) {
    const scene::ObjectProjection& projection = scene.projection;
    w.beginObject();
    w.key("looks");
    w.beginArray();
    for (const scene::ProjectionPartLook& part : projection.parts) {
        w.beginObject();
        writePartLook(w, part);
        w.endObject();
    }
    w.endArray();
    writeElements(w, projection.elements, projection.faceCells, scene.visibilities);
    writeFills(w, projection.fill, projection.fillCells, scene.visibilities);
    w.endObject();
}

}  // namespace oval4d::wire
