#pragma once
// A slice that is not convex as shapes in painter's order.

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "render/slice_view.hpp"
#include "render/solids.hpp"

namespace oval4d::render {

/// Follows the tree of the scene's partition: the planes of the faces part space into regions, the bars are cut where
/// they pass from one to the next, and each region's are drawn from far to near, between the faces behind it and those
/// before it. What lies in a plane is drawn over it. Keeps its memory from one picture to the next.
class RegionPainter {
  public:
    void paint(const SliceView& slice, Solids& out);

  private:
    // A ball, or a part of a bar, in the slice's own axes; `from` is the end farther from the eye.
    struct Item {
        glm::dvec3 from, to;
        std::uint32_t element;
        bool ball, cut;  // cut: does not begin at a ball, but where another part ends
    };
    struct Work {
        const SliceView& slice;
        const Placing placing;
        const Frame frame;
        glm::dvec3 eye, forward;
        Solids& out;
    };

    void collect(const Work& work);
    void paintRegion(const Work& work, std::uint32_t number, std::size_t begin, std::size_t end);
    void part(const Item& item, double from, double to, double tiny, bool far);
    void paintPieces(const Work& work, std::uint32_t number);
    void paintItems(const Work& work, std::size_t begin, std::size_t end);

    std::vector<Item> items_;  // a stack of lists
    std::vector<glm::vec3> corners_;
};

}  // namespace oval4d::render
