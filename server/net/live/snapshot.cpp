#include "net/live/snapshot.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/cost.hpp"
#include "session/picture.hpp"
#include "wire/state_message.hpp"

namespace oval4d::net {

using wire::StreamKind;

SharedBytes SessionSnapshot::stateTextFor(scene::ColorScheme scheme) const {
    const std::lock_guard lock(textsMutex_);
    SharedBytes& text = texts_.at(static_cast<std::size_t>(scheme));
    if (text.size() == 0) text = SharedBytes(wire::stateMessage(state, section.names, revision, {}, quality, scheme));
    return text;
}

SharedBytes SessionSnapshot::stateTextFor(scene::ColorScheme scheme, std::optional<double> id) const {
    if (!id) return stateTextFor(scheme);
    return SharedBytes(wire::stateMessage(state, section.names, revision, id, quality, scheme));
}

SessionSnapshotPtr makeSnapshot(pipeline::Pipeline& pipeline, const session::State& state, std::uint64_t revision,
                                std::chrono::steady_clock::time_point changed, const PictureStreamKey& key,
                                slicing::Quality quality) {
    auto made = std::make_shared<SessionSnapshot>();
    made->state = state;
    made->revision = revision;
    made->changed = changed;
    made->quality = quality;
    const scene::PictureRequest picture = session::pictureRequestOf(state, key.viewport, quality);
    made->sliced = key.stream != StreamKind::frames;
    if (made->sliced) pipeline.slice(picture, made->slices);
    made->section = pipeline.nameFocusSection(picture, made->sliced ? &made->slices : nullptr);
    return made;
}

SessionSnapshotPtr makeStateSnapshot(const session::State& state, std::uint64_t revision,
                                     std::chrono::steady_clock::time_point changed,
                                     const slicing::NamedSection& section) {
    auto made = std::make_shared<SessionSnapshot>();
    made->state = state;
    made->revision = revision;
    made->changed = changed;
    made->section = section;
    return made;
}

bool isSufficientFor(const SessionSnapshotPtr& snapshot, const PictureStreamKey& key) {
    return snapshot && (snapshot->sliced || key.stream == wire::StreamKind::frames);
}

OutgoingMessage makePicture(pipeline::Pipeline& pipeline, const SessionSnapshot& snapshot, const PictureStreamKey& key,
                            std::optional<double> id, const std::function<void()>& whenDrawn) {
    const auto applyOverrides = [&key](scene::Look& look) {
        if (key.background) look.background = *key.background;
        if (key.highlight) look.highlight = *key.highlight;
    };
    scene::PictureRequest picture = session::pictureRequestOf(snapshot.state, key.viewport, snapshot.quality);
    applyOverrides(picture.look);
    using scene::Background;
    if (key.scheme == scene::ColorScheme::light && picture.look.background == Background::automatic)
        picture.look.background = Background::light;
    if (key.stream == StreamKind::frames) {
        SharedBytes stateText;  // the `state` message in the PNG file, in which a background `automatic` stays so
        if (key.background || key.highlight) {
            session::State state = snapshot.state;
            applyOverrides(state.look);
            stateText = SharedBytes(
                wire::stateMessage(state, snapshot.section.names, snapshot.revision, {}, snapshot.quality, key.scheme));
        } else {
            stateText = snapshot.stateTextFor(key.scheme);
        }
        std::vector<std::uint8_t> png;
        pipeline.drawPng(picture, stateText.view(), png, whenDrawn);
        return {SharedBytes(std::move(png)), true};
    }
    std::string text;
    pipeline.writeSlices(picture, snapshot.slices, snapshot.revision, id, key.encoding, text);
    return {SharedBytes(std::move(text)), key.encoding != wire::Encoding::json};
}

Seconds pictureCost(const session::State& state, const PictureStreamKey& key, slicing::Quality quality) {
    const scene::PictureRequest picture = session::pictureRequestOf(state, key.viewport, quality);
    return key.stream == StreamKind::frames ? pipeline::frameCost(picture) : pipeline::geometryCost(picture);
}

}  // namespace oval4d::net
