#pragma once
// Density plots of parallel coordinates. A density plot replaces the lines of very many vertices: it shows how many
// lines pass through each point. See Inselberg, Parallel Coordinates, ch. 2, and Artero et al., Uncovering Clusters in
// Crowded Parallel Coordinates.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

namespace oval4d::scene {

/// A density plot of the parallel coordinates of many vertices: a grid of kRows × kColumns weights. Each vertex has a
/// line that joins its coordinates on neighboring axes. The weight of a place in the grid measures how many lines pass
/// through it (see kLineWeight). The axes x, y, z and w are at the columns 0, kGap, 2 kGap and 3 kGap. Row 0 is at
/// +circumradius, the last row at −circumradius. Reuses its memory between calls of compute().
class DensityPlot {
  public:
    static constexpr int kGap = 64;  ///< the number of columns from one axis to the next
    static constexpr int kColumns = 3 * kGap + 1;
    static constexpr int kRows = 65;
    /// The weight that one line adds to each column. The weight is split between the two nearest rows by linear
    /// interpolation.
    static constexpr std::uint32_t kLineWeight = 4;

    /// Computes the density plot of the points turn · v for all v in `vertices`. Clamps coordinates to ±circumradius.
    void compute(std::span<const glm::dvec4> vertices, const glm::dmat4& turn, double circumradius);

    /// Returns the weights, row by row. The sum of each column is kLineWeight times the number of vertices.
    std::span<const std::uint32_t> weights() const { return weights_; }

    /// Returns the square roots of the weights, row by row, scaled so that the largest is 255. A square root makes
    /// small weights visible beside large ones.
    std::span<const std::uint8_t> tones() const { return tones_; }

    /// Returns the index in weights() and tones() of the entry in row `row` and column `column`.
    static constexpr std::size_t index(int row, int column) {
        return static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column);
    }

  private:
    void countColumn(int column);

    // The x, y, z and w of all vertices, as numbers of bins from the origin. A row of the plot is kLineWeight bins
    // high.
    std::array<std::vector<float>, 4> levels_;
    std::vector<std::uint32_t> weights_;
    std::vector<std::uint8_t> tones_;
};

}  // namespace oval4d::scene
