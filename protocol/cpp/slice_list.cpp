// The slices themselves: in JSON one after the other, in CBOR each property of all of them in one array, since the
// names of the properties would be most of a small message.

#include <algorithm>
#include <type_traits>

#include "protocol/cpp/slices.hpp"
#include "protocol/cpp/writer.hpp"

namespace oval4d::protocol {

namespace {

using geometry::Polytope;
using geometry::SliceSet;
using scene::Scene;
using scene::Stand;
using Numbers = std::span<const std::uint32_t>;

template <typename T>
std::span<const T> part(const std::vector<T>& all, std::uint32_t begin, std::uint32_t end) {
    return std::span<const T>(all).subspan(begin, end - begin);
}

// What elements were cut from, of one slice or of all.
struct Origins {
    Numbers vertices, edges, faces;
};

Origins originsOf(const SliceSet& slices, std::size_t from, std::size_t to) {
    return {part(slices.vertexOf, slices.vertexBegin[from], slices.vertexBegin[to]),
            part(slices.edgeOf, slices.edgeBegin[from], slices.edgeBegin[to]),
            part(slices.faceOf, slices.faceBegin[from], slices.faceBegin[to])};
}

template <typename W>
void writeOrigins(W& w, const Origins& of) {
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

// The cell that gives each face its colour, where "of" does not say it.
template <typename W>
void writeTints(W& w, const Polytope& polytope, const scene::Presences& presences, Numbers faceOf) {
    const auto cells = static_cast<std::uint32_t>(polytope.cellCount());
    if (std::all_of(faceOf.begin(), faceOf.end(), [cells](std::uint32_t of) { return of < cells; })) return;
    std::vector<std::uint32_t> tints(faceOf.begin(), faceOf.end());
    for (std::uint32_t& tint : tints) tint = scene::tintOf(polytope, presences, tint);
    w.key("tints");
    w.numbers(tints);
}

// How much is seen of each element, where not all of everything is.
template <typename W>
void writePresences(W& w, const scene::Presences& presences, const Origins& of) {
    if (presences.all()) return;
    const auto write = [&](std::string_view name, Numbers elements, const std::vector<scene::Presence>& by) {
        std::vector<std::uint32_t> list;
        for (const std::uint32_t element : elements) list.push_back(static_cast<std::uint32_t>(by[element]));
        w.key(name);
        w.numbers(list);
    };
    w.key("seen");
    w.beginObject();
    write("vertices", of.vertices, presences.vertices);
    write("edges", of.edges, presences.edges);
    write("faces", of.faces, presences.faces);
    w.endObject();
}

// What to draw instead of the faces of slices that need not be convex. Triangles count from their slice's first point.
struct Fill {
    std::vector<glm::dvec3> points;
    std::vector<Triple> triangles;
    std::vector<std::uint32_t> tints, seen;
};

void addFill(const Polytope& polytope, const Scene& scene, std::size_t slice, Fill& fill) {
    const geometry::Fill& from = scene.fill;
    const std::size_t begin = fill.points.size();
    for (std::uint32_t p = from.patchBegin[slice]; p < from.patchBegin[slice + 1]; ++p) {
        const std::uint32_t of = from.patches[p].of;
        const scene::Presence presence = scene.presences.face(of);
        if (presence == scene::Presence::hidden) continue;
        const std::uint32_t tint = scene::tintOf(polytope, scene.presences, of);
        for (std::uint32_t k = from.pieceBegin[p]; k < from.pieceBegin[p + 1]; ++k) {
            const auto first = static_cast<std::uint32_t>(fill.points.size() - begin);
            const auto corners = part(from.corners, from.cornerBegin[k], from.cornerBegin[k + 1]);
            fill.points.insert(fill.points.end(), corners.begin(), corners.end());
            for (std::uint32_t c = 2; c < corners.size(); ++c) {
                fill.triangles.push_back({first, first + c - 1, first + c});
                fill.tints.push_back(tint);
                fill.seen.push_back(static_cast<std::uint32_t>(presence));
            }
        }
    }
}

template <typename W>
void writeFill(W& w, const Fill& fill, const scene::Presences& presences) {
    w.key("points");
    w.vectors(std::span<const glm::dvec3>(fill.points));
    w.key("triangles");
    w.triples(fill.triangles);
    w.key("tints");
    w.numbers(fill.tints);
    if (!presences.all()) {
        w.key("seen");
        w.numbers(fill.seen);
    }
}

void writeStand(JsonWriter&& w, const Stand& stand) {
    w.member("index", stand.index);
    w.member("w", stand.w);
    w.key("position");
    w.vector(stand.position);
    w.member("label", std::string_view(stand.label));
    w.key("label_at");
    w.vector(stand.labelAt);
    w.member("label_size", stand.labelSize);
    w.member("focus", stand.focus);
    w.member("drawn", stand.drawn);
}

void writeSlice(JsonWriter& w, std::string_view stand, const Polytope& polytope, const SliceSet& slices, std::size_t i,
                const Scene& scene) {
    const std::uint32_t f0 = slices.faceBegin[i], f1 = slices.faceBegin[i + 1];
    const Origins of = originsOf(slices, i, i + 1);
    w.beginObject();
    w.written(stand);
    w.key("vertices");
    w.vectors(part(slices.vertices, slices.vertexBegin[i], slices.vertexBegin[i + 1]));
    w.key("edges");
    w.pairs(part(slices.edges, slices.edgeBegin[i], slices.edgeBegin[i + 1]));
    w.key("faces");
    w.lists(
        {part(slices.cornerBegin, f0, f1 + 1), part(slices.corners, slices.cornerBegin[f0], slices.cornerBegin[f1])});
    writeOrigins(w, of);
    writeTints(w, polytope, scene.presences, of.faces);
    writePresences(w, scene.presences, of);
    if (!scene.fill.empty() && scene.fill.patchBegin[i] != scene.fill.patchBegin[i + 1]) {
        Fill fill;
        addFill(polytope, scene, i, fill);
        w.key("fill");
        w.beginObject();
        writeFill(w, fill, scene.presences);
        w.endObject();
    }
    w.endObject();
}

// One property of all stands: a typed array where it is numbers.
template <typename Property>
void writeColumn(CborWriter& w, std::string_view name, const std::vector<Stand>& stands, Property property) {
    using Value = std::decay_t<decltype(property(stands[0]))>;
    constexpr bool kVectors = std::is_same_v<Value, glm::dvec3>;
    w.key(name);
    if constexpr (kVectors || std::is_same_v<Value, double>) {
        std::vector<Value> list;
        for (const Stand& stand : stands) list.push_back(property(stand));
        if constexpr (kVectors) {
            w.vectors(std::span<const Value>(list));
        } else {
            w.doubles(list);
        }
    } else {
        w.beginArray();
        for (const Stand& stand : stands) w.value(property(stand));
        w.endArray();
    }
}

void writeStands(CborWriter&& w, const std::vector<Stand>& stands) {
    writeColumn(w, "index", stands, [](const Stand& stand) { return stand.index; });
    writeColumn(w, "w", stands, [](const Stand& stand) { return stand.w; });
    writeColumn(w, "position", stands, [](const Stand& stand) { return stand.position; });
    writeColumn(w, "label", stands, [](const Stand& stand) { return std::string_view(stand.label); });
    writeColumn(w, "label_at", stands, [](const Stand& stand) { return stand.labelAt; });
    writeColumn(w, "label_size", stands, [](const Stand& stand) { return stand.labelSize; });
    writeColumn(w, "focus", stands, [](const Stand& stand) { return stand.focus; });
    writeColumn(w, "drawn", stands, [](const Stand& stand) { return stand.drawn; });
}

}  // namespace

void SlicesWriter::writeSlices(JsonWriter& w, const Polytope& polytope, const SliceSet& slices, const Scene& scene) {
    w.beginArray();
    stands_.resize(scene.stands.size());
    for (std::size_t i = 0; i < scene.stands.size(); ++i) {
        const Stand& stand = scene.stands[i];
        const auto text = stands_[i].of(stand, [&](std::string& out) { writeStand(JsonWriter(out), stand); });
        writeSlice(w, text, polytope, slices, i, scene);
    }
    w.endArray();
}

void SlicesWriter::writeSizes(CborWriter& w, std::string_view name, Numbers begin) {
    sizes_.resize(begin.size() - 1);
    for (std::size_t i = 0; i < sizes_.size(); ++i) sizes_[i] = begin[i + 1] - begin[i];
    w.key(name);
    w.numbers(sizes_);
}

void SlicesWriter::writeSlices(CborWriter& w, const Polytope& polytope, const SliceSet& slices, const Scene& scene) {
    const std::size_t count = scene.stands.size();
    const Origins of = originsOf(slices, 0, count);
    w.beginObject();
    w.written(columns_.of(scene.stands, [&](std::string& out) { writeStands(CborWriter(out), scene.stands); }));
    w.key("counts");
    w.beginObject();
    writeSizes(w, "vertices", slices.vertexBegin);
    writeSizes(w, "edges", slices.edgeBegin);
    writeSizes(w, "faces", slices.faceBegin);
    w.endObject();
    w.key("vertices");
    w.vectors(std::span<const glm::dvec3>(slices.vertices));
    w.key("edges");
    w.pairs(slices.edges);
    writeSizes(w, "sides", slices.cornerBegin);
    w.key("corners");
    w.numbers(slices.corners);
    writeOrigins(w, of);
    writeTints(w, polytope, scene.presences, of.faces);
    writePresences(w, scene.presences, of);
    if (!scene.fill.empty()) {
        Fill fill;
        std::vector<std::uint32_t> points{0}, triangles{0};
        for (std::size_t i = 0; i < count; ++i) {
            addFill(polytope, scene, i, fill);
            points.push_back(static_cast<std::uint32_t>(fill.points.size()));
            triangles.push_back(static_cast<std::uint32_t>(fill.triangles.size()));
        }
        w.key("fill");
        w.beginObject();
        w.key("counts");
        w.beginObject();
        writeSizes(w, "points", points);
        writeSizes(w, "triangles", triangles);
        w.endObject();
        writeFill(w, fill, scene.presences);
        w.endObject();
    }
    w.endObject();
}

}  // namespace oval4d::protocol
