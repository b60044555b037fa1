#include "polytopes/construction/diagram.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace oval4d::polytopes {

namespace {

MirrorSet bit(int mirror) { return 1U << static_cast<unsigned>(mirror); }

// Returns the mirrors of `set` that are connected, by branches between mirrors of `set`, to a mirror in both `start`
// and `set`. The mirrors in both sets are included.
MirrorSet connectedTo(const Diagram& diagram, MirrorSet start, MirrorSet set) {
    MirrorSet reached = start & set;
    for (int sweep = 0; sweep < kMirrors; ++sweep) {
        for (int i = 0; i < kMirrors; ++i) {
            for (int j = 0; j < kMirrors; ++j) {
                if (i != j && holds(reached, i) && holds(set, j) && diagram.branches[i][j].numerator != 2)
                    reached |= bit(j);
            }
        }
    }
    return reached;
}

MirrorSet ringsOf(const Diagram& diagram) {
    MirrorSet rings = 0;
    for (int i = 0; i < kMirrors; ++i) rings |= diagram.ringed.at(i) ? bit(i) : 0U;
    return rings;
}

// Returns the branches of a connected component that is a chain, in order from the end with the smaller mirror number.
// Returns an empty list if the component is a single mirror or not a chain.
std::vector<Branch> branchesAlong(const Diagram& diagram, MirrorSet component) {
    const auto neighbors = [&](int i, MirrorSet among) {
        std::vector<int> found;
        for (int j = 0; j < kMirrors; ++j) {
            if (j != i && holds(among, j) && diagram.branches[i][j].numerator != 2) found.push_back(j);
        }
        return found;
    };
    for (int end = 0; end < kMirrors; ++end) {
        if (!holds(component, end) || neighbors(end, component).size() > 1) continue;
        std::vector<Branch> chain;
        MirrorSet left = component & ~bit(end);
        int at = end;
        for (auto next = neighbors(at, left); next.size() == 1; next = neighbors(at, left)) {
            chain.push_back(diagram.branches[at][next[0]]);
            at = next[0];
            left &= ~bit(at);
        }
        if (left == 0) return chain;
    }
    return {};
}

// A finite Coxeter group of three or four mirrors whose diagram is a chain: the branches of the chain, and the order of
// the group.
struct FiniteCoxeterGroup {
    std::vector<Branch> chain;
    std::uint64_t order;
};
const std::vector<FiniteCoxeterGroup>& finiteGroups() {
    constexpr Branch three{3, 1};
    constexpr Branch four{4, 1};
    constexpr Branch five{5, 1};
    constexpr Branch star{5, 2};
    static const std::vector<FiniteCoxeterGroup> kGroups{
        {{three, three}, 24},          {{three, four}, 48},          {{three, five}, 120},
        {{three, star}, 120},          {{star, five}, 120},          {{three, three, three}, 120},
        {{three, three, four}, 384},   {{three, four, three}, 1152}, {{three, three, five}, 14400},
        {{three, three, star}, 14400}, {{three, five, star}, 14400}, {{three, star, five}, 14400},
        {{five, three, star}, 14400},  {{five, star, five}, 14400},  {{star, five, star}, 14400},
    };
    return kGroups;
}

// Returns the order of the Coxeter group of a connected component; 0 if the group is not finite.
std::uint64_t orderOfComponent(const Diagram& diagram, MirrorSet component) {
    constexpr std::uint64_t kD4 = 192;
    std::vector<Branch> chain = branchesAlong(diagram, component);
    if (std::popcount(component) == 1) return 2;
    if (std::popcount(component) == 2) return 2 * static_cast<std::uint64_t>(chain.at(0).numerator);
    if (chain.empty()) {
        for (int i = 0; i < kMirrors; ++i) {
            for (int j = 0; j < i; ++j) {
                if (diagram.branches[i][j].numerator > 3) return 0;
            }
        }
        return component == 0xf ? kD4 : 0;
    }
    for (int turn = 0; turn < 2; ++turn) {
        for (const FiniteCoxeterGroup& group : finiteGroups()) {
            if (group.chain == chain) return group.order;
        }
        std::reverse(chain.begin(), chain.end());
    }
    return 0;
}

}  // namespace

Diagram Diagram::linear(Branch p, Branch q, Branch r, std::array<bool, 4> ringed) {
    Diagram diagram;
    diagram.ringed = ringed;
    const auto join = [&](int i, Branch b) { diagram.branches[i][i + 1] = diagram.branches[i + 1][i] = b; };
    join(0, p);
    join(1, q);
    join(2, r);
    return diagram;
}

Diagram permuted(const Diagram& diagram, const Permutation& from) {
    Diagram result;
    for (int i = 0; i < kMirrors; ++i) {
        result.ringed.at(i) = diagram.ringed.at(from.at(i));
        for (int j = 0; j < kMirrors; ++j) {
            if (i != j) result.branches[i][j] = diagram.branches[from.at(i)][from.at(j)];
        }
    }
    return result;
}

std::vector<Permutation> automorphismsOf(const Diagram& diagram) {
    std::vector<Permutation> symmetries;
    Permutation order{0, 1, 2, 3};
    do {
        if (permuted(diagram, order) == permuted(diagram, {0, 1, 2, 3})) symmetries.push_back(order);
    } while (std::next_permutation(order.begin(), order.end()));
    return symmetries;
}

Diagram canonical(const Diagram& diagram) {
    Permutation order{0, 1, 2, 3};
    Diagram least = permuted(diagram, order);
    while (std::next_permutation(order.begin(), order.end())) least = std::min(least, permuted(diagram, order));
    return least;
}

std::vector<MirrorSet> componentsOf(const Diagram& diagram, MirrorSet set) {
    std::vector<MirrorSet> components;
    for (int i = 0; i < kMirrors; ++i) {
        if (!holds(set, i)) continue;
        components.push_back(connectedTo(diagram, bit(i), set));
        set &= ~components.back();
    }
    return components;
}

bool generatesElement(const Diagram& diagram, MirrorSet set) {
    return connectedTo(diagram, ringsOf(diagram), set) == set;
}

std::uint64_t groupOrder(const Diagram& diagram, MirrorSet set) {
    std::uint64_t order = 1;
    for (const MirrorSet component : componentsOf(diagram, set)) order *= orderOfComponent(diagram, component);
    return order;
}

MirrorSet stabilizerOf(const Diagram& diagram, MirrorSet set) {
    const MirrorSet taken = ringsOf(diagram) | set;
    MirrorSet stabilizer = set;
    for (int i = 0; i < kMirrors; ++i) {
        if (!holds(taken, i) && connectedTo(diagram, bit(i), set | bit(i)) == bit(i)) stabilizer |= bit(i);
    }
    return stabilizer;
}

ElementCounts elementCounts(const Diagram& diagram) {
    const std::uint64_t all = groupOrder(diagram);
    std::array<std::uint64_t, 4> counts{};
    for (MirrorSet set = 0; set < 0xf; ++set) {
        if (!generatesElement(diagram, set)) continue;
        counts.at(static_cast<std::size_t>(std::popcount(set))) +=
            all / groupOrder(diagram, stabilizerOf(diagram, set));
    }
    return {counts[0], counts[1], counts[2], counts[3]};
}

}  // namespace oval4d::polytopes
