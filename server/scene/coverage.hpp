#pragma once
// How much of what lies behind can still be seen, at samples of the picture: for leaving out what is covered.

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

namespace oval4d::scene {

/// Counts layers of convex polygons over a grid of samples. Keeps its memory between pictures.
class Coverage {
  public:
    /// Starts with nothing covered, in a rectangle of the picture. Samples are two pixels apart, in large pictures
    /// more.
    void begin(const glm::vec2& least, const glm::vec2& most);

    /// Lays a polygon over its samples, with this weight.
    void add(std::span<const glm::vec2> polygon, int weight);

    /// Whether every sample in the polygon, or if there is none the one next to its middle, has a weight of kCovered.
    bool covers(std::span<const glm::vec2> polygon) const;

    static constexpr int kCovered = 240;

  private:
    // A row of samples from `begin` to `end` − 1.
    struct Run {
        int row, begin, end;
    };
    template <typename Visit>
    bool allRuns(std::span<const glm::vec2> polygon, Visit&& visit) const;

    glm::vec2 origin_{0};
    float perPixel_ = 1;
    int columns_ = 0, rows_ = 0;
    std::vector<std::uint8_t> weights_;
};

}  // namespace oval4d::scene
