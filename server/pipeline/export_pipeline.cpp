#include "pipeline/export_pipeline.hpp"

#include <charconv>
#include <utility>

#include "scene/composer.hpp"
#include "slicing/projector.hpp"
#include "slicing/slicer.hpp"
#include "text/ascii.hpp"
#include "text/choice.hpp"
#include "text/message_text.hpp"

namespace oval4d::pipeline {

namespace {

template <typename Choices, typename Value>
Result<std::monostate> choose(const std::string& name, const std::string& value, const Choices& choices, Value& into) {
    if (const auto found = text::valueNamed(choices, value)) {
        into = *found;
        return std::monostate{};
    }
    return Error{ErrorCode::bad_message,
                 name + " must be " + text::alternatives(text::namesOf(choices)) + ", not " + text::inQuotes(value)};
}

Result<std::monostate> takeSize(const std::string& text, double& size) {
    const char* const end = text.data() + text.size();
    double value = 0;
    const auto [stopped, fault] = std::from_chars(text.data(), end, value);
    if (fault != std::errc{} || stopped != end || !(value >= exports::kMinSize && value <= exports::kMaxSize)) {
        return Error{ErrorCode::out_of_range,
                     "size must be a number of millimeters from " + text::shortestDecimal(exports::kMinSize) + " to " +
                         text::shortestDecimal(exports::kMaxSize) + ", not " + text::inQuotes(text)};
    }
    size = value;
    return std::monostate{};
}

// Returns the projection of the whole object as a slice, which takes the place of the focus slice. Uses the perspective
// projection if the picture shows none.
slicing::SliceSet projectionOf(const session::State& state, const slicing::SliceSet& slices) {
    const scene::ProjectionSettings& settings = state.look.projection;
    const bool parallel = settings.kind == scene::ProjectionKind::orthogonal;
    const double radius = slicing::infoOf(state.object).circumradius;
    slicing::SliceSet projected;
    std::vector<std::uint32_t> faceCells;
    slicing::Projector().project(
        state.object, state.orientation, slices,
        {.projection = {parallel ? 0 : 1 / (settings.eye * radius)}, .culled = !state.look.parts.back}, projected,
        faceCells);
    projected.planes = slices.planes;
    projected.rotatedVertices = slices.rotatedVertices;
    return projected;
}

// Returns whether the file contains the surfaces of a field.
bool needsSurfaces(const exports::ExportRequest& request) {
    if (request.extent == exports::Extent::projection || request.extent == exports::Extent::matrix) return false;
    return request.format->writeBodies != nullptr ? request.body == exports::Body::solid
                                                  : request.format->takesSurfaces;
}

}  // namespace

Result<std::string> exportState(const session::State& state, const exports::ExportRequest& request,
                                const exports::ExportLimits& limits, std::stop_token stop) {
    auto planes = state.hyperplanes();
    if (request.extent != exports::Extent::oval) planes = {state.slices.focus, 1, planes.spacing, planes.offset};
    const bool drawing = request.format->writeDrawing != nullptr;
    const bool isField = slicing::fieldIn(state.object) != nullptr;
    slicing::SliceSet slices;
    slicing::SurfaceDetail detail;
    if (isField && needsSurfaces(request)) {
        slicing::setEvenDetail(slicing::infoOf(state.object).circumradius, planes, slicing::Quality::file, detail);
        detail.secondValues = true;
    }
    slicing::Slicer().slice(state.object, state.orientation, planes, state.look.field, detail, slices);
    if (request.extent == exports::Extent::projection && !drawing) slices = projectionOf(state, slices);
    scene::Look look;
    if (drawing) {
        look = state.look;
        look.view = request.extent == exports::Extent::matrix ? scene::View::matrix : scene::View::single;
        if (look.projection.kind == scene::ProjectionKind::off)
            look.projection.kind = scene::ProjectionKind::perspective;
    }
    look.coloring = state.look.coloring;
    look.parts.coordinates = false;  // drawings have their own layout of the coordinates
    look.field = state.look.field;
    if (!drawing) look.parts.faces = isField;  // formats with bodies fill the faces of polytopes themselves
    scene::Scene scene;
    scene::Composer composer;
    composer.compose(state.object, state.orientation, slices, state.slices.focus, look, {}, scene);
    auto made = exports::exportScene(scene, state.object, state.orientation, request, limits, std::move(stop));
    if (auto* error = std::get_if<exports::ExportError>(&made)) {
        using Cause = exports::ExportError::Cause;
        const ErrorCode code = error->cause == Cause::no_body   ? ErrorCode::no_body
                               : error->cause == Cause::no_room ? ErrorCode::too_many
                                                                : ErrorCode::too_large;
        return Error{code, std::move(error->message)};
    }
    return std::get<std::string>(std::move(made));
}

Result<exports::ExportRequest> extractExportRequest(session::QueryParameters& query, const exports::Format& format) {
    exports::ExportRequest request = exports::requestFor(format);
    session::QueryParameters rest;
    for (auto& [name, value] : query) {
        Result<std::monostate> done = std::monostate{};
        if (name == "of") {
            done = choose(name, value, exports::kExtents, request.extent);
        } else if (name == "body") {
            done = choose(name, value, exports::kBodies, request.body);
        } else if (name == "label") {
            done = choose(name, value, exports::kLabels, request.label);
        } else if (name == "size") {
            done = takeSize(value, request.size);
        } else {
            rest.emplace_back(std::move(name), std::move(value));
        }
        if (!done) return done.error();
    }
    query = std::move(rest);
    return request;
}

std::string fileName(const session::State& state, const exports::ExportRequest& request) {
    std::string name;
    for (const char c : slicing::infoOf(state.object).name) {
        const bool plain = text::isDigit(c) || text::isLetter(c) || c == '-';
        name += plain ? c : '_';
    }
    return name + "." + request.format->name;
}

}  // namespace oval4d::pipeline
