#include "session/picture.hpp"

#include <tuple>

namespace oval4d::session {

void writePicture(const State& state, scene::Viewport viewport, slicing::Quality quality, scene::PictureRequest& out) {
    // All members are named, so that this function does not compile without a new member. If the new member affects
    // pictures, it must be in the request, too. The angles of the keys and the motion do not.
    const auto& [source, frame, object, orientation, alpha, beta, step, slices, look, turning, lastTurn, ongoing,
                 playing, playsDownward, playSpeed] = state;
    auto& [outSource, outFrame, outObject, outOrientation, outPlanes, outFocus, outLook, outViewport, outQuality] = out;
    std::tie(outSource, outFrame, outObject, outOrientation, outPlanes, outFocus, outLook, outViewport, outQuality) =
        std::forward_as_tuple(source, frame, object, orientation, state.hyperplanes(), slices.focus, look, viewport,
                              quality);
}

scene::PictureRequest pictureOf(const State& state, scene::Viewport viewport, slicing::Quality quality) {
    scene::PictureRequest picture;
    writePicture(state, viewport, quality, picture);
    return picture;
}

}  // namespace oval4d::session
