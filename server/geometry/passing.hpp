#pragma once
// Which elements a hyperplane cuts while it rises.

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace oval4d::geometry {

/// Elements of one kind, each of which the hyperplanes from … to − 1 cut. They are sorted by where that begins, once;
/// then a list of those that are cut follows the hyperplane as it rises. Whether an element is cut is as good as
/// random, and a branch on it costs more than the work that it saves: so there is none. Keeps its memory.
class Passing {
  public:
    struct Element {
        std::uint32_t number;
        std::int32_t to;
    };

    /// Forgets all, for at most so many elements to come.
    void clear(std::size_t elements, int planes) {
        found_.resize(elements + 1);
        end_.assign(planes + 1, 0);
        count_ = cutCount_ = begun_ = 0;
    }
    /// from ≤ to; one with from = to is not cut.
    void add(std::uint32_t number, std::int32_t from, std::int32_t to) {
        const std::uint32_t one = from < to ? 1 : 0;
        found_[count_] = {{number, to}, from};
        end_[from] += one;
        count_ += one;
    }
    /// Once all are added. `steps`: the hyperplanes that elements begin with, rising, and maybe others.
    void sort(std::span<const int> steps);

    /// To one of the steps after the other. Returns what begins there.
    std::span<const Element> rise(int step);
    /// What the hyperplane cuts.
    std::span<const Element> cut() const { return {cut_.data(), cutCount_}; }
    std::uint32_t size() const { return cutCount_; }

  private:
    struct Found {
        Element element;
        std::int32_t from;
    };
    std::vector<Found> found_;
    std::vector<Element> sorted_, cut_;
    std::vector<std::uint32_t> end_;  // by hyperplane: how many begin with it; once sorted, where these end
    std::uint32_t count_ = 0, cutCount_ = 0, begun_ = 0;
};

inline void Passing::sort(std::span<const int> steps) {
    sorted_.resize(count_);
    cut_.resize(count_);
    std::uint32_t* end = end_.data();
    std::uint32_t total = 0;
    for (const int step : steps) total += std::exchange(end[step], total);
    for (const Found& found : std::span(found_.data(), count_)) sorted_[end[found.from]++] = found.element;
}

inline std::span<const Passing::Element> Passing::rise(int step) {
    Element* cut = cut_.data();
    Element* kept = cut;
    for (const Element *at = cut, *end = cut + cutCount_; at != end; ++at) {
        const std::int32_t to = at->to;
        *kept = *at;
        kept += to > step ? 1 : 0;
    }
    const std::span begun(sorted_.data() + begun_, end_[step] - begun_);
    begun_ = end_[step];
    for (const Element& element : begun) *kept++ = element;
    cutCount_ = static_cast<std::uint32_t>(kept - cut);
    return begun;
}

}  // namespace oval4d::geometry
