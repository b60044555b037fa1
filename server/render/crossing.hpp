#pragma once
// Slices whose shapes may cross each other: hidden from each other by depth.

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "render/slice_view.hpp"
#include "render/solids.hpp"

namespace oval4d::render {

/// For slices that need not be convex. Keeps its memory from one picture to the next.
class CrossingPainter {
  public:
    /// Opaque faces, from near to far. Then balls and bars from far to near, so that their edges fade into what is
    /// behind them. At last what is faded, from far to near by its middles; it hides nothing.
    struct Layers {
        Solids faces, frame, faded;
        Range depths;  ///< in which all of it lies
    };

    /// Shows all slices that are drawn, with the scene's fill, as seen through its camera.
    void paint(const geometry::Polytope& polytope, const geometry::SliceSet& slices, const scene::Scene& scene,
               Layers& out);

  private:
    enum class Kind : std::uint8_t { ball, bar, patch };
    struct Item {
        float depth;
        Kind kind;
        std::uint32_t slice, number;  // of a patch the fill's number, else the slice's own
    };

    void collect(const SliceView& slice, Range& depths);
    void add(const Item& item, scene::Presence presence);
    void paintItem(const SliceView& slice, const Item& item, const Frame& frame, Solids& out);
    void paintPatch(const SliceView& slice, std::uint32_t number, Solids& out);

    std::vector<Placing> placings_;            // of the slices
    std::vector<glm::vec3> points_, corners_;  // in view axes
    std::vector<Item> faces_, frame_, faded_;
};

}  // namespace oval4d::render
