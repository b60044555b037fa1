#include "net/live/snapshot.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/cost.hpp"
#include "wire/state_message.hpp"

namespace oval4d::net {

using wire::Stream;

SharedBytes Snapshot::stateTextFor(scene::Scheme scheme) const {
    const std::lock_guard lock(textsMutex_);
    SharedBytes& text = texts_.at(static_cast<std::size_t>(scheme));
    if (text.size() == 0) text = SharedBytes(wire::stateMessage(state, section, revision, {}, quality, scheme));
    return text;
}

SharedBytes Snapshot::stateTextFor(scene::Scheme scheme, std::optional<double> id) const {
    if (!id) return stateTextFor(scheme);
    return SharedBytes(wire::stateMessage(state, section, revision, id, quality, scheme));
}

SnapshotPtr makeSnapshot(pipeline::Pipeline& pipeline, const session::State& state, std::uint64_t revision,
                         std::chrono::steady_clock::time_point changed, const StreamKey& key,
                         slicing::Quality quality) {
    auto made = std::make_shared<Snapshot>();
    made->state = state;
    made->revision = revision;
    made->changed = changed;
    made->quality = quality;
    made->section = pipeline.nameFocusSection(state);
    made->sliced = key.stream != Stream::frames;
    if (made->sliced) pipeline.slice(state, quality, made->slices);
    return made;
}

SnapshotPtr makeStateSnapshot(const session::State& state, std::uint64_t revision,
                              std::chrono::steady_clock::time_point changed, const slicing::SectionNamePair& section) {
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
    using scene::Background;
    session::State state = snapshot.state;
    if (key.background) state.look.background = *key.background;
    if (key.highlight) state.look.highlight = *key.highlight;
    SharedBytes stateText;  // to store in the PNG file; unlike `state` below, keeps the background `automatic`
    if (key.stream == Stream::frames) {
        stateText = key.background || key.highlight
                        ? SharedBytes(wire::stateMessage(state, snapshot.section, snapshot.revision, {},
                                                         snapshot.quality, key.scheme))
                        : snapshot.stateTextFor(key.scheme);
    }
    const bool isLight = key.scheme == scene::Scheme::light;
    if (isLight && state.look.background == Background::automatic) state.look.background = Background::light;
    if (key.stream == Stream::frames) {
        std::vector<std::uint8_t> png;
        pipeline.drawPng(state, stateText.view(), key.viewport, snapshot.quality, png, whenDrawn);
        return {SharedBytes(std::move(png)), true};
    }
    std::string text;
    pipeline.writeSlices(state, snapshot.slices, snapshot.revision, id, key.viewport, key.encoding, text,
                         snapshot.quality);
    return {SharedBytes(std::move(text)), key.encoding != wire::Encoding::json};
}

Seconds pictureCost(const session::State& state, const StreamKey& key, slicing::Quality quality) {
    return key.stream == Stream::frames ? pipeline::frameCost(state, key.viewport, quality)
                                        : pipeline::geometryCost(state, quality);
}

}  // namespace oval4d::net
