#pragma once
// Encodes and decodes messages between the server and its rasterizer processes (which draw pictures).

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "scene/picture_request.hpp"
#include "slicing/occlusion.hpp"

namespace oval4d::raster {

/// Limits on the work and the memory of a rasterizer process, which draws pictures for the server.
struct RasterizerLimits {
    std::size_t fillSteps = 0;  ///< the maximum number of steps for filling faces in one picture (see
                                ///< slicing::FaceFiller::fill())
    /// The maximum size of the process's cache of objects, in bytes; the object drawn last stays in the cache even if
    /// it is larger.
    std::size_t objectBytes = 0;
    /// The maximum number of steps for finding hidden elements in one picture (see
    /// slicing::OcclusionFinder::findDrawnElements()).
    std::size_t occlusionSteps = slicing::OcclusionFinder::kDefaultSteps;
};

/// A request to draw one picture.
struct DrawRequest {
    /// The serial number of the object scene::PictureRequest::source. The object itself is sent in a separate message,
    /// and only if the rasterizer process does not have the object in its cache.
    std::uint64_t source = 0;
    /// The serial number of scene::PictureRequest::object. This object is never sent: the rasterizer process makes it
    /// from the source object and the frame of reference.
    std::uint64_t object = 0;
    scene::PictureRequest picture;  ///< the picture to draw; its objects are not sent
    RasterizerLimits limits;
};

/// Encodes a request to draw `picture` within `limits`. Overwrites `out`.
void encodeDrawRequest(const scene::PictureRequest& picture, const RasterizerLimits& limits, std::string& out);
/// Decodes a draw request from the bytes that encodeDrawRequest() wrote. Overwrites the members of `out`, except the
/// objects in `out.picture`, which are not sent. Throws std::runtime_error if bytes are missing or damaged, or if the
/// orientation is not a rotation.
void decodeDrawRequest(std::string_view bytes, DrawRequest& out);

}  // namespace oval4d::raster
