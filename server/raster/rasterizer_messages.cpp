#include "raster/rasterizer_messages.hpp"

#include <stdexcept>

#include "serialization/byte_archive.hpp"
#include "slicing/object.hpp"

namespace oval4d::raster {

void encodeRequest(const session::State& state, scene::Viewport viewport, slicing::Quality quality,
                   const RasterizerLimits& limits, std::string& out) {
    out.clear();
    serialization::ByteWriter archive(out);
    archive(slicing::infoOf(state.source).serial), archive(slicing::infoOf(state.object).serial);
    archive(state.referenceFrame), archive(state.orientation.left()), archive(state.orientation.right());
    archive(state.slices), archive(state.look);
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
