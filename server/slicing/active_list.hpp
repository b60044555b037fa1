#pragma once
// The active list of a sweep through parallel hyperplanes: the elements of a polytope (its edges, 2-faces or cells)
// that the current hyperplane cuts.

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace oval4d::slicing {

/// Lists the elements of a polytope (its edges, its 2-faces or its cells) that the current hyperplane cuts, while a
/// caller steps through parallel hyperplanes. The hyperplanes are numbered from 0 by ascending w. Each element is cut
/// by the hyperplanes of one range of indices [from, to). Call clear(), then add() for each element, then
/// sortByFirstHyperplane() once, then advanceTo() for the hyperplanes in ascending order. Reuses its memory.
///
/// The loops of this class do not branch on whether an element is cut. Processors cannot predict such a branch, and a
/// misprediction takes longer than the work that the branch would avoid.
class ActiveElementList {
  public:
    /// An element, and the index of the first hyperplane that no longer cuts it, because it lies above the element.
    struct CutElement {
        std::uint32_t number;  ///< the index of the edge, 2-face or cell in the polytope
        std::int32_t to;  ///< the end of the range [from, to) of the indices of the hyperplanes that cut the element
    };

    /// Removes all elements. Makes room for up to `elements` new elements, and for hyperplanes with the indices 0 …
    /// `planes` − 1.
    void clear(std::size_t elements, int planes) {
        unsorted_.resize(elements + 1);
        end_.assign(planes + 1, 0);
        count_ = activeCount_ = begun_ = 0;
    }
    /// Adds an element that the hyperplanes with the indices in [from, to) cut. Requires from ≤ to. Ignores the element
    /// if from = to.
    void add(std::uint32_t number, std::int32_t from, std::int32_t to) {
        const std::uint32_t one = from < to ? 1 : 0;
        unsorted_[count_] = {{number, to}, from};
        end_[from] += one;
        count_ += one;
    }
    /// Sorts the elements by the first hyperplane that cuts them. Must be called once, after all calls of add().
    /// `steps` lists the indices of the hyperplanes for which advanceTo() will be called, in ascending order. `steps`
    /// must include the first hyperplane of every element.
    void sortByFirstHyperplane(std::span<const int> steps);

    /// Makes the hyperplane with the index `step` the current one. Must be called for each index that was passed to
    /// sortByFirstHyperplane(), in ascending order. Returns the elements for which `step` is the first hyperplane that
    /// cuts them.
    std::span<const CutElement> advanceTo(int step);
    /// Returns the elements that the current hyperplane cuts.
    std::span<const CutElement> activeElements() const { return {active_.data(), activeCount_}; }
    /// Returns the number of elements that the current hyperplane cuts.
    std::uint32_t size() const { return activeCount_; }

  private:
    struct UnsortedElement {
        CutElement element;
        std::int32_t from;
    };

    // Removes the active elements that the hyperplane with the index `step` no longer cuts: those whose range [from,
    // to) ends at `step` or below.
    void removeEnded(int step);

    std::vector<UnsortedElement> unsorted_;
    std::vector<CutElement> sorted_, active_;
    // Per hyperplane, before sortByFirstHyperplane(): the number of elements whose range of hyperplanes begins here.
    // Afterward: the index in sorted_ just after the last of these elements.
    std::vector<std::uint32_t> end_;
    // count_: the number of elements that were added. activeCount_: the number of elements that the current hyperplane
    // cuts. begun_: the number of elements that have become active since sortByFirstHyperplane().
    std::uint32_t count_ = 0, activeCount_ = 0, begun_ = 0;
};

inline void ActiveElementList::sortByFirstHyperplane(std::span<const int> steps) {
    sorted_.resize(count_);
    active_.resize(count_);
    std::uint32_t* end = end_.data();
    std::uint32_t total = 0;
    for (const int step : steps) total += std::exchange(end[step], total);
    for (const UnsortedElement& unsorted : std::span(unsorted_.data(), count_))
        sorted_[end[unsorted.from]++] = unsorted.element;
}

inline void ActiveElementList::removeEnded(int step) {
    CutElement* kept = active_.data();
    for (const CutElement& element : activeElements()) {
        const std::int32_t to = element.to;
        *kept = element;
        kept += to > step ? 1 : 0;
    }
    activeCount_ = static_cast<std::uint32_t>(kept - active_.data());
}

inline std::span<const ActiveElementList::CutElement> ActiveElementList::advanceTo(int step) {
    removeEnded(step);
    const std::span begun(sorted_.data() + begun_, end_[step] - begun_);
    begun_ = end_[step];
    CutElement* added = active_.data() + activeCount_;
    for (const CutElement& element : begun) *added++ = element;
    activeCount_ += static_cast<std::uint32_t>(begun.size());
    return begun;
}

}  // namespace oval4d::slicing
