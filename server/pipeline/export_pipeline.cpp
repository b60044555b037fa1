#include "pipeline/export_pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "pipeline/pipeline.hpp"
#include "scene/composer.hpp"
#include "slicing/element_shape.hpp"
#include "slicing/projector.hpp"
#include "slicing/slice_edges.hpp"
#include "slicing/slicer.hpp"
#include "text/ascii.hpp"
#include "text/choice.hpp"
#include "text/message_text.hpp"
#include "wire/export_query.hpp"

namespace oval4d::pipeline {

namespace {

// Returns the hyperplanes at the values of w in `at` (ExportRequest::chosenW). These values are coordinates in the
// object's file, as in the labels of slices. Errors: `out_of_range` if a value is too far away or given twice.
Result<geometry::Hyperplanes> hyperplanesAtW(const std::vector<double>& at, const scene::PictureRequest& picture) {
    const double origin = slicing::infoOf(picture.object).originInFile.w;
    const double reach = geometry::kMaxOffset * slicing::infoOf(picture.object).circumradius;
    for (const double w : at) {
        if (std::abs(w - origin) <= reach) continue;
        return Error{ErrorCode::out_of_range,
                     "at must be " + text::outsideBoundsText(origin - reach, origin + reach, "", w)};
    }
    std::vector<double> sorted = at;
    std::ranges::sort(sorted);
    if (const auto same = std::ranges::adjacent_find(sorted); same != sorted.end()) {
        return Error{ErrorCode::out_of_range,
                     "at must be different values of w; " + text::roundedDecimal(*same) + " is given twice"};
    }
    std::vector<double> own = at;
    for (double& w : own) w -= origin;
    return geometry::Hyperplanes{0, static_cast<int>(at.size()), picture.planes.spacing, 0, std::move(own)};
}

// Divides the extent of the object along w into `count` equal intervals, and returns the hyperplanes in the middles of
// the intervals. The slices of a point cloud are thick, and do not contain the points at the upper ends of their
// intervals. So if slices are thick, the intervals are slightly longer.
geometry::Hyperplanes hyperplanesDividingExtent(int count, const scene::PictureRequest& picture) {
    const double larger = slicing::propertiesOf(picture.object).slicesAreThick ? 1 + 1e-9 : 1;
    const auto [least, most] = slicing::rangeOfW(picture.object, picture.orientation);
    const double shortest = geometry::kMinSpacing * slicing::infoOf(picture.object).circumradius;
    // The spacing is at least `shortest`, because an object may have no extent along w.
    const double spacing = std::max(larger * (most - least) / count, shortest);
    const double middle = (least + most) / 2;
    return {-(count - 1) / 2, count, spacing, count % 2 == 1 ? middle : middle - spacing / 2};
}

// Returns the hyperplanes of the slices in the exported file. Errors: `bad_message` if the options contradict each
// other; `out_of_range` if there are too many slices or fewer than 1, or if values of w are too far away or equal.
Result<geometry::Hyperplanes> hyperplanesOf(const exports::ExportRequest& request, const scene::PictureRequest& picture,
                                            int maxSlices) {
    const bool all = request.contents == exports::ExportContentsKind::oval;
    if (!request.choosesSlices()) return all ? picture.planes : picture.focusPlane();
    if (!request.chosenW.empty() && request.fittedSlices)
        return Error{ErrorCode::bad_message, "give either at or fit, not both"};
    if (!all) {
        return Error{ErrorCode::bad_message, "at and fit choose slices, so the file must be of oval, not of " +
                                                 std::string(text::nameOf(exports::kExportContents, request.contents))};
    }
    if (request.fittedSlices) {
        if (*request.fittedSlices < 1 || *request.fittedSlices > maxSlices)
            return wire::invalidFitError(maxSlices, text::roundedDecimal(*request.fittedSlices));
        return hyperplanesDividingExtent(*request.fittedSlices, picture);
    }
    if (request.chosenW.size() > static_cast<std::size_t>(maxSlices)) {
        return Error{ErrorCode::out_of_range, "the number of values of at must be at most " +
                                                  std::to_string(maxSlices) + ", not " +
                                                  std::to_string(request.chosenW.size())};
    }
    return hyperplanesAtW(request.chosenW, picture);
}

// Returns a set whose only slice is the projection of the whole object, to be exported instead of `slices`. The
// projection is orthogonal if the picture shows an orthogonal projection, else perspective. Cells of hidden types hide
// what lies behind them, because bodies contain the cells of all types. `occlusionSteps`: see
// slicing::Projector::ProjectionOptions.
slicing::SliceSet projectionAsSlice(const scene::PictureRequest& picture, const slicing::SliceSet& slices,
                                    std::size_t occlusionSteps) {
    const scene::ProjectionSettings& settings = picture.look.projection;
    const bool parallel = settings.kind == scene::ProjectionKind::orthogonal;
    const double radius = slicing::infoOf(picture.object).circumradius;
    slicing::SliceSet projected;
    std::vector<std::uint32_t> faceCells;
    slicing::Projector().project(picture.object, picture.orientation, slices,
                                 {.projection = {parallel ? 0 : 1 / (settings.eye * radius)},
                                  .culled = !picture.look.parts.back,
                                  .occlusionSteps = occlusionSteps},
                                 projected, faceCells);
    projected.planes = slices.planes;
    projected.rotatedVertices = slices.rotatedVertices;
    return projected;
}

// Returns whether an export of a field with this request needs the surfaces in the slices. Exact surfaces do not count,
// because exportScene() makes them.
bool needsFieldSurfaces(const exports::ExportRequest& request) {
    if (request.exact) return false;
    using enum exports::ExportContentsKind;
    if (request.contents == projection || request.contents == matrix || request.contents == highlight) return false;
    return request.format->writeBodies != nullptr ? request.body == exports::BodyKind::solid
                                                  : request.format->readsSurfaces;
}

}  // namespace

Result<exports::ExportedFile> exportFile(const scene::PictureRequest& picture, const exports::ExportRequest& request,
                                         const exports::ExportLimits& limits, std::stop_token stop) {
    const auto chosen = hyperplanesOf(request, picture, limits.slices);
    if (!chosen) return chosen.error();
    const geometry::Hyperplanes& planes = *chosen;
    const bool drawing = request.format->writeDrawing != nullptr;
    if (const auto [least, most] = exports::sizeRangeOf(*request.format);
        !(request.size >= least && request.size <= most)) {
        return Error{ErrorCode::out_of_range, std::string("the size of a ") + (drawing ? "drawing" : "body") +
                                                  " must be " +
                                                  text::outsideBoundsText(least, most, " millimeters", request.size)};
    }
    const bool isField = slicing::fieldIn(picture.object) != nullptr;
    std::optional<slicing::Element> element;  // the highlighted element, if only this element is exported
    if (request.contents == exports::ExportContentsKind::highlight && request.format->canContain(request.contents)) {
        element = picture.look.highlight;
        if (!element) {
            return Error{ErrorCode::no_body,
                         "nothing is highlighted; click an element of the picture, or name one, as in highlight cell "
                         "17 on the command line or highlight=cell:17 in a query"};
        }
    }
    // Whether the file looks like the picture that the user sees.
    const bool hasOwnLook = drawing || request.format->showsPicture;
    const bool showsSlices = hasOwnLook && (request.contents == exports::ExportContentsKind::oval ||
                                            request.contents == exports::ExportContentsKind::focus);
    slicing::SliceSet slices;
    slicing::SurfaceDetail detail;
    if (isField && needsFieldSurfaces(request)) {
        slicing::setUniformDetail(slicing::infoOf(picture.object).circumradius, planes, slicing::Quality::file, detail);
        detail.secondValues = true;
    }
    if (element) {
        slicing::writeElementAsSlice(picture.object, *element, picture.orientation, slices);
    } else {
        try {
            slicing::checkSliceEdges(picture.object, picture.orientation, planes, limits.sliceEdges);
        } catch (const slicing::TooManySliceEdges& fault) {
            return Error{ErrorCode::too_large, fault.what()};
        }
        slicing::Slicer().slice(picture.object, picture.orientation, planes, picture.look.field, detail, slices);
    }
    if (request.contents == exports::ExportContentsKind::projection && !drawing)
        slices = projectionAsSlice(picture, slices, limits.occlusionSteps);
    scene::Look look;
    if (hasOwnLook) {
        look = picture.look;
        if (drawing) look.background = scene::Background::white;  // drawings are printed on white paper
        if (request.contents == exports::ExportContentsKind::matrix) {
            look.view = scene::View::matrix;
        } else if (request.contents != exports::ExportContentsKind::oval) {
            look.view = scene::View::single;
        } else if (!showsAllSlices(look.view)) {
            look.view = scene::View::oval;
        }
        if (showsSlices) {
            const bool isPicture = !drawing && request.contents == exports::ExportContentsKind::oval;
            if (!isPicture) look.projection.kind = scene::ProjectionKind::off;
        } else if (look.projection.kind == scene::ProjectionKind::off) {
            look.projection.kind = scene::ProjectionKind::perspective;
        }
    }
    look.coloring = picture.look.coloring;
    look.parts.coordinates = false;  // the code in export/drawing/ lays out the parallel coordinates itself
    look.field = picture.look.field;
    // A file that does not look like the picture shows the surfaces of fields, but no filled faces of other objects.
    if (!hasOwnLook) look.parts.faces = isField;
    scene::Scene scene;
    scene::Composer composer;
    composer.limitFaceFilling(PictureWorkLimits().fillSteps);
    composer.limitOcclusion(limits.occlusionSteps);
    // A drawing of the focus slice (the middle one) is square. Any other drawing has the proportions of a picture of
    // the default size; for a tall view, width and height are exchanged.
    const bool isSquare = showsSlices && request.contents == exports::ExportContentsKind::focus;
    scene::Viewport viewport;
    if (isSquare) viewport.width = viewport.height;
    if (isExportedInPortrait(look.view)) std::swap(viewport.width, viewport.height);
    const int focus = slices.planes.first + (slices.planes.count - 1) / 2;
    composer.compose(picture.object, picture.orientation, slices, focus, look, viewport, scene, slicing::Quality::file);
    if (element) scene.look.highlight = element;  // set only after compose(), which would color the element differently
    // The drawing of the focus slice (the middle one) is laid out like the view `single`. If the user's view is
    // `matrix`, the drawing also shows the focus point, as this view does.
    if (isSquare && picture.look.view == scene::View::matrix) scene.look.view = scene::View::matrix;
    auto made = exports::exportScene(scene, picture.object, picture.orientation, request, limits, std::move(stop));
    if (auto* error = std::get_if<exports::ExportRefusal>(&made)) {
        using Cause = exports::ExportRefusal::Cause;
        const ErrorCode code = error->cause == Cause::no_body   ? ErrorCode::no_body
                               : error->cause == Cause::no_room ? ErrorCode::too_many
                                                                : ErrorCode::too_large;
        return Error{code, std::move(error->message)};
    }
    return std::get<exports::ExportedFile>(std::move(made));
}

std::string exportFileName(const slicing::Object& object, const exports::ExportRequest& request) {
    std::string name;
    for (const char c : slicing::infoOf(object).name) {
        const bool plain = text::isDigit(c) || text::isLetter(c) || c == '-';
        name += plain ? c : '_';
    }
    return name + "." + request.format->name;
}

}  // namespace oval4d::pipeline
