#include "raster/rasterizer_messages.hpp"

#include <stdexcept>

#include "serialization/byte_archive.hpp"

namespace oval4d::raster {

namespace {

// Writes or reads the members of a request, except the objects and the orientation. All members are named here. So if a
// member is added to the request, this function does not compile until it handles the member.
void archiveMembers(auto& picture, auto& archive) {
    auto& [source, frame, object, orientation, planes, focus, look, viewport, quality] = picture;
    archive(frame), archive(planes), archive(focus), archive(look), archive(viewport), archive(quality);
}

}  // namespace

void encodeDrawRequest(const scene::PictureRequest& picture, const RasterizerLimits& limits, std::string& out) {
    out.clear();
    serialization::ByteWriter archive(out);
    archive(slicing::infoOf(picture.source).serial), archive(slicing::infoOf(picture.object).serial);
    archive(picture.orientation.leftQuaternion()), archive(picture.orientation.rightQuaternion());
    archiveMembers(picture, archive);
    archive(limits);
}

void decodeDrawRequest(std::string_view bytes, DrawRequest& out) {
    serialization::ByteReader archive(bytes);
    glm::dquat left, right;
    archive(out.source), archive(out.object);
    archive(left), archive(right);
    archiveMembers(out.picture, archive);
    archive(out.limits);
    const auto orientation = geometry::Rotation::fromQuaternions(left, right);
    if (!orientation) throw std::runtime_error("a draw request contains an invalid rotation");
    out.picture.orientation = *orientation;
}

}  // namespace oval4d::raster
