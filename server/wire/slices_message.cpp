#include "wire/slices_message.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "scene/density_plot.hpp"
#include "slicing/coordinate_value_histograms.hpp"
#include "text/choice.hpp"
#include "wire/encoding.hpp"
#include "wire/fog_writer.hpp"

namespace oval4d::wire {

namespace {

using scene::Scene;

// Writes an array of pairs of numbers. In all encodings, each pair is an ordinary array, not a typed array.
template <typename W, typename Pairs>
void writePairs(W& w, std::string_view name, const Pairs& list) {
    w.key(name);
    w.beginArray();
    for (const auto& pair : list) {
        w.beginArray();
        for (int i = 0; i < 2; ++i) w.value(pair[i]);
        w.endArray();
    }
    w.endArray();
}

// Writes a member that is an array of numbers. In all encodings, it is an ordinary array, not a typed array.
template <typename W, typename Numbers = std::initializer_list<double>>
void writeNumbers(W& w, std::string_view name, const Numbers& list) {
    w.key(name);
    w.beginArray();
    for (const auto& number : list) {
        if constexpr (std::is_enum_v<std::decay_t<decltype(number)>>) {
            w.value(static_cast<std::uint32_t>(number));
        } else {
            w.value(number);
        }
    }
    w.endArray();
}

template <typename W>
void writeCamera(W& w, const scene::Camera& camera) {
    w.key("camera");
    w.beginObject();
    writeNumbers(w, "eye", {camera.eye.x, camera.eye.y, camera.eye.z});
    writeNumbers(w, "target", {camera.target.x, camera.target.y, camera.target.z});
    writeNumbers(w, "up", {camera.up.x, camera.up.y, camera.up.z});
    w.member("fov", camera.fieldOfView);
    w.member("near", camera.near);
    w.member("far", camera.far);
    writeNumbers(w, "shift", {camera.shiftX, camera.shiftY});
    w.endObject();
}

template <typename W>
void writeColors(W& w, const scene::PictureStyle& style, const std::vector<scene::Color>& cells) {
    w.key("colors");
    w.beginObject();
    w.member("background", style.background);
    w.member("text", style.text);
    w.member("focus", style.focusText);
    w.member("ball", style.ball);
    w.member("bar", style.bar);
    w.member("zero", style.zeroLine);
    w.member("highlight", style.highlight);
    w.key("axes");
    w.beginArray();
    for (const scene::Color color : style.axes) w.value(color);
    w.endArray();
    w.key("cells");
    w.numbers(cells);
    w.endObject();
}

// Writes the contours (level curves) of a field in a plane.
template <typename W>
void writeContours(W& w, const slicing::PlanarContours& contours) {
    w.key("contours");
    w.beginArray();
    for (std::size_t i = 0; i < contours.lineCount(); ++i) {
        w.beginObject();
        w.member("level", contours.level[i]);
        writePairs(w, "points", contours.line(i));
        w.endObject();
    }
    w.endArray();
}

// Returns the number of columns of the image in Scene::plotTones; 0 if there is no image.
int plotColumnCount(const scene::ParallelCoordinatesLayout& layout) {
    if (layout.panel > 0) return slicing::CoordinateValueHistograms::kColumns;
    return layout.isDensityStrip ? scene::DensityPlot::kColumns : 0;
}

template <typename W>
void writeHistogram(W& w, const scene::HistogramAxes& histogram) {
    w.key("histogram");
    w.beginObject();
    writeNumbers(w, "reach", histogram.reach);
    writeNumbers(w, "range", {histogram.least, histogram.greatest});
    w.key("levels");
    w.beginArray();
    for (const scene::HistogramAxes::LevelLine& line : histogram.levelLines) {
        w.beginObject();
        w.member("value", line.value);
        w.member("color", line.color);
        w.endObject();
    }
    w.endArray();
    if (!histogram.quantity.empty()) w.member("quantity", std::string_view(histogram.quantity));
    w.endObject();
}

// Writes the member `units` with the units of those axes whose units are known. Writes nothing if none is known.
template <typename W>
void writePictureUnits(W& w, const fields::PictureUnits& units) {
    if (std::ranges::all_of(units, &std::string::empty, &fields::PictureAxisUnit::text)) return;
    w.key("units");
    w.beginObject();
    for (std::size_t axis = 0; axis < units.size(); ++axis) {
        const std::string_view unit = units.at(axis).text;
        if (!unit.empty()) w.member(std::string_view("xyzw").substr(axis, 1), unit);
    }
    w.endObject();
}

template <typename W>
void writeCoordinatesLayout(W& w, const scene::ParallelCoordinatesLayout& layout) {
    w.key("coordinates");
    w.beginObject();
    w.member("rows", layout.rows);
    w.member("per_row", layout.perRow);
    w.member("left", layout.left);
    w.member("zero", layout.zero);
    w.member("row_step", layout.rowStep);
    w.member("column_step", layout.columnStep);
    w.member("line_step", layout.lineStep);
    w.member("line_width", layout.lineWidth);
    w.member("amplitude", layout.amplitude);
    w.member("named", layout.named);
    w.member("columns", plotColumnCount(layout));
    w.member("panel", layout.panel);
    w.endObject();
}

template <typename W>
void writeStaticScene(W&& w, const SlicesMessageWriter::StaticScene& fixed) {
    const scene::PictureStyle& style = scene::style();
    w.beginObject();
    w.member("view", text::nameOf(scene::kViews, fixed.view));
    w.key("shown");
    w.beginObject();
    for (const scene::NamedPicturePart& part : scene::kParts) w.member(part.name, fixed.shown.*part.flag);
    w.endObject();
    w.key("viewport");
    w.beginObject();
    w.member("width", fixed.viewport.width);
    w.member("height", fixed.viewport.height);
    w.endObject();
    writeCamera(w, fixed.camera);
    w.member("scale", fixed.scale);
    w.member("circumradius", fixed.circumradius);
    w.member("ball", fixed.ball);
    w.member("bar", fixed.bar);
    w.member("opacity", fixed.opacity);
    w.member("faded", slicing::opacityOf(slicing::Visibility::faded));
    w.key("light");
    w.beginObject();
    writeNumbers(w, "direction", {style.light.x, style.light.y, style.light.z});
    w.member("ambient", style.ambient);
    w.member("diffuse", style.diffuse);
    w.member("specular", style.specular);
    w.member("shininess", style.shininess);
    w.endObject();
    w.key("axes");
    w.beginObject();
    w.member("x", fixed.axes.x);
    w.member("y", fixed.axes.y);
    w.member("length", fixed.axes.length);
    w.endObject();
    writeCoordinatesLayout(w, fixed.coordinates);
    w.member("text", style.textHeight);
    w.endObject();
}

}  // namespace

template <typename W>
void SlicesMessageWriter::writeMessage(W&& w, CachedTexts& texts, const Scene& scene, std::uint64_t revision,
                                       std::optional<double> id, slicing::Quality quality) {
    w.beginObject();
    w.member("type", "slices");
    if (id) {
        w.key("id");
        w.id(*id);
    }
    w.member("revision", revision);
    if (quality == slicing::Quality::draft) w.member("draft", true);
    w.key("scene");
    w.beginObject();
    const StaticScene fixed{scene.look.view,   scene.look.parts,   scene.viewport,   scene.camera,
                            scene.scale,       scene.circumradius, scene.ballRadius, scene.barRadius,
                            scene.faceOpacity, scene.axes,         scene.coordinates};
    w.appendMembersOf(texts.staticScene.textFor(fixed, [&](std::string& out) { writeStaticScene(W(out), fixed); }));
    writeColors(w, scene.style(), scene.cellColors);
    SurfaceWriter::writeLook(w, scene.surfaces);
    writeFogTable(w, scene.fog);
    writePictureUnits(w, scene.axisUnits);
    w.endObject();
    if (scene.look.parts.coordinates) {
        // The vertices of a field are only the corners of its domain, so a field has histograms instead of parallel
        // coordinates.
        if (!scene.showsHistogram()) {
            w.key("coordinates");
            w.vectors(std::span<const glm::dvec4>(scene.slices->rotatedVertices));
        }
        if (!scene.coordinates.hasLines()) {
            w.key("density");
            w.image(scene.plotTones, plotColumnCount(scene.coordinates));
        }
        if (scene.showsHistogram()) writeHistogram(w, scene.histogram);
    }
    w.key("section");
    w.beginObject();
    w.member("name", scene.sectionNames.slice);
    w.member("vertices", scene.sectionNames.vertices);
    w.endObject();
    if (!scene.highlight.empty()) {
        w.key("highlight");
        w.beginObject();
        w.key("vertices");
        w.numbers(scene.highlight.vertices);
        w.key("edges");
        w.numbers(scene.highlight.edges);
        w.key("own_vertices");
        w.numbers(scene.highlight.ownVertices);
        w.endObject();
    }
    w.key("slices");
    list_.write(w, scene, texts.placements);
    if (scene.projectionPlacement.shown) writeProjection(w, scene);
    if (scene.matrix.shown) writeMatrix(w, scene);
    w.endObject();
}

template <typename W>
void SlicesMessageWriter::writeProjection(W& w, const Scene& scene) {
    const glm::dvec3& position = scene.projectionPlacement.position;
    w.key("projection");
    w.beginObject();
    w.member("kind", text::nameOf(scene::kProjectionKinds, scene.look.projection.kind));
    w.member("eye", scene.look.projection.eye);
    writeNumbers(w, "position", {position.x, position.y, position.z});
    w.member("scale", scene.projection.scale);
    if (scene.projection.focusSurface) w.member("surface_scale", scene.projection.focusSurface->scale);
    if (scene.projection.onlyTurnedAwayLeftOut) w.member("only_turned_away", true);
    w.key("parts");
    list_.writeProjection(w, scene);
    w.endObject();
}

template <typename W>
void SlicesMessageWriter::writeMatrix(W& w, const Scene& scene) {
    const scene::SectionMatrixLayout& layout = scene.matrix;
    const scene::SectionMatrix& matrix = scene.sectionMatrix;
    w.key("matrix");
    w.beginObject();
    w.member("left", layout.left);
    w.member("bottom", layout.bottom);
    w.member("panel", layout.panel);
    w.member("step", layout.step);
    w.member("line_width", layout.lineWidth);
    w.member("ball", layout.pointRadius);
    w.member("reach", scene::SectionMatrixLayout::kReach * scene.circumradius);
    writeNumbers(w, "point", {matrix.point.x, matrix.point.y, matrix.point.z, matrix.point.w});
    w.key("sections");
    w.beginArray();
    for (std::size_t i = 0; i < matrix.sections.size(); ++i) {
        const slicing::PlanarSection& section = matrix.sections[i];
        const scene::SectionMatrix::SectionElementLooks& styles = matrix.styles[i];
        w.beginObject();
        writeNumbers(w, "axes", section.axes);
        writePairs(w, "points", section.points);
        writePairs(w, "edges", section.edges);
        writeNumbers(w, "boundary", section.boundary);
        w.key("of");
        w.beginObject();
        writeNumbers(w, "points", section.pointSource);
        writeNumbers(w, "edges", section.edgeSource);
        w.endObject();
        writeNumbers(w, "tints", styles.edgeCells);
        if (!scene.visibilities.allVisible()) {
            w.key("seen");
            w.beginObject();
            writeNumbers(w, "points", styles.points);
            writeNumbers(w, "edges", styles.edges);
            w.endObject();
        }
        if (!section.ballScale.empty()) {
            w.key("balls");
            w.beginObject();
            writeNumbers(w, "scale", section.ballScale);
            writeNumbers(w, "opacity", section.ballOpacity);
            w.endObject();
        }
        if (!scene.surfaces.empty()) writeContours(w, matrix.contours[i]);
        w.endObject();
    }
    w.endArray();
    w.endObject();
}

void SlicesMessageWriter::write(const Scene& scene, std::uint64_t revision, std::optional<double> id, Encoding encoding,
                                std::string& out, slicing::Quality quality) {
    CachedTexts& texts = texts_.at(static_cast<std::size_t>(encoding));
    writeEncoded(encoding, out, [&]<typename W>(W&& writer) {
        writeMessage(std::forward<W>(writer), texts, scene, revision, id, quality);
    });
}

}  // namespace oval4d::wire
