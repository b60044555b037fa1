#include "session/picture.hpp"

#include <tuple>

namespace oval4d::session {

void writePictureRequest(const State& state, scene::Viewport viewport, slicing::Quality quality,
                         scene::PictureRequest& out) {
    // All members are named, so a new member of State makes this line fail to compile. Members that affect pictures
    // must be copied to the request. The angles of the rotation keys and the motion do not affect pictures.
    const auto& [source, frame, object, orientation, alpha, beta, step, slices, look, turning, lastTurn, ongoing,
                 playing, playsDownward, playSpeed] = state;
    auto& [outSource, outFrame, outObject, outOrientation, outPlanes, outFocus, outLook, outViewport, outQuality] = out;
    std::tie(outSource, outFrame, outObject, outOrientation, outPlanes, outFocus, outLook, outViewport, outQuality) =
        std::forward_as_tuple(source, frame, object, orientation, state.hyperplanes(), slices.focus, look, viewport,
                              quality);
}

scene::PictureRequest pictureRequestOf(const State& state, scene::Viewport viewport, slicing::Quality quality) {
    scene::PictureRequest picture;
    writePictureRequest(state, viewport, quality, picture);
    return picture;
}

}  // namespace oval4d::session
