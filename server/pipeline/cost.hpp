#pragma once
// Estimates how long it takes to make a picture or a file.

#include <chrono>

#include "export/export_request.hpp"
#include "scene/picture_request.hpp"
#include "slicing/object.hpp"

namespace oval4d::pipeline {

/// An estimated time in seconds, correct within a factor of three on one core of a processor of 2020. The estimate
/// depends on the object, the number of slices, the size of the picture and the quality. Of the object, the number of
/// elements counts; of a field, the time to evaluate its function.
using EstimatedSeconds = std::chrono::duration<double>;

/// Returns the estimated time of Pipeline::drawPng() for this picture.
EstimatedSeconds frameCost(const scene::PictureRequest& picture);

/// Returns the estimated time of Pipeline::slice() and Pipeline::writeSlices() together for this picture.
EstimatedSeconds geometryCost(const scene::PictureRequest& picture);

/// Returns the estimated time of Pipeline::describePoint() for this picture.
EstimatedSeconds pointDescriptionCost(const scene::PictureRequest& picture);

/// Returns the estimated time of slicing::sampleField() if `object` is a field.
EstimatedSeconds sampleCost(const slicing::Object& object);

/// Returns the estimated time of Pipeline::nameFocusSection() for this object.
EstimatedSeconds focusSectionCost(const slicing::Object& object);

/// Returns the estimated time of exportFile() for this picture and request.
EstimatedSeconds exportCost(const scene::PictureRequest& picture, const exports::ExportRequest& request);

}  // namespace oval4d::pipeline
