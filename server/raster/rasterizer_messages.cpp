#include "raster/rasterizer_messages.hpp"

#include <stdexcept>

#include "serialization/byte_archive.hpp"
#include "slicing/object.hpp"

namespace oval4d::raster {

void encodeRequest(const session::State& state, scene::Viewport viewport, slicing::Quality quality,
                   const RasterizerLimits& limits, std::string& out) {
    out.clear();
    serialization::ByteWriter archive(out);
    // All members are named, so that this function does not compile without a new member. If the new member affects
    // pictures, it must be sent, too. The angles of the keys and the motion do not.
    const auto& [source, frame, object, orientation, alpha, beta, step, slices, look, turning, lastTurn, ongoing] =
        state;
    archive(slicing::infoOf(source).serial), archive(slicing::infoOf(object).serial);
    archive(frame), archive(orientation.left()), archive(orientation.right());
    archive(slices), archive(look);
    archive(viewport), archive(quality), archive(limits);
}

void decodeRequest(std::string_view bytes, DrawRequest& out) {
    serialization::ByteReader archive(bytes);
    glm::dquat left, right;
    archive(out.source), archive(out.object), archive(out.state.referenceFrame), archive(left), archive(right);
    archive(out.state.slices), archive(out.state.look);
    archive(out.viewport), archive(out.quality), archive(out.limits);
    const auto orientation = geometry::Rotation::fromQuaternions(left, right);
    if (!orientation) throw std::runtime_error("a draw request contains an invalid rotation");
    out.state.orientation = *orientation;
}

}  // namespace oval4d::raster
