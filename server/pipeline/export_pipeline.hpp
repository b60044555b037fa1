#pragma once

#include <stop_token>
#include <string>

#include "errors/error.hpp"
#include "export/export.hpp"
#include "scene/picture_request.hpp"

namespace oval4d::pipeline {

/// Exports to a file the part of a picture that `request.contents` selects (picture → slices → scene → file). The
/// viewport and the quality of the picture do not matter. Used by the server and the command line. Throws the
/// exceptions of exports::exportScene(), and std::runtime_error if the samples of a field are in a file that can no
/// longer be read. Errors:
/// - `no_body` if there is nothing to export, if no body has room for its label, or if the format cannot contain what
///   is requested,
/// - `too_large` if the slices have more than ExportLimits::sliceEdges edges, if the file exceeds another limit or
///   takes too long, or if `stop` is requested,
/// - `too_many` if ExportLimits::grantTotalBytes refuses memory for the file,
/// - `bad_message` if the request gives both `at` and `fit`, or gives one of them for contents other than
///   ExportContentsKind::oval,
/// - `out_of_range` if two values of w in `at` are equal, if one of them is farther than geometry::kMaxOffset
///   circumradii from the w of ObjectInfo::originInFile, if `fit` is less than 1, if `at` or `fit` asks for more than
///   ExportLimits::slices, or if the size of a body or a drawing is outside its bounds.
Result<exports::ExportedFile> exportFile(const scene::PictureRequest& picture, const exports::ExportRequest& request,
                                         const exports::ExportLimits& limits, std::stop_token stop = {});

/// Returns a suggested file name, such as "24-cell.stl". It is the name of the object and the name of the format. Each
/// byte of the object's name that is not an ASCII letter, a digit or - is replaced by _.
std::string exportFileName(const slicing::Object& object, const exports::ExportRequest& request);

}  // namespace oval4d::pipeline
