#include "scene/composer.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

namespace oval4d::scene {

namespace {

using slicing::Object;
using slicing::SliceSet;

// Returns whether the bars, balls, faces and surfaces in the slices of `object` may cross each other, or hide each
// other in any order.
bool needsDepthBuffer(const Object& object) {
    switch (slicing::propertiesOf(object).slices) {
        case slicing::SliceContent::curves:
        case slicing::SliceContent::level_surfaces:
            return true;
        case slicing::SliceContent::solids:
        case slicing::SliceContent::points:
            break;
    }
    return !slicing::infoOf(object).convex;
}

// Finds the cells that determine the colors of the slice faces `faces`, and writes one cell per face to `out`.
// `sourceOf` returns the source number of a face (see SliceSet::faceSource). This is the index of the cell from which
// the face was cut. If the face is 2-face f of the object, it is the number of cells + f. If every face was cut from a
// cell, `out` is left empty, because the source numbers are then these cells.
template <typename Faces, typename SourceOf>
void findColoringCells(const Object& object, const slicing::VisibilityBySource& visibilities, const Faces& faces,
                       SourceOf sourceOf, std::vector<std::uint32_t>& out) {
    const auto cells = static_cast<std::uint32_t>(slicing::elementCounts(object)[3]);
    out.clear();
    if (std::ranges::all_of(faces, [&](const auto& face) { return sourceOf(face) < cells; })) return;
    for (const auto& face : faces) out.push_back(slicing::coloringCell(object, visibilities, sourceOf(face)));
}

// Adds filled faces of a slice to the filled faces of the projection of the whole object. `from` has the filled faces
// of the slice number `slice`. In the projection, this slice is part `part`, magnified by `magnification`. Before the
// call, this part and those after it must have no filled faces.
void addFillOfSection(const slicing::FilledFaces& from, const SliceSet& slices, int slice, double magnification,
                      std::size_t part, ObjectProjection& out) {
    slicing::FilledFaces& fill = out.fill;
    const std::uint32_t firstLoop = slices.faceBegin[slice], newFirstLoop = out.elements.faceBegin[part];
    for (std::uint32_t f = from.faceBegin[slice]; f < from.faceBegin[slice + 1]; ++f) {
        slicing::FilledFaces::FilledFace face = from.faces[f];
        face.offset *= magnification;
        face.firstLoop = face.firstLoop - firstLoop + newFirstLoop;
        face.endLoop = face.endLoop - firstLoop + newFirstLoop;
        fill.faces.push_back(face);
        for (std::uint32_t k = from.pieceBegin[f]; k < from.pieceBegin[f + 1]; ++k) {
            for (std::uint32_t c = from.cornerBegin[k]; c < from.cornerBegin[k + 1]; ++c)
                fill.corners.push_back(magnification * from.corners[c]);
            fill.cornerBegin.push_back(static_cast<std::uint32_t>(fill.corners.size()));
        }
        fill.pieceBegin.push_back(static_cast<std::uint32_t>(fill.cornerBegin.size() - 1));
    }
    for (std::size_t p = part + 1; p < fill.faceBegin.size(); ++p)
        fill.faceBegin[p] = static_cast<std::uint32_t>(fill.faces.size());
}

// Returns the opacity of translucent faces: `own` (the opacity without the user's factor) times Look::opacity, but at
// most kMost, which looks opaque. An opacity of 1 would tell clients that faces may cross each other.
double translucentOpacity(double own, const Look& look) {
    constexpr double kMost = 0.999;
    return std::min(own * look.opacity, kMost);
}

}  // namespace

// Sets the title, the circumradius, the look and the viewport of `out`. If `object` is not the object of the last call,
// sets objectChanged_. This flag stays set until compose() reads it, because layOutAndChooseDetail() may get a new
// object before compose() does.
void Composer::setObjectLookAndViewport(const Object& object, const Look& look, Viewport viewport, Scene& out) {
    const geometry::ObjectInfo& info = slicing::infoOf(object);
    objectChanged_ = objectChanged_ || object_ != info.serial;
    object_ = info.serial;
    if (objectChanged_) relativeBallRadius_ = slicing::relativeBallRadius(object);
    out.title = info.name;
    out.circumradius = info.circumradius;
    out.look = look;
    out.viewport = viewport;
}

void Composer::layOutAndChooseDetail(const Object& object, const geometry::Hyperplanes& planes, int focus,
                                     const Look& look, Viewport viewport, slicing::Quality quality, Scene& scene,
                                     slicing::SurfaceDetail& out) {
    out.steps.clear();
    out.fogSteps.clear();
    out.quality = quality;
    out.largerStepsWhereSmooth = quality == slicing::Quality::full;
    out.secondValues = colorsByValue(look);
    const bool hasFog = !look.field.fog.empty();
    if (slicing::fieldIn(object) == nullptr || (!look.parts.faces && !hasFog)) return;
    setObjectLookAndViewport(object, look, viewport, scene);
    layoutInput_.focusName.clear();
    layOutIfChanged(object, planes, focus, scene);
    const glm::dvec3 forward = glm::normalize(scene.camera.target - scene.camera.eye);
    // The size in pixels of one unit of the object at the distance 1 from the eye.
    const double unit = scene.camera.focalLength() * viewport.height * scene.sliceRadius / scene.circumradius;
    // In full quality, no lattice is coarser than that of the slices in messages (uniformStep()). On a coarser lattice,
    // the surfaces around thin regions in small slices would break into pieces.
    const double coarsest = quality == slicing::Quality::full ? slicing::uniformStep(scene.circumradius, quality)
                                                              : std::numeric_limits<double>::infinity();
    for (const SlicePlacement& placement : scene.placements) {
        const double depth = glm::dot(forward, placement.position - scene.camera.eye);
        const bool visible = placement.drawn && depth > -scene.sliceRadius;
        const double distance = std::max(depth, scene.sliceRadius);
        const double step = std::min(slicing::pixelsPerCube(quality) * distance / unit, coarsest);
        out.steps.push_back(visible ? step : 0);
    }
    if (hasFog) out.fogSteps = out.steps;
    if (!look.parts.faces) out.steps.clear();
}

void Composer::compose(const Object& object, const geometry::Rotation& orientation, const SliceSet& slices, int focus,
                       const Look& look, Viewport viewport, Scene& out, slicing::Quality quality,
                       ScenePurpose purpose) {
    const bool draws = purpose == ScenePurpose::drawing;
    const geometry::ObjectInfo& info = slicing::infoOf(object);
    setObjectLookAndViewport(object, look, viewport, out);
    const bool objectChanged = std::exchange(objectChanged_, false);
    if (objectChanged || filter_ != look.cellTypes) setCellTypeFilter(object, look.cellTypes);

    out.slices = &slices;
    const fields::Field* const field = slicing::fieldIn(object);
    const bool isField = field != nullptr;
    const bool isSurface = slicing::propertiesOf(object).slices == slicing::SliceContent::curves;
    out.needsDepthBuffer = needsDepthBuffer(object);
    out.faceOpacity = out.needsDepthBuffer ? 1 : translucentOpacity(out.style().faceOpacity, look);
    out.surfaces.clear();
    if (isField && look.parts.faces) chooseSurfaceLook(*field, look, slices.planes, out.surfaces);
    out.fog.clear();
    if (isField && !slices.fogs.empty()) makeFogTable(look.field.fog, out.fog, schemeForBackground(look.background));
    out.axisUnits = isField ? fields::pictureUnits(*field, orientation) : fields::PictureUnits();
    out.visibilities = visibilities_;
    removeHighlightColor(out);
    const ColorScheme scheme = schemeForBackground(look.background);
    if (isSurface && look.parts.projectionFaces) {
        cellPainter_.updateFaceColors(object, look.coloring, scheme, orientation, out.cellColors);
    } else {
        cellPainter_.updateCellColors(object, look.coloring, scheme, orientation, out.cellColors);
    }
    updateHighlight(object, objectChanged, out);
    nameSection(object, orientation, focus, out);
    layOutIfChanged(object, slices.planes, focus, out);
    out.scale = out.sliceRadius / info.circumradius;
    findColoringCells(object, out.visibilities, slices.faceSource, std::identity(), out.faceCells);
    out.fill.clear();
    // If the scene is only for pointing, the faces of the projection are filled roughly, without any steps.
    std::size_t fillSteps = draws ? fillSteps_ : 0;
    if (draws && out.needsDepthBuffer && !isField && look.parts.faces)
        fillSteps = filler_.fill(slices, info.circumradius, out.fill, fillSteps);
    out.fillCells.clear();
    for (const slicing::FilledFaces::FilledFace& face : out.fill.faces)
        out.fillCells.push_back(slicing::coloringCell(object, out.visibilities, face.source));
    if (out.projectionPlacement.shown) projectObject(object, orientation, focus, fillSteps, out);
    if (out.matrix.shown) {
        cutSectionMatrix(object, orientation, focus, out);
        traceContours(object, orientation, quality, out);
    }
    if (draws && out.showsDensityStrip()) updateDensityPlot(orientation, out);
    if (draws && out.showsHistogram()) updateFieldHistograms(object, orientation, out);
}

// Finds the slice elements that show the highlighted element of the object. Gives a highlighted cell the highlight
// color.
void Composer::updateHighlight(const Object& object, bool objectChanged, Scene& out) {
    const std::optional<slicing::Element>& element = out.look.highlight;
    if (objectChanged || highlight_ != element) {
        highlight_ = element;
        highlightSources_.clear();
        if (element && element->index < slicing::elementCount(object, element->kind))
            slicing::findPartsShowing(object, *element, highlightSources_);
    }
    out.highlight = highlightSources_;
    if (!out.highlight.empty() && element->kind == slicing::ElementKind::cell) {
        Color& color = out.cellColors[element->index];
        replacedColor_ = {element->index, color};
        color = out.style().highlight;
    }
}

// Restores the cell color that updateHighlight() has replaced by the highlight color. This is necessary because
// cellPainter_ does not write unchanged colors again.
void Composer::removeHighlightColor(Scene& out) {
    if (!replacedColor_) return;
    const auto [cell, color] = *std::exchange(replacedColor_, {});
    if (cell < out.cellColors.size()) out.cellColors[cell] = color;
}

// Finds the name of the section in the focus slice. If the slice has no name, its label may show the name of a convex
// hull: that of the polytope's vertices in the hyperplane, if this hull is a solid. The label of a field shows the
// moment or the place of the slice in the box instead.
void Composer::nameSection(const Object& object, const geometry::Rotation& orientation, int focus, Scene& out) {
    const SliceSet& slices = *out.slices;
    const int slice = focus - slices.planes.first;
    out.sectionNames = {};
    std::string& focusName = layoutInput_.focusName;
    focusName.clear();
    if (slice < 0 || slice >= slices.planes.count) return;
    const double w = slices.planes.w(slice);
    if (const fields::Field* const field = slicing::fieldIn(object))
        focusName = fields::constantSliceCoordinateText(*field, orientation, w, slices.planes.spacing);
    if (!slicing::propertiesOf(object).sectionsHaveNames) return;
    if (!section_ || !section_->isSectionOf(object, orientation, w)) {
        section_ = slicing::NamedSection{
            slicing::infoOf(object).serial,
            orientation,
            w,
            {sectionNamer_.nameOfSlice(slices, slice),
             sectionNamer_.nameOfHullOfObjectVertices(slices, slice, slicing::elementCounts(object)[1])}};
    }
    out.sectionNames = section_->names;
    const auto& [name, vertices] = out.sectionNames;
    if (!name.empty()) {
        focusName = name;
    } else if (slicing::SectionNamer::isSolidName(vertices)) {
        focusName.append("vertices: ").append(vertices);
    }
}

void Composer::layOutIfChanged(const Object& object, const geometry::Hyperplanes& planes, int focus, Scene& out) {
    LayoutInput& input = layoutInput_;
    input.planes = planes;
    input.focus = focus;
    input.content = {slicing::elementCounts(object)[0], slicing::fieldIn(object) != nullptr,
                     slicing::infoOf(object).originInFile.w, relativeBallRadius_};
    input.look = out.look;
    input.viewport = out.viewport;
    if (laidOutIn_ == &out && laidOut_ == input) return;
    layOutPicture(input.planes, focus, input.content, out.look, out.viewport, input.focusName, out);
    laidOut_ = input;
    laidOutIn_ = &out;
}

// Projects the whole object and the sections that the look shows in the projection. `fillSteps` limits the work of
// filling faces: see slicing::FaceFiller::fill().
void Composer::projectObject(const Object& object, const geometry::Rotation& orientation, int focus,
                             std::size_t fillSteps, Scene& out) {
    // The radii of the bars of sections, as multiples of the radius of the object's bars. kSection is for the section
    // of the focus slice (the middle one), kThinSection for the other sections.
    constexpr double kSection = 1.2, kThinSection = 0.4;
    const Look& look = out.look;
    const SliceSet& slices = *out.slices;
    const bool perspective = look.projection.kind == ProjectionKind::perspective;
    const double eye = look.projection.eye;
    const int focusSlice = focus - slices.planes.first;
    const bool isField = slicing::fieldIn(object) != nullptr;
    const bool all = look.parts.allSections;
    const slicing::Projector::ProjectionOptions options{.projection = {perspective ? 1 / (eye * out.circumradius) : 0},
                                                        .cells = look.parts.projectionFaces,
                                                        .culled = !look.parts.back,
                                                        .hiddenTypes = look.cellTypes.hidden,
                                                        .occlusionSteps = occlusionSteps_,
                                                        .firstSlice = all ? 0 : focusSlice,
                                                        .endSlice = all ? slices.planes.count : focusSlice + 1};
    ObjectProjection& projection = out.projection;
    projector_.project(object, orientation, slices, options, projection.elements, projection.faceCells);
    projection.onlyTurnedAwayLeftOut = projector_.exceededOcclusionSteps();
    const bool isSurface = slicing::propertiesOf(object).slices == slicing::SliceContent::curves;
    if (!isSurface) {
        // Replaces each source number (which says from what a face was cut) by a cell. If a face of a section is a
        // whole 2-face of the object, its source number stands for this 2-face, not for a cell.
        for (std::uint32_t& cell : projection.faceCells) cell = slicing::coloringCell(object, out.visibilities, cell);
    } else if (out.cellColors.size() == 1) {
        std::ranges::fill(projection.faceCells, 0U);
    }
    projection.fill.clear();
    if (!slicing::hasConvexFaces(object))
        filler_.fill(projection.elements, out.circumradius, projection.fill, fillSteps, 1);
    // If the faces of the focus slice (the middle one) may cross each other, out.fill already has these faces, and they
    // are copied from there.
    projection.fill.faceBegin.resize(projection.elements.faceBegin.size());
    const bool hasFocus = focusSlice >= options.firstSlice && focusSlice < options.endSlice;
    const double magnification = hasFocus ? options.projection.magnification(slices.planes.w(focusSlice)) : 1;
    if (!out.fill.empty() && hasFocus) {
        const auto part = static_cast<std::size_t>(1 + focusSlice - options.firstSlice);
        addFillOfSection(out.fill, slices, focusSlice, magnification, part, projection);
    }
    projection.fillCells.clear();
    for (const slicing::FilledFaces::FilledFace& face : projection.fill.faces)
        projection.fillCells.push_back(projection.faceCells[face.firstLoop]);

    projection.scale = out.projectionPlacement.objectRadius / out.circumradius;
    projection.focusSurface.reset();
    if (!out.surfaces.empty() && hasFocus) {
        projection.focusSurface =
            ObjectProjection::FocusSurface{static_cast<std::size_t>(focusSlice), projection.scale * magnification};
    }
    const double ball = out.projectionPlacement.ballRadius, bar = out.projectionPlacement.barRadius;
    const PictureStyle& styles = out.style();
    projection.parts.clear();
    const double barRadius = look.parts.bars ? bar : 0;
    // If balls are hidden, balls with the radius and color of the bars join the bars. The points of a cloud then have
    // this radius, too (see Scene::drawnBallRadius()).
    const bool isCloud = slicing::propertiesOf(object).slices == slicing::SliceContent::points;
    const double pointRadius = look.parts.balls ? ball : bar;
    // Surfaces may be less translucent than the 2-faces between cells, because a line of sight meets a surface less
    // often.
    const double faceOpacity = translucentOpacity(isSurface ? 0.5 : 0.25, look);
    projection.parts.push_back({look.parts.balls || isCloud ? pointRadius : barRadius, barRadius,
                                look.parts.balls ? styles.ball : styles.bar, styles.bar, faceOpacity});
    for (int i = options.firstSlice; i < options.endSlice; ++i) {
        const bool isFocus = i == focusSlice;
        const double sectionBar = (isFocus ? kSection : kThinSection) * bar;
        const Color color = isFocus ? styles.axes[3] : styles.bar;
        const bool filled = isFocus && look.parts.faces && !isField;
        projection.parts.push_back({isCloud ? 1.02 * pointRadius : sectionBar, sectionBar, color, color,
                                    filled ? translucentOpacity(0.5, look) : 0});
    }
}

void Composer::cutSectionMatrix(const Object& object, const geometry::Rotation& orientation, int focus, Scene& out) {
    SectionMatrix& matrix = out.sectionMatrix;
    const int slice = focus - out.slices->planes.first;
    matrix.point = glm::dvec4(out.look.focusPoint, out.slices->planes.w(slice));
    planarSlicer_.slice(object, orientation, *out.slices, slice, matrix.point, matrix.sections);
    const auto counts = slicing::elementCounts(object);
    const auto faces = static_cast<std::uint32_t>(counts[2]), edges = static_cast<std::uint32_t>(counts[1]);
    for (std::size_t i = 0; i < matrix.sections.size(); ++i) {
        SectionMatrix::SectionElementLooks& styles = matrix.styles[i];
        styles = {};
        for (const std::uint32_t source : matrix.sections[i].edgeSource) {
            styles.edgeCells.push_back(slicing::coloringCell(object, out.visibilities, source));
            styles.edges.push_back(out.visibilities.face(source));
        }
        for (const std::uint32_t source : matrix.sections[i].pointSource) {
            // The lowest source numbers of points stand for 2-faces, the next ones for edges, the highest ones for
            // vertices. Slice edges have the same numbers for 2-faces and edges, so the functions for slice edges take
            // these numbers. For a point cloud, all source numbers stand for vertices.
            const bool isVertex = source >= faces + edges;
            styles.points.push_back(isVertex ? out.visibilities.vertex(source - faces) : out.visibilities.edge(source));
            styles.highlighted.push_back(isVertex ? out.highlight.hasVertex(source - faces)
                                                  : out.highlight.hasEdge(source));
        }
    }
}

// Finds the contours of a field in the planes of the matrix. Keeps the contours of the last call if they are still
// valid: changes of the camera and of colors do not move them.
void Composer::traceContours(const Object& object, const geometry::Rotation& orientation, slicing::Quality quality,
                             Scene& out) {
    SectionMatrix& matrix = out.sectionMatrix;
    if (out.surfaces.empty()) {
        contourInput_.reset();
        for (slicing::PlanarContours& contours : matrix.contours) contours.clear();
        return;
    }
    const fields::Field& field = *slicing::fieldIn(object);
    const double side = 2 * SectionMatrixLayout::kReach * out.circumradius,
                 pixels = out.matrix.panel * out.viewport.height;
    ContourInput input{
        object_, orientation, matrix.point, out.look.field.levels, slicing::contourStep(field, side, pixels, quality),
        quality};
    if (contourInput_ == input) return;
    contourInput_.reset();
    contourTracer_.trace(field, orientation, matrix.point, input.levels, input.step, quality, matrix.contours);
    contourInput_ = std::move(input);
}

void Composer::setCellTypeFilter(const Object& object, const CellTypeFilter& filter) {
    slicing::findVisibilities(object, filter.hidden, filter.faded, visibilities_);
    filter_ = filter;
}

void Composer::updateDensityPlot(const geometry::Rotation& orientation, Scene& out) {
    if (densityObject_ != object_ || densityTurn_ != orientation || out.plotTones.empty()) {
        density_.compute(out.slices->rotatedVertices, glm::dmat4(1), out.circumradius);
        densityObject_ = object_;
        densityTurn_ = orientation;
    }
    const auto tones = density_.tones();
    out.plotTones.assign(tones.begin(), tones.end());
}

void Composer::updateFieldHistograms(const Object& object, const geometry::Rotation& orientation, Scene& out) {
    const slicing::FieldSettings& settings = out.look.field;
    if (densityObject_ != object_ || densityTurn_ != orientation || histogramLevels_ != settings.levels ||
        out.plotTones.empty()) {
        histogram_.compute(*slicing::fieldIn(object), orientation, settings.levels);
        densityObject_ = object_;
        densityTurn_ = orientation;
        histogramLevels_ = settings.levels;
    }
    const auto tones = histogram_.tones();
    out.plotTones.assign(tones.begin(), tones.end());
    const auto& [least, greatest] = histogram_.valueRange();
    out.histogram.reach = histogram_.reach();
    out.histogram.least = least;
    out.histogram.greatest = greatest;
    out.histogram.quantity = fields::labelOf(slicing::fieldIn(object)->quantity);
    out.histogram.levelLines.clear();
    for (std::size_t i = 0; i < settings.levels.size(); ++i) {
        const double level = settings.levels[i];
        if (level < least || level > greatest) continue;
        out.histogram.levelLines.push_back({level, surfaceColor(i, settings.levels.size(), out.look)});
    }
}

}  // namespace oval4d::scene
