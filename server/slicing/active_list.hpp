#pragma once
// The active list of a sweep: the elements that the rising hyperplane cuts.

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace oval4d::slicing {

/// Elements of one dimension, each cut by the hyperplanes from … to − 1. They are sorted once by their first
/// hyperplane; then the list of active elements, those that are cut, follows the hyperplane as it rises. Whether an
/// element is cut is unpredictable, and a mispredicted branch costs more than the work that it saves, so the loops are
/// branch-free. Reuses its memory.
class ActiveList {
  public:
    struct Element {
        std::uint32_t number;
        std::int32_t to;
    };

    /// Removes all elements and makes room for `elements` new ones.
    void clear(std::size_t elements, int planes) {
        added_.resize(elements + 1);
        end_.assign(planes + 1, 0);
        count_ = activeCount_ = begun_ = 0;
    }
    /// Adds an element with from ≤ to. An element with from = to is never cut.
    void add(std::uint32_t number, std::int32_t from, std::int32_t to) {
        const std::uint32_t one = from < to ? 1 : 0;
        added_[count_] = {{number, to}, from};
        end_[from] += one;
        count_ += one;
    }
    /// Sorts the elements. To be called once all are added. `steps`: in ascending order, the hyperplanes at which
    /// elements begin, and possibly others.
    void sort(std::span<const int> steps);

    /// Advances to a step; to be called for all steps in order. Returns the elements that begin there.
    std::span<const Element> advance(int step);
    /// Returns the elements that the current hyperplane cuts.
    std::span<const Element> active() const { return {active_.data(), activeCount_}; }
    std::uint32_t size() const { return activeCount_; }

  private:
    struct Added {
        Element element;
        std::int32_t from;
    };
    std::vector<Added> added_;
    std::vector<Element> sorted_, active_;
    std::vector<std::uint32_t> end_;  // by hyperplane: how many elements begin there; once sorted, where these end
    std::uint32_t count_ = 0, activeCount_ = 0, begun_ = 0;
};

inline void ActiveList::sort(std::span<const int> steps) {
    sorted_.resize(count_);
    active_.resize(count_);
    std::uint32_t* end = end_.data();
    std::uint32_t total = 0;
    for (const int step : steps) total += std::exchange(end[step], total);
    for (const Added& added : std::span(added_.data(), count_)) sorted_[end[added.from]++] = added.element;
}

inline std::span<const ActiveList::Element> ActiveList::advance(int step) {
    Element* active = active_.data();
    Element* kept = active;
    for (const Element *at = active, *end = active + activeCount_; at != end; ++at) {
        const std::int32_t to = at->to;
        *kept = *at;
        kept += to > step ? 1 : 0;
    }
    const std::span begun(sorted_.data() + begun_, end_[step] - begun_);
    begun_ = end_[step];
    for (const Element& element : begun) *kept++ = element;
    activeCount_ = static_cast<std::uint32_t>(kept - active);
    return begun;
}

}  // namespace oval4d::slicing
