#pragma once
// The `slices` message: what a client needs to draw the picture, and nothing to compute.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/polytope.hpp"
#include "geometry/slicer.hpp"
#include "protocol/cpp/request.hpp"
#include "scene/scene.hpp"

namespace oval4d::protocol {

class CborWriter;
class JsonWriter;

/// A text with what it was written from, used again as long as that is the same.
template <typename From>
class Kept {
  public:
    /// `write(out)` writes the text of `from`.
    template <typename Write>
    std::string_view of(const From& from, Write write) {
        if (text_.empty() || from_ != from) {
            from_ = from;
            write(text_);
        }
        return text_;
    }

  private:
    From from_;
    std::string text_;
};

/// Writes `slices` messages one after the other. One writer serves one thread at a time.
class SlicesWriter {
  public:
    /// The message, JSON or CBOR (RFC 8949, typed arrays of RFC 8746), of slices that were cut from `polytope` and
    /// composed into `scene`. Overwrites `out`, reusing its memory.
    void write(const geometry::Polytope& polytope, const geometry::SliceSet& slices, const scene::Scene& scene,
               std::uint64_t revision, std::optional<double> id, Encoding encoding, std::string& out);

    /// What of a scene does not change as the polytope turns, but the stands.
    struct Setting {
        scene::View view{};
        scene::Parts shown;
        scene::Viewport viewport;
        scene::Camera camera;
        double scale = 0, circumradius = 0, ball = 0, bar = 0, opacity = 0;
        scene::AxesLayout axes;
        scene::CoordinatesLayout coordinates;
        bool operator==(const Setting&) const = default;
    };

  private:
    template <typename W>
    void writeMessage(W&& w, Kept<Setting>& kept, const geometry::Polytope& polytope, const geometry::SliceSet& slices,
                      const scene::Scene& scene, std::uint64_t revision, std::optional<double> id);
    void writeSlices(JsonWriter& w, const geometry::Polytope& polytope, const geometry::SliceSet& slices,
                     const scene::Scene& scene);
    void writeSlices(CborWriter& w, const geometry::Polytope& polytope, const geometry::SliceSet& slices,
                     const scene::Scene& scene);
    // How long the ranges are that begin so; the last one ends them.
    void writeSizes(CborWriter& w, std::string_view name, std::span<const std::uint32_t> begin);

    Kept<Setting> jsonSetting_, cborSetting_;
    std::vector<Kept<scene::Stand>> stands_;   // of JSON
    Kept<std::vector<scene::Stand>> columns_;  // of CBOR
    std::vector<std::uint32_t> sizes_;
};

}  // namespace oval4d::protocol
