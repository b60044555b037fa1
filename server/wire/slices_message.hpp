#pragma once
// Writes the `slices` message. The message contains everything that a client needs to draw the picture. The client need
// not compute slices, colors or positions.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "scene/scene.hpp"
#include "slicing/surface_detail.hpp"
#include "wire/cached_text.hpp"
#include "wire/request.hpp"
#include "wire/slice_list.hpp"

namespace oval4d::wire {

/// A writer of `slices` messages. Caches the parts that stay the same from one message to the next. Only one thread at
/// a time may use a writer.
class SlicesMessageWriter {
  public:
    /// Writes the message for a scene. Overwrites `out` and reuses its memory.
    void write(const scene::Scene& scene, std::uint64_t revision, std::optional<double> id, Encoding encoding,
               std::string& out, slicing::Quality quality = slicing::Quality::full);

    /// The values of a scene that stay the same while the object turns. Placements of slices are not included, although
    /// they also stay the same, because SliceListWriter caches their texts.
    struct StaticScene {
        scene::View view{};
        scene::ShownParts shown;
        scene::Viewport viewport;
        scene::Camera camera;
        /// `ball`, `bar` and `opacity` are Scene::ballRadius, Scene::barRadius and Scene::faceOpacity.
        double scale = 0, circumradius = 0, ball = 0, bar = 0, opacity = 0;
        scene::AxesSymbolLayout axes;
        scene::ParallelCoordinatesLayout coordinates;
        bool operator==(const StaticScene&) const = default;
    };

  private:
    // The cached texts of those parts of a message that rarely change, in one encoding.
    struct CachedTexts {
        CachedText<StaticScene> staticScene;  // an encoded object, whose members become members of `scene`
        PlacementTexts placements;
    };

    template <typename W>
    void writeMessage(W&& w, CachedTexts& texts, const scene::Scene& scene, std::uint64_t revision,
                      std::optional<double> id, slicing::Quality quality);
    template <typename W>
    void writeProjection(W& w, const scene::Scene& scene);
    template <typename W>
    void writeMatrix(W& w, const scene::Scene& scene);

    std::array<CachedTexts, kEncodings.size()> texts_;  // one entry for each Encoding
    SliceListWriter list_;
};

}  // namespace oval4d::wire
