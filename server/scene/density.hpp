#pragma once
// The parallel coordinates of very many vertices: not each vertex's line, but how many lines pass where (density plots
// as in Inselberg, Parallel Coordinates, ch. 2, and Artero et al., Uncovering Clusters in Crowded Parallel
// Coordinates).

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

namespace oval4d::scene {

/// The axes x, y, z and w stand in the columns 0, kGap, 2 kGap and 3 kGap; a vertex is a line from its value on one to
/// its value on the next. Row 0 is at +circumradius, the last one at −circumradius. Keeps its memory.
class Density {
  public:
    static constexpr int kGap = 64;
    static constexpr int kColumns = 3 * kGap + 1;
    static constexpr int kRows = 65;
    /// What a line weighs in each column, shared by the two rows between which it passes.
    static constexpr std::uint32_t kLine = 4;

    /// Of the vertices turned by `turn`, which lie within the circumradius of the origin, or count as at its distance.
    void measure(std::span<const glm::dvec4> vertices, const glm::dmat4& turn, double circumradius);

    /// Row by row. Each column adds up to kLine times the number of vertices.
    std::span<const std::uint32_t> weights() const { return weights_; }

    /// Row by row, 0 … 255: the square root of the weight, so that the few are seen beside the many; 255 is the
    /// largest.
    std::span<const std::uint8_t> tones() const { return tones_; }

    static constexpr std::size_t index(int row, int column) {
        return static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column);
    }

  private:
    void countColumn(int column);

    std::array<std::vector<float>, 4> levels_;  // of x, y, z, w of each vertex, in steps: a row is kLine of them
    std::vector<std::uint32_t> weights_;
    std::vector<std::uint8_t> tones_;
};

}  // namespace oval4d::scene
