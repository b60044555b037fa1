#pragma once
// Estimates of the time that it takes to make a picture or a file.

#include <chrono>

#include "export/export_request.hpp"
#include "scene/scene.hpp"
#include "session/session.hpp"

namespace oval4d::pipeline {

/// An estimated time in seconds, correct within a factor of three on one core of a processor of 2020. Depends on the
/// number of elements of the object (for a field, on the cost of its function), the number of slices, the size of the
/// picture and the quality.
using EstimatedSeconds = std::chrono::duration<double>;

/// Returns the estimated time of Pipeline::drawPng().
EstimatedSeconds frameCost(const session::State& state, scene::Viewport viewport, slicing::Quality quality);

/// Returns the estimated time of Pipeline::slice() and Pipeline::writeSlices() together.
EstimatedSeconds geometryCost(const session::State& state, slicing::Quality quality);

/// Returns the estimated time of Pipeline::describePoint().
EstimatedSeconds pointCost(const session::State& state);

/// Returns the estimated time of slicing::sampleField() for the state's field.
EstimatedSeconds sampleCost(const session::State& state);

/// Returns the estimated time of Pipeline::nameFocusSection().
EstimatedSeconds focusSectionCost(const session::State& state);

/// Returns the estimated time of exportState().
EstimatedSeconds exportCost(const session::State& state, const exports::ExportRequest& request);

}  // namespace oval4d::pipeline
