#pragma once
// Density plots, which replace the parallel coordinates of very many vertices: instead of the lines, a density plot
// shows the number of lines through each point (Inselberg, Parallel Coordinates, ch. 2; Artero et al., Uncovering
// Clusters in Crowded Parallel Coordinates).

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

namespace oval4d::scene {

/// A density plot of the parallel coordinates of many vertices: a grid of kRows × kColumns weights. Each vertex has a
/// line, which joins its values on neighboring axes; each weight measures how many of these lines pass through its
/// place in the grid (see kLineWeight). The axes x, y, z and w are at the columns 0, kGap, 2 kGap and 3 kGap. Row 0 is
/// at +circumradius, the last row at −circumradius. Reuses its memory between measurements.
class DensityPlot {
  public:
    static constexpr int kGap = 64;  ///< columns from one axis to the next
    static constexpr int kColumns = 3 * kGap + 1;
    static constexpr int kRows = 65;
    /// The weight of one line in one column. It is split between the two nearest rows by linear interpolation.
    static constexpr std::uint32_t kLineWeight = 4;

    /// Computes the density plot of the points turn · v for all v in `vertices`. Coordinates are clamped to
    /// ±circumradius.
    void measure(std::span<const glm::dvec4> vertices, const glm::dmat4& turn, double circumradius);

    /// Returns the weights, row by row. The sum of each column is kLineWeight times the number of vertices.
    std::span<const std::uint32_t> weights() const { return weights_; }

    /// Returns the square roots of the weights, row by row, scaled such that the largest is 255. The square root keeps
    /// small weights visible beside large ones.
    std::span<const std::uint8_t> tones() const { return tones_; }

    /// Returns the index in weights() and tones() of the entry in this row and column.
    static constexpr std::size_t index(int row, int column) {
        return static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column);
    }

  private:
    void countColumn(int column);

    std::array<std::vector<float>, 4> levels_;  // x, y, z and w of each vertex, in bins; a row is kLineWeight bins high
    std::vector<std::uint32_t> weights_;
    std::vector<std::uint8_t> tones_;
};

}  // namespace oval4d::scene
