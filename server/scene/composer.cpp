#include "scene/composer.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace oval4d::scene {

namespace {

using slicing::Object;
using slicing::SliceSet;

// Writes to `out`, for each of `elements`, the cell that determines its color. Leaves `out` empty if the sources of all
// elements are cells, because these cells then determine the colors.
template <typename Sources, typename SourceOf>
void findCells(const Object& object, const slicing::Visibilities& visibilities, const Sources& elements,
               SourceOf sourceOf, std::vector<std::uint32_t>& out) {
    const auto cells = static_cast<std::uint32_t>(slicing::elementCounts(object)[3]);
    out.clear();
    if (std::ranges::all_of(elements, [&](const auto& element) { return sourceOf(element) < cells; })) return;
    for (const auto& element : elements) out.push_back(slicing::coloringCell(object, visibilities, sourceOf(element)));
}

}  // namespace

void Composer::compose(const Object& object, const geometry::Rotation& orientation, const SliceSet& slices, int focus,
                       const Look& look, Viewport viewport, Scene& out) {
    const geometry::ObjectInfo& info = slicing::infoOf(object);
    const bool objectChanged = object_ != info.serial;
    object_ = info.serial;
    if (objectChanged) ballRadius_ = slicing::ballRadius(object);
    if (objectChanged || filter_ != look.cellTypes) setFilter(object, look.cellTypes);

    out.slices = &slices;
    out.title = info.name;
    out.circumradius = info.circumradius;
    out.look = look;
    out.viewport = viewport;
    out.crossing = !info.convex;
    out.faceOpacity = info.convex ? style().faceOpacity : 1;
    out.visibilities = visibilities_;
    colors_.paint(object, look.coloring, orientation, out.cellColors);
    highlight(object, objectChanged, out);
    nameSection(object, focus, out);
    layOutIfChanged(focus, out);
    out.scale = out.sliceRadius / info.circumradius;
    out.ballRadius = ballRadius_ * out.sliceRadius;
    out.barRadius = 0.4 * out.ballRadius;

    if (out.projectionPlacement.shown) projectObject(object, orientation, focus, out);
    if (out.matrix.shown) cutMatrix(object, orientation, focus, out);

    findCells(object, out.visibilities, slices.faceSource, std::identity(), out.faceCells);
    out.fill.clear();
    if (out.crossing && look.parts.faces) filler_.fill(slices, info.circumradius, out.fill, fillSteps_);
    out.patchCells.clear();
    for (const slicing::Fill::Patch& patch : out.fill.patches)
        out.patchCells.push_back(slicing::coloringCell(object, out.visibilities, patch.source));
    if (out.showsDensity()) measureDensity(orientation, out);
}

// Finds what shows the highlighted element, and gives a highlighted cell its color.
void Composer::highlight(const Object& object, bool objectChanged, Scene& out) {
    const std::optional<slicing::Element>& element = out.look.highlight;
    if (objectChanged || highlight_ != element) {
        highlight_ = element;
        highlightSources_.clear();
        if (element && element->index < slicing::elementCount(object, element->kind))
            slicing::findSourcesShowing(object, *element, highlightSources_);
    }
    out.highlight = highlightSources_;
    if (!out.highlight.empty() && element->kind == slicing::ElementKind::cell)
        out.cellColors[element->index] = style().highlight;
}

// Names the section of the focus hyperplane. In its label, the vertices' hull stands in for a slice without a name.
void Composer::nameSection(const Object& object, int focus, Scene& out) {
    const SliceSet& slices = *out.slices;
    const int slice = focus - slices.planes.first;
    out.sectionNames = {};
    std::string& focusName = layoutInput_.focusName;
    focusName.clear();
    const std::size_t edges = slicing::elementCounts(object)[1];
    if (edges == 0 || slice < 0 || slice >= slices.planes.count) return;
    out.sectionNames = {sectionNamer_.nameOfSlice(slices, slice), sectionNamer_.nameOfVertices(slices, slice, edges)};
    const auto& [name, vertices] = out.sectionNames;
    if (!name.empty()) {
        focusName = name;
    } else if (slicing::SectionNamer::isSolid(vertices)) {
        focusName.append("vertices: ").append(vertices);
    }
}

void Composer::layOutIfChanged(int focus, Scene& out) {
    LayoutInput& input = layoutInput_;
    input.planes = out.slices->planes;
    input.focus = focus;
    input.vertices = out.slices->rotatedVertices.size();
    input.ballRadius = ballRadius_;
    input.look = out.look;
    input.viewport = out.viewport;
    if (laidOutIn_ == &out && laidOut_ == input) return;
    layOut(input.planes, focus, input.vertices, ballRadius_, out.look, out.viewport, input.focusName, out);
    laidOut_ = input;
    laidOutIn_ = &out;
}

