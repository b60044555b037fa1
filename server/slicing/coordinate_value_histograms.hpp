#pragma once
// The distribution of a field's values along the axes x, y, z and w.

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

/// Four two-dimensional histograms of a rotated field, one for each of the axes x, y, z and w. Each shows how much of
/// the domain has a given coordinate along the axis and a given value. The histograms form one table with kRows rows
/// and kColumns columns, which has a panel of kPanel columns for each axis. The first and the last column of a panel
/// stand for the ends of the domain; the first row stands for the greatest value of range(), and the last row for the
/// least.
///
/// The domain is sampled at quasirandom points (see fields::writeQuasirandomPoints()). The function is not evaluated
/// again while only the rotation or the levels change. Reuses its memory between measurements.
class CoordinateValueHistograms {
  public:
    static constexpr int kPanel = 64;  ///< the number of columns for each axis
    static constexpr int kColumns = 4 * kPanel;
    static constexpr int kRows = 65;
    /// The weight that a point adds to each panel. The weight is divided between the two columns between which the
    /// point lies.
    static constexpr std::uint32_t kPointWeight = 4;
    /// Limits on the number of points. Functions that take longer to evaluate are evaluated at fewer points.
    static constexpr std::size_t kMaxPoints = std::size_t{1} << 17, kMinPoints = std::size_t{1} << 14;

    using Range = fields::ValueRange;

    /// Computes the histograms of a field rotated by `orientation`. After this call, range() includes those `levels`
    /// that lie between the least and the greatest value of the field at the sampled points.
    void measure(const fields::Field& field, const geometry::Rotation& orientation, std::span<const double> levels);

    /// Returns the interval of values that the rows represent. It contains the values at the points except outliers,
    /// such as values near a pole; it is extended to levels that lie among the outliers. Values outside the interval
    /// are not counted.
    Range range() const { return range_; }

    /// Returns half the extent of the rotated domain along each axis, in the object's units. Along an axis, the domain
    /// extends from −reach, in the first column of the panel, to +reach, in the last column.
    const std::array<double, 4>& reach() const { return reach_; }

    /// Returns the number of points whose values are in range(). The sum of each panel's weights is kPointWeight times
    /// this number.
    std::size_t countedPoints() const { return countedPoints_; }

    /// Returns the weights, row by row.
    std::span<const std::uint32_t> weights() const { return weights_; }

    /// Returns the cube roots of the weights, row by row, scaled so that the largest is 255. The cube root keeps rare
    /// values visible beside common ones.
    std::span<const std::uint8_t> tones() const { return tones_; }

    /// Returns the index in weights() and tones() of the entry in this row, and in this column of the axis's panel.
    /// `axis` is 0 … 3 for x, y, z, w.
    static constexpr std::size_t index(int row, int axis, int column) {
        return static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(axis * kPanel + column);
    }

  private:
    void sample(const fields::Field& field);
    void chooseRange(std::span<const double> levels);
    void assignRows();
    void count(const fields::Field& field, const geometry::Rotation& orientation);
    void findTones();

    std::weak_ptr<const fields::ScalarFunction> function_;  // the function that was sampled on box_
    fields::Box box_;
    std::vector<float> values_;       // per point: the function's value; NaN where it has none
    Range fullRange_, typicalRange_;  // the ranges of all values, and of the values without outliers
    Range range_;
    std::vector<std::uint8_t> rowOf_;  // per point: the row of its value; 255 outside range_
    std::size_t countedPoints_ = 0;
    std::array<double, 4> reach_{};
    std::vector<std::uint32_t> weights_;
    std::vector<std::uint8_t> tones_;
};

}  // namespace oval4d::slicing
