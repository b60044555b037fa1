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

using wire::Stream;

SharedBytes Snapshot::stateTextFor(scene::Scheme scheme) const {
    const std::lock_guard lock(textsMutex_);
    SharedBytes& text = texts_.at(static_cast<std::size_t>(scheme));
    if (text.size() == 0) text = SharedBytes(wire::stateMessage(state, section.names, revision, {}, quality, scheme));
    return text;
}

SharedBytes Snapshot::stateTextFor(scene::Scheme scheme, std::optional<double> id) const {
    if (!id) return stateTextFor(scheme);
    return SharedBytes(wire::stateMessage(state, section.names, revision, id, quality, scheme));
}

SnapshotPtr makeSnapshot(pipeline::Pipeline& pipeline, const session::State& state, std::uint64_t revision,
                         std::chrono::steady_clock::time_point changed, const StreamKey& key,
                         slicing::Quality quality) {
    auto made = std::make_shared<Snapshot>();
    made->state = state;
    made->revision = revision;
    made->changed = changed;
    made->quality = quality;
    const scene::PictureRequest picture = session::pictureOf(state, key.viewport, quality);
    made->sliced = key.stream != Stream::frames;
    if (made->sliced) pipeline.slice(picture, made->slices);
    made->section = pipeline.nameFocusSection(picture, made->sliced ? &made->slices : nullptr);
    return made;
}

SnapshotPtr makeStateSnapshot(const session::State& state, std::uint64_t revision,
                              std::chrono::steady_clock::time_point changed, const slicing::NamedSection& section) {
    auto made = std::make_shared<Snapshot>();
    made->state = state;
    made->revision = revision;
    made->changed = changed;
    made->section = section;
    return made;
}

bool suffices(const SnapshotPtr& snapshot, const StreamKey& key) {
    return snapshot && (snapshot->sliced || key.stream == wire::Stream::frames);
}

OutgoingMessage makePicture(pipeline::Pipeline& pipeline, const Snapshot& snapshot, const StreamKey& key,
                            std::optional<double> id, const std::function<void()>& whenDrawn) {
    const auto applyOverrides = [&key](scene::Look& look) {
        if (key.background) look.background = *key.background;
        if (key.highlight) look.highlight = *key.highlight;
    };
    scene::PictureRequest picture = session::pictureOf(snapshot.state, key.viewport, snapshot.quality);
    applyOverrides(picture.look);
    using scene::Background;
    if (key.scheme == scene::Scheme::light && picture.look.background == Background::automatic)
        picture.look.background = Background::light;
    if (key.stream == Stream::frames) {
        SharedBytes stateText;  // the state stored in the PNG file; unlike `picture`, keeps the background `automatic`
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

Seconds pictureCost(const session::State& state, const StreamKey& key, slicing::Quality quality) {
    const scene::PictureRequest picture = session::pictureOf(state, key.viewport, quality);
    return key.stream == Stream::frames ? pipeline::frameCost(picture) : pipeline::geometryCost(picture);
}

}  // namespace oval4d::net