void Composer::projectObject(const Object& object, const geometry::Rotation& orientation, int focus, Scene& out) {
    // The projection has many more bars in less room than a slice.
    constexpr double kThickness = 0.55, kSection = 1.2, kThinSection = 0.4;
    const Look& look = out.look;
    const SliceSet& slices = *out.slices;
    const bool perspective = look.projection.kind == ProjectionKind::perspective;
    const double eye = look.projection.eye;
    const int focusSlice = focus - slices.planes.first;
    const bool all = look.parts.sections;
    const slicing::Projector::Options options{.projection = {perspective ? 1 / (eye * out.circumradius) : 0},
                                              .cells = look.parts.cells,
                                              .culled = !look.parts.back,
                                              .firstSlice = all ? 0 : focusSlice,
                                              .endSlice = all ? slices.planes.count : focusSlice + 1};
    ObjectProjection& projection = out.projection;
    projector_.project(object, orientation, slices, options, projection.elements, projection.faceCells);

    // In perspective, points on the circumscribed sphere appear at most this much farther from the center.
    const double magnification = perspective ? eye / std::sqrt(eye * eye - 1) : 1;
    const double radius = out.projectionPlacement.radius / (magnification + kThickness * ballRadius_);
    projection.scale = radius / out.circumradius;
    const double ball = kThickness * ballRadius_ * radius, bar = 0.4 * ball;
    const Style& styles = style();
    projection.parts.clear();
    const double barRadius = look.parts.bars ? bar : 0;
    // Without balls, the bars are joined by balls of their own radius and color, as in slices.
    projection.parts.push_back({look.parts.balls ? ball : barRadius, barRadius,
                                look.parts.balls ? styles.ball : styles.bar, styles.bar, 0.25});
    for (int i = options.firstSlice; i < options.endSlice; ++i) {
        const bool isFocus = i == focusSlice;
        const double thickness = (isFocus ? kSection : kThinSection) * bar;
        const Color color = isFocus ? styles.axes[3] : styles.bar;
        const bool filled = isFocus && look.parts.faces && !out.crossing;
        const bool points = !slices.ballScale.empty();
        projection.parts.push_back({points ? 1.02 * ball : thickness, thickness, color, color, filled ? 0.5 : 0});
    }
}

void Composer::cutMatrix(const Object& object, const geometry::Rotation& orientation, int focus, Scene& out) {
    SectionMatrix& matrix = out.sectionMatrix;
    const int slice = focus - out.slices->planes.first;
    matrix.point = glm::dvec4(out.look.focusPoint, out.slices->planes.w(slice));
    planarSlicer_.slice(object, orientation, *out.slices, slice, matrix.point, matrix.sections);
    const auto counts = slicing::elementCounts(object);
    const auto faces = static_cast<std::uint32_t>(counts[2]), edges = static_cast<std::uint32_t>(counts[1]);
    for (std::size_t i = 0; i < matrix.sections.size(); ++i) {
        SectionMatrix::SectionStyle& styles = matrix.styles[i];
        styles = {};
        for (const std::uint32_t source : matrix.sections[i].edgeSource) {
            styles.edgeCells.push_back(slicing::coloringCell(object, out.visibilities, source));
            styles.edges.push_back(out.visibilities.face(source));
        }
        for (const std::uint32_t source : matrix.sections[i].pointSource) {
            // Beyond the numbers of the 2-faces and edges are those of the vertices; a cloud has vertices only.
            const bool isVertex = source >= faces + edges;
            styles.points.push_back(isVertex ? out.visibilities.vertex(source - faces) : out.visibilities.edge(source));
            styles.highlighted.push_back(isVertex ? out.highlight.hasVertex(source - faces)
                                                  : out.highlight.hasEdge(source));
        }
    }
}

void Composer::setFilter(const Object& object, const CellTypeFilter& filter) {
    using slicing::Visibility;
    std::vector<Visibility> ofType(slicing::infoOf(object).cellTypes.size(), Visibility::full);
    const auto set = [&](const std::vector<std::uint32_t>& types, Visibility visibility) {
        for (const std::uint32_t type : types) {
            if (type < ofType.size()) ofType[type] = visibility;
        }
    };
    set(filter.faded, Visibility::faded);
    set(filter.hidden, Visibility::hidden);
    slicing::findVisibilities(object, ofType, visibilities_);
    filter_ = filter;
}

void Composer::measureDensity(const geometry::Rotation& orientation, Scene& out) {
    if (densityObject_ != object_ || densityTurn_ != orientation || out.density.empty()) {
        density_.measure(out.slices->rotatedVertices, glm::dmat4(1), out.circumradius);
        densityObject_ = object_;
        densityTurn_ = orientation;
    }
    const auto tones = density_.tones();
    out.density.assign(tones.begin(), tones.end());
}

}  // namespace oval4d::scene
