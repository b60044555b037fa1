// Fuzzes the `slices` message. The input consists of a picture size and command lines, which set the state of a
// session. The message for this state must have the same contents in all encodings. nlohmann::json decodes the binary
// messages. Their arrays with the values of all slices are then converted to one object per slice, as in JSON.

#include <cstring>
#include <initializer_list>
#include <utility>

#include "../unit/wire/decoded.hpp"
#include "scene/composer.hpp"
#include "support.hpp"
#include "wire/slices_message.hpp"

using namespace oval4d;
using fuzz::require;
using nlohmann::json;

namespace {

/// Returns the numbers in the bytes of a typed array.
template <typename T>
json numbersOf(const json::binary_t& bytes) {
    require(bytes.size() % sizeof(T) == 0, "a typed array holds whole numbers");
    std::vector<T> numbers(bytes.size() / sizeof(T));
    if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
    return numbers;
}

/// Returns `value` after replacing every typed array in it by an array of numbers.
json plain(const json& value) {
    if (value.is_binary()) {
        const json::binary_t& bytes = value.get_binary();
        switch (bytes.subtype()) {
            case 64:
                return numbersOf<std::uint8_t>(bytes);
            case 69:
                return numbersOf<std::uint16_t>(bytes);
            case 70:
                return numbersOf<std::uint32_t>(bytes);
            case 85:
                return numbersOf<float>(bytes);
            case 86:
                return numbersOf<double>(bytes);
            default:
                require(false, "a typed array has a known type");
        }
    }
    json out = value;
    if (value.is_structured()) {
        for (json& each : out) each = plain(each);
    }
    return out;
}

/// Takes elements from the front of a list. In the end, requires that none is left.
class Column {
  public:
    explicit Column(const json& list) : list_(list) {}
    ~Column() { require(at_ == list_.size(), "columns are as long as the rows that they are made of"); }
    Column(const Column&) = delete;
    Column& operator=(const Column&) = delete;

    json next() {
        require(at_ < list_.size(), "a column is long enough");
        return list_[at_++];
    }
    json next(std::size_t count) {
        json part = json::array();
        while (part.size() < count) part.push_back(next());
        return part;
    }
    json rows(std::size_t count, std::size_t width) {
        json list = json::array();
        while (list.size() < count) list.push_back(next(width));
        return list;
    }

  private:
    const json& list_;
    std::size_t at_ = 0;
};

/// Three columns of a message: one property of all vertices, of all edges and of all faces.
class Columns {
  public:
    explicit Columns(const json& of) : vertices_(of.at("vertices")), edges_(of.at("edges")), faces_(of.at("faces")) {}
    json next(std::size_t vertices, std::size_t edges, std::size_t faces) {
        json row;
        row["vertices"] = vertices_.next(vertices);
        row["edges"] = edges_.next(edges);
        row["faces"] = faces_.next(faces);
        return row;
    }

  private:
    Column vertices_, edges_, faces_;
};

/// The columns for the triangles that fill faces.
class FillColumns {
  public:
    /// `columns` may lack the columns of a fill.
    explicit FillColumns(const json& columns)
        : present_(columns.contains("fill")),
          fill_(present_ ? columns.at("fill") : kNoFill),
          faint_(fill_.contains("seen")),
          pointCounts_(fill_.at("counts").at("points")),
          triangleCounts_(fill_.at("counts").at("triangles")),
          points_(fill_.at("points")),
          triangles_(fill_.at("triangles")),
          tints_(fill_.at("tints")),
          seen_(faint_ ? fill_.at("seen") : kNoFill.at("tints")) {}

    /// If the next slice or part has triangles, adds its fill to `row`.
    void readInto(json& row) {
        if (!present_) return;
        const std::size_t p = pointCounts_.next(), t = triangleCounts_.next();
        json own;
        own["points"] = points_.rows(p, 3);
        own["triangles"] = triangles_.rows(t, 3);
        own["tints"] = tints_.next(t);
        if (faint_) own["seen"] = seen_.next(t);
        if (t > 0) row["fill"] = std::move(own);
    }

  private:
    static inline const json kNoFill{{"counts", {{"points", json::array()}, {"triangles", json::array()}}},
                                     {"points", json::array()},
                                     {"triangles", json::array()},
                                     {"tints", json::array()}};

    bool present_;
    const json& fill_;
    bool faint_;
    Column pointCounts_, triangleCounts_, points_, triangles_, tints_, seen_;
};

/// The columns for the elements of slices, or of the parts of a projection.
class ElementColumns {
  public:
    explicit ElementColumns(const json& columns)
        : tinted_(columns.contains("tints")),
          faint_(columns.contains("seen")),
          vertexCounts_(columns.at("counts").at("vertices")),
          edgeCounts_(columns.at("counts").at("edges")),
          faceCounts_(columns.at("counts").at("faces")),
          vertices_(columns.at("vertices")),
          edges_(columns.at("edges")),
          sides_(columns.at("sides")),
          corners_(columns.at("corners")),
          tints_(tinted_ ? columns.at("tints") : kNone),
          of_(columns.at("of")),
          seen_(faint_ ? columns.at("seen") : kNowhere),
          fill_(columns) {}

