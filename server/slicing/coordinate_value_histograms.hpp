#pragma once
// Histograms that show how a field's values are distributed along each of the axes x, y, z and w.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

#include "fields/scalar_function.hpp"
#include "fields/value_range.hpp"
#include "geometry/rotation.hpp"

namespace oval4d::fields {
struct Field;
}

namespace oval4d::slicing {

/// Four two-dimensional histograms of a rotated field, one for each of the axes x, y, z and w. Each histogram shows how
/// much of the domain has a given coordinate along the axis and a given value of the field. The histograms form one
/// table with kRows rows and kColumns columns. The table has a panel of kPanel columns for each axis. The first and the
/// last column of a panel stand for the ends of the domain. The first row stands for the greatest value of
/// valueRange(), and the last row for the least.
///
/// The field is sampled at quasirandom points of the domain (see fields::writeQuasirandomPoints()). While only the
/// rotation or the levels change, its function is not evaluated again. Reuses its memory between calls of compute().
class CoordinateValueHistograms {
  public:
    static constexpr int kPanel = 64;  ///< the number of columns for each axis
    static constexpr int kColumns = 4 * kPanel;
    static constexpr int kRows = 65;
    /// The weight that each sampled point adds to the panel of each axis. The weight is divided between the two columns
    /// between which the point lies.
    static constexpr std::uint32_t kPointWeight = 4;
    /// The limits on the number of sampled points. Functions that take longer to evaluate are evaluated at fewer
    /// points.
    static constexpr std::size_t kMaxPoints = std::size_t{1} << 17, kMinPoints = std::size_t{1} << 14;

    using Range = fields::ValueRange;

    /// Computes the histograms of a field rotated by `orientation`. After this call, valueRange() includes those
    /// `levels` that lie between the least and the greatest value of the field at the sampled points.
    void compute(const fields::Field& field, const geometry::Rotation& orientation, std::span<const double> levels);

    /// Returns the interval of values that the rows represent. The interval contains the values at the sampled points
    /// except outliers, such as values near a pole. It is extended to levels that lie among the outliers. Values
    /// outside the interval are not counted.
    Range valueRange() const { return range_; }

    /// Returns, for each axis, half the extent of the rotated domain, in the object's units. Along the axis, the domain
    /// extends from −reach, in the first column of the panel, to +reach, in the last column.
    const std::array<double, 4>& reach() const { return reach_; }

    /// Returns the number of sampled points whose values are in valueRange(). In each panel, the sum of the weights is
    /// kPointWeight times this number.
    std::size_t countedPoints() const { return countedPoints_; }

    /// Returns the weights of all table entries, row by row.
    std::span<const std::uint32_t> weights() const { return weights_; }

    /// Returns the cube roots of the weights, row by row, scaled so that the largest is 255. A cube root makes rare
    /// values visible beside common ones.
    std::span<const std::uint8_t> tones() const { return tones_; }

    /// Returns the index in weights() and tones() of an entry of the table. The entry is in row `row`, and in column
    /// `column` of the panel of `axis` (0 … 3 for x, y, z, w).
    static constexpr std::size_t index(int row, int axis, int column) {
        return static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(axis * kPanel + column);
    }

  private:
    void sampleField(const fields::Field& field);
    void chooseRange(std::span<const double> levels);
    void assignPointsToRows();
    void countValues(const fields::Field& field, const geometry::Rotation& orientation);
    void computeTones();

    std::weak_ptr<const fields::ScalarFunction> function_;  // the function whose values on box_ are in values_
    fields::Box box_;
    std::vector<float> values_;       // per sampled point: the function's value; NaN if it has none
    Range fullRange_, typicalRange_;  // the range of all values, and the range of the values without outliers
    Range range_;
    std::vector<std::uint8_t> rowOf_;  // per sampled point: the row of its value; 255 if the value is outside range_
    std::size_t countedPoints_ = 0;
    std::array<double, 4> reach_{};
    std::vector<std::uint32_t> weights_;
    std::vector<std::uint8_t> tones_;
};

}  // namespace oval4d::slicing
