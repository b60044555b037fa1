#include "scene/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace oval4d::scene {

void Coverage::begin(const glm::vec2& least, const glm::vec2& most) {
    constexpr float kPixels = 2, kMostSamples = 320;
    const float widest = std::max({most.x - least.x, most.y - least.y, 1.0f});
    perPixel_ = std::min(1 / kPixels, kMostSamples / widest);
    origin_ = least;
    columns_ = static_cast<int>((most.x - least.x) * perPixel_) + 1;
    rows_ = static_cast<int>((most.y - least.y) * perPixel_) + 1;
    weights_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0);
}

// Visits the rows of samples in a polygon until visit() says no; true if it never did.
template <typename Visit>
bool Coverage::allRuns(std::span<const glm::vec2> polygon, Visit&& visit) const {
    const auto place = [this](const glm::vec2& p) { return (p - origin_) * perPixel_; };
    float lowest = std::numeric_limits<float>::max(), highest = -lowest;
    for (const glm::vec2& p : polygon) {
        const float y = place(p).y;
        lowest = std::min(lowest, y);
        highest = std::max(highest, y);
    }
    const int first = std::max(0, static_cast<int>(std::ceil(lowest)));
    const int last = std::min(rows_ - 1, static_cast<int>(std::floor(highest)));
    for (int row = first; row <= last; ++row) {
        const auto y = static_cast<float>(row);
        float left = std::numeric_limits<float>::max(), right = -left;
        glm::vec2 a = place(polygon.back());
        for (const glm::vec2& corner : polygon) {
            const glm::vec2 b = place(corner);
            if ((a.y <= y) != (b.y <= y)) {
                const float x = a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
                left = std::min(left, x);
                right = std::max(right, x);
            }
            a = b;
        }
        const int begin = std::max(0, static_cast<int>(std::ceil(std::min(left, static_cast<float>(columns_)))));
        const int end = std::min(columns_, static_cast<int>(std::floor(std::max(right, -1.0f))) + 1);
        if (begin < end && !visit(Run{row, begin, end})) return false;
    }
    return true;
}

void Coverage::add(std::span<const glm::vec2> polygon, int weight) {
    allRuns(polygon, [&](const Run& run) {
        std::uint8_t* samples = &weights_[static_cast<std::size_t>(run.row) * static_cast<std::size_t>(columns_)];
        for (int i = run.begin; i < run.end; ++i)
            samples[i] = static_cast<std::uint8_t>(std::min(samples[i] + weight, kCovered));
        return true;
    });
}

bool Coverage::covers(std::span<const glm::vec2> polygon) const {
    bool any = false;
    const bool covered = allRuns(polygon, [&](const Run& run) {
        any = true;
        const std::uint8_t* samples = &weights_[static_cast<std::size_t>(run.row) * static_cast<std::size_t>(columns_)];
        return std::all_of(samples + run.begin, samples + run.end, [](std::uint8_t w) { return w >= kCovered; });
    });
    if (any) return covered;
    glm::vec2 middle(0);
    for (const glm::vec2& p : polygon) middle += p;
    const glm::vec2 at = (middle / static_cast<float>(polygon.size()) - origin_) * perPixel_;
    const int column = std::clamp(static_cast<int>(std::lround(at.x)), 0, columns_ - 1);
    const int row = std::clamp(static_cast<int>(std::lround(at.y)), 0, rows_ - 1);
    return weights_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(column)] >= kCovered;
}

}  // namespace oval4d::scene
