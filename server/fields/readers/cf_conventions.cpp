#include "fields/readers/cf_conventions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "text/message_text.hpp"

namespace oval4d::fields {

namespace {

std::string lowercase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return text;
}

template <std::size_t Size>
bool isOneOf(std::string_view text, const std::array<std::string_view, Size>& names) {
    return std::find(names.begin(), names.end(), text) != names.end();
}

}  // namespace

std::optional<std::size_t> cfAxis(const CfDimension& dimension) {
    static constexpr std::array<std::string_view, 6> kEast{"degrees_east", "degree_east", "degree_e",
                                                           "degrees_e",    "degreee",     "degreese"};
    static constexpr std::array<std::string_view, 6> kNorth{"degrees_north", "degree_north", "degree_n",
                                                            "degrees_n",     "degreen",      "degreesn"};
    static constexpr std::array<std::string_view, 6> kX{
        "longitude", "grid_longitude", "projection_x_coordinate", "projection_x_angular_coordinate", "lon", "x"};
    static constexpr std::array<std::string_view, 6> kY{
        "latitude", "grid_latitude", "projection_y_coordinate", "projection_y_angular_coordinate", "lat", "y"};
    static constexpr std::array<std::string_view, 12> kZ{
        "height",    "depth", "altitude", "air_pressure", "model_level_number",
        "level",     "lev",   "plev",     "pressure",     "height_above_mean_sea_level",
        "elevation", "z"};
    static constexpr std::array<std::string_view, 3> kTime{"time", "t", "w"};
    const std::string axis = lowercase(dimension.axis), units = lowercase(dimension.units);
    if (axis.size() == 1 && std::string_view("xyzt").find(axis) != std::string_view::npos)
        return std::string_view("xyzt").find(axis);
    if (isOneOf(units, kEast)) return 0;
    if (isOneOf(units, kNorth)) return 1;
    if (units.find(" since ") != std::string::npos) return 3;
    for (const std::string& name : {lowercase(dimension.standardName), lowercase(dimension.name)}) {
        if (isOneOf(name, kX)) return 0;
        if (isOneOf(name, kY)) return 1;
        if (isOneOf(name, kZ)) return 2;
        if (isOneOf(name, kTime)) return 3;
    }
    if (!dimension.positive.empty()) return 2;
    return {};
}

std::vector<std::size_t> axisOfEachDimension(std::span<const CfDimension> dimensions) {
    constexpr std::size_t kNone = 4;
    std::vector<std::size_t> axes;
    std::array<bool, kNone> taken{};
    for (const CfDimension& each : dimensions) {
        const std::size_t axis = cfAxis(each).value_or(kNone);
        const bool free = axis != kNone && !taken.at(axis);
        if (free) taken.at(axis) = true;
        axes.push_back(free ? axis : kNone);
    }
    for (std::size_t i = axes.size(); i-- > 0;) {
        if (axes[i] != kNone) continue;
        axes[i] = static_cast<std::size_t>(std::find(taken.begin(), taken.end(), false) - taken.begin());
        taken.at(axes[i]) = true;
    }
    return axes;
}

std::optional<FirstAndLastCoordinate> endsOfCoordinates(std::span<const double> at, const std::string& name,
                                                        std::vector<std::string>& warnings) {
    constexpr double kUnevenness = 1e-3;  // the accepted deviation from even spacing, in mean distances between
                                          // coordinates
    const double step = at.size() > 1 ? (at.back() - at.front()) / static_cast<double>(at.size() - 1) : 1;
    double largest = 0;  // the largest deviation of a coordinate from even spacing, in mean distances
    bool monotone = std::isfinite(step) && step != 0 && std::isfinite(at.front());
    for (std::size_t i = 1; i < at.size() && monotone; ++i) {
        monotone = (at[i] - at[i - 1]) * step > 0;
        largest = std::max(largest, std::abs((at[i] - at.front()) / step - static_cast<double>(i)));
    }
    if (!monotone) {
        warnings.push_back("the coordinates of " + text::inQuotes(name) + " are not monotonic and are ignored");
        return {};
    }
    if (largest > kUnevenness) {
        warnings.push_back("the coordinates of " + text::inQuotes(name) +
                           " are not evenly spaced; the array is shown as if they were");
    }
    return FirstAndLastCoordinate{at.front(), at.back()};
}

void subtractLeastCoordinateIfFar(FirstAndLastCoordinate& ends, std::size_t count, const std::string& name,
                                  std::string& unit, std::vector<std::string>& warnings) {
    constexpr double kClose = 2e-5;  // makeField() rejects boxes whose size is less than this times their distance from
                                     // 0
    if (count < 2) return;
    const double step = std::abs(ends.last - ends.first) / static_cast<double>(count - 1);
    if (!(step < kClose * std::max(std::abs(ends.first), std::abs(ends.last)))) return;
    const double least = std::min(ends.first, ends.last);
    warnings.push_back("the coordinates of " + text::inQuotes(name) + " are counted from the least of them, " +
                       text::shortestDecimal(least) + (unit.empty() ? "" : " " + unit) +
                       ": they are too close to each other for their distance from 0");
    ends = {ends.first - least, ends.last - least};
    unit.resize(std::min(unit.find(" since "), unit.size()));
}

}  // namespace oval4d::fields
