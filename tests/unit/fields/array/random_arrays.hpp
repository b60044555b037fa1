#pragma once
// Random samples and points for the tests of array fields.

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "fields/array/array_function.hpp"

namespace oval4d::fields::test {

/// Returns samples of f at the points of a lattice that fills the box. x varies fastest, and w slowest.
inline std::vector<float> sampled(const Shape& shape, const Box& box, const std::function<double(glm::dvec4)>& f) {
    std::vector<float> samples;
    std::array<std::size_t, 4> at{};
    for (at[3] = 0; at[3] < shape[3]; ++at[3]) {
        for (at[2] = 0; at[2] < shape[2]; ++at[2]) {
            for (at[1] = 0; at[1] < shape[1]; ++at[1]) {
                for (at[0] = 0; at[0] < shape[0]; ++at[0]) {
                    glm::dvec4 point{};
                    for (std::size_t i = 0; i < 4; ++i) {
                        const auto axis = static_cast<glm::length_t>(i);
                        const double part =
                            shape[i] == 1 ? 0 : static_cast<double>(at[i]) / static_cast<double>(shape[i] - 1);
                        point[axis] = box.min[axis] + part * (box.max[axis] - box.min[axis]);
                    }
                    samples.push_back(static_cast<float>(f(point)));
                }
            }
        }
    }
    return samples;
}

/// Points as arrays of coordinates, and arrays for the values and gradients of a function at these points.
struct Points {
    std::vector<float> x, y, z, w, values, dx, dy, dz, dw;

    void add(const glm::dvec4& point) {
        x.push_back(static_cast<float>(point.x));
        y.push_back(static_cast<float>(point.y));
        z.push_back(static_cast<float>(point.z));
        w.push_back(static_cast<float>(point.w));
        for (auto* const each : {&values, &dx, &dy, &dz, &dw}) each->push_back(-12345);
    }
    glm::dvec4 operator[](std::size_t i) const { return {x[i], y[i], z[i], w[i]}; }
    std::size_t size() const { return x.size(); }
    PointBatch batch() const { return {x, y, z, w}; }
    GradientBatch gradients() { return {dx, dy, dz, dw}; }
    glm::dvec4 gradient(std::size_t i) const { return {dx[i], dy[i], dz[i], dw[i]}; }
};

/// Returns `count` random points, uniformly distributed in the box.
inline Points randomPoints(const Box& box, std::size_t count, std::mt19937& random) {
    std::uniform_real_distribution<double> part(0, 1);
    Points points;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec4 t(part(random), part(random), part(random), part(random));
        points.add(box.min + t * (box.max - box.min));
    }
    return points;
}

/// Returns f at one point.
inline float valueAt(const ScalarFunction& f, const glm::dvec4& point) {
    Points one;
    one.add(point);
    f.evaluate(one.batch(), one.values);
    return one.values.front();
}

/// Returns random samples from −1 to 1. The fraction `missing` (0 … 1) of them, on average, is NaN or infinite, that
/// is, missing.
inline std::vector<float> randomSamples(const Shape& shape, double missing, std::mt19937& random) {
    std::uniform_real_distribution<float> value(-1, 1);
    std::uniform_real_distribution<double> part(0, 1);
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    const std::array<float, 3> none{std::numeric_limits<float>::quiet_NaN(), kInfinite, -kInfinite};
    std::vector<float> samples(sampleCount(shape));
    for (float& each : samples) {
        each = value(random);
        if (part(random) < missing) each = none.at(static_cast<std::size_t>(part(random) * 2.999));
    }
    return samples;
}

}  // namespace oval4d::fields::test
