#pragma once
// Estimates of the time that it takes to make a picture or a file.

#include <chrono>

#include "export/export_request.hpp"
#include "scene/picture_request.hpp"
#include "slicing/object.hpp"

namespace oval4d::pipeline {

/// An estimated time in seconds, correct within a factor of three on one core of a processor of 2020. Depends on the
/// number of elements of the object (for a field, on the cost of its function), the number of slices, the size of the
/// picture and the quality.
using EstimatedSeconds = std::chrono::duration<double>;

/// Returns the estimated time of Pipeline::drawPng().
EstimatedSeconds frameCost(const scene::PictureRequest& picture);

/// Returns the estimated time of Pipeline::slice() and Pipeline::writeSlices() together.
EstimatedSeconds geometryCost(const scene::PictureRequest& picture);

/// Returns the estimated time of Pipeline::describePoint().
EstimatedSeconds pointCost(const scene::PictureRequest& picture);

/// Returns the estimated time of slicing::sampleField() for a field.
EstimatedSeconds sampleCost(const slicing::Object& object);

/// Returns the estimated time of Pipeline::nameFocusSection().
EstimatedSeconds focusSectionCost(const slicing::Object& object);

/// Returns the estimated time of exportFile().
EstimatedSeconds exportCost(const scene::PictureRequest& picture, const exports::ExportRequest& request);

}  // namespace oval4d::pipeline