    /// Adds the elements of the next slice or part to `row`.
    void readInto(json& row) {
        const std::size_t v = vertexCounts_.next(), e = edgeCounts_.next(), f = faceCounts_.next();
        row["vertices"] = vertices_.rows(v, 3);
        row["edges"] = edges_.rows(e, 2);
        row["faces"] = json::array();
        while (row["faces"].size() < f) row["faces"].push_back(corners_.next(sides_.next()));
        row["of"] = of_.next(v, e, f);
        if (faint_) row["seen"] = seen_.next(v, e, f);
        if (json own = tints_.next(tinted_ ? f : 0); tinted_ && own != row["of"]["faces"])
            row["tints"] = std::move(own);
        fill_.readInto(row);
    }

  private:
    static inline const json kNone = json::array();
    static inline const json kNowhere{{"vertices", kNone}, {"edges", kNone}, {"faces", kNone}};

    bool tinted_, faint_;
    Column vertexCounts_, edgeCounts_, faceCounts_, vertices_, edges_, sides_, corners_, tints_;
    Columns of_, seen_;
    FillColumns fill_;
};

json partsOf(const json& columns) {
    json parts = columns.at("looks");
    ElementColumns elements(columns);
    for (json& part : parts) elements.readInto(part);
    return parts;
}

json rowsOf(const json& columns) {
    Column w(columns.at("w")), labelSize(columns.at("label_size")), position(columns.at("position"));
    Column labelAt(columns.at("label_at"));
    Column index(columns.at("index")), label(columns.at("label")), focus(columns.at("focus")),
        drawn(columns.at("drawn"));
    ElementColumns elements(columns);
    json rows = json::array();
    for (std::size_t i = 0; i < columns.at("index").size(); ++i) {
        json row{{"index", index.next()}, {"label", label.next()},          {"focus", focus.next()},
                 {"drawn", drawn.next()}, {"label_size", labelSize.next()}, {"w", w.next()}};
        row["position"] = position.next(3);
        row["label_at"] = labelAt.next(3);
        elements.readInto(row);
        rows.push_back(std::move(row));
    }
    return rows;
}

/// Rounds all numbers in `value` to float, the precision of coordinates in a message.
void roundToFloats(json& value) {
    if (value.is_number()) value = static_cast<double>(value.get<float>());
    if (value.is_array()) {
        for (json& each : value) roundToFloats(each);
    }
}

/// Splits a list into rows of `width` numbers.
json rows(const json& list, std::size_t width) { return Column(list).rows(list.size() / width, width); }

/// Converts the contents of a decoded binary message to the form that they have in JSON.
json fromBinary(const json& decoded) {
    json message = plain(decoded);
    if (message.contains("coordinates")) message["coordinates"] = rows(message["coordinates"], 4);
    if (message.contains("density"))
        message["density"] = rows(message["density"], message["scene"]["coordinates"]["columns"]);
    message["slices"] = rowsOf(message["slices"]);
    if (message.contains("projection")) message["projection"]["parts"] = partsOf(message["projection"]["parts"]);
    return message;
}

json fromJson(const std::string& text) {
    json message = fuzz::requireJson(text);
    if (message.contains("coordinates")) roundToFloats(message["coordinates"]);
    const auto roundElements = [](json& piece) {
        roundToFloats(piece["vertices"]);
        if (!piece.contains("fill")) return;
        roundToFloats(piece["fill"]["points"]);
        if (piece["fill"]["triangles"].empty()) piece.erase("fill");
    };
    if (message.contains("projection")) {
        for (json& part : message["projection"]["parts"]) roundElements(part);
    }
    for (json& slice : message["slices"]) {
        for (const char* name : {"position", "label_at"}) roundToFloats(slice[name]);
        roundElements(slice);
    }
    return message;
}

}  // namespace

OVAL4D_FUZZER(slices) {
    std::string_view rest = fuzz::textOf(data, size);
    scene::Viewport viewport;
    if (std::sscanf(std::string(fuzz::takeUntil(rest, '\n')).c_str(), "%4d %4d", &viewport.width, &viewport.height) !=
        2)
        viewport = {};
    viewport = {std::clamp(viewport.width, 16, 8192), std::clamp(viewport.height, 16, 8192)};
    session::Session session;
    for (int lines = 0; !rest.empty() && lines < 8; ++lines)
        fuzz::execute(session, session::CommandLine{std::string(fuzz::takeUntil(rest, '\n'))});

    static slicing::Slicer slicer;
    static slicing::SliceSet slices;
    static scene::Composer composer;
    static scene::Scene scene;
    static wire::SlicesMessageWriter writer;
    static std::string text;
    const session::State& state = session.current;
    slicer.sliceWithoutSurfaces(state.object, state.orientation, state.hyperplanes(), slices);
    composer.limitFaceFilling(100'000);
    composer.limitOcclusion(100'000);
    composer.compose(state.object, state.orientation, slices, state.slices.focus, state.look, viewport, scene);
    writer.write(scene, session.revision, 3, wire::Encoding::json, text);
    const json one = fromJson(text);
    for (const auto& [name, encoding] : wire::kEncodings) {
        if (encoding == wire::Encoding::json) continue;
        writer.write(scene, session.revision, 3, encoding, text);
        const json other = fromBinary(wire::decoded(text, encoding));
        require(one == other, "an encoding says the same as JSON:",
                one == other ? "" : std::string(name) + " " + json::diff(one, other).dump());
    }
    return 0;
}
