#include "polytopes/construction/diagram.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace oval4d::polytopes {

namespace {

MirrorSet mirrorBit(int mirror) { return 1U << static_cast<unsigned>(mirror); }

// Returns the mirrors of `set` that can be reached from the mirrors in both `start` and `set`, along branches between
// mirrors of `set`. The result includes the mirrors in both sets.
MirrorSet connectedTo(const CoxeterDiagram& diagram, MirrorSet start, MirrorSet set) {
    MirrorSet reached = start & set;
    for (int sweep = 0; sweep < kMirrors; ++sweep) {
        for (int i = 0; i < kMirrors; ++i) {
            for (int j = 0; j < kMirrors; ++j) {
                if (i != j && containsMirror(reached, i) && containsMirror(set, j) &&
                    diagram.branches[i][j].numerator != 2)
                    reached |= mirrorBit(j);
            }
        }
    }
    return reached;
}

MirrorSet ringedMirrors(const CoxeterDiagram& diagram) {
    MirrorSet rings = 0;
    for (int i = 0; i < kMirrors; ++i) rings |= diagram.ringed.at(i) ? mirrorBit(i) : 0U;
    return rings;
}

// Returns the branches of a connected component that is a chain, in order from the end with the smaller mirror number.
// Returns an empty list if the component is a single mirror or not a chain.
std::vector<DiagramBranch> branchesAlong(const CoxeterDiagram& diagram, MirrorSet component) {
    const auto neighbors = [&](int i, MirrorSet among) {
        std::vector<int> found;
        for (int j = 0; j < kMirrors; ++j) {
            if (j != i && containsMirror(among, j) && diagram.branches[i][j].numerator != 2) found.push_back(j);
        }
        return found;
    };
    for (int end = 0; end < kMirrors; ++end) {
        if (!containsMirror(component, end) || neighbors(end, component).size() > 1) continue;
        std::vector<DiagramBranch> chain;
        MirrorSet left = component & ~mirrorBit(end);
        int at = end;
        for (auto next = neighbors(at, left); next.size() == 1; next = neighbors(at, left)) {
            chain.push_back(diagram.branches[at][next[0]]);
            at = next[0];
            left &= ~mirrorBit(at);
        }
        if (left == 0) return chain;
    }
    return {};
}

// A finite Coxeter group of three or four mirrors whose diagram is a chain: the branches of the chain, and the order of
// the group.
struct FiniteCoxeterGroup {
    std::vector<DiagramBranch> chain;
    std::uint64_t order;
};
const std::vector<FiniteCoxeterGroup>& finiteCoxeterGroups() {
    constexpr DiagramBranch three{3, 1};
    constexpr DiagramBranch four{4, 1};
    constexpr DiagramBranch five{5, 1};
    constexpr DiagramBranch star{5, 2};
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
std::uint64_t groupOrderOfComponent(const CoxeterDiagram& diagram, MirrorSet component) {
    constexpr std::uint64_t kD4 = 192;
    std::vector<DiagramBranch> chain = branchesAlong(diagram, component);
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
        for (const FiniteCoxeterGroup& group : finiteCoxeterGroups()) {
            if (group.chain == chain) return group.order;
        }
        std::reverse(chain.begin(), chain.end());
    }
    return 0;
}

}  // namespace

CoxeterDiagram CoxeterDiagram::linear(DiagramBranch p, DiagramBranch q, DiagramBranch r, std::array<bool, 4> ringed) {
    CoxeterDiagram diagram;
    diagram.ringed = ringed;
    const auto join = [&](int i, DiagramBranch b) { diagram.branches[i][i + 1] = diagram.branches[i + 1][i] = b; };
    join(0, p);
    join(1, q);
    join(2, r);
    return diagram;
}

CoxeterDiagram permuted(const CoxeterDiagram& diagram, const MirrorPermutation& from) {
    CoxeterDiagram result;
    for (int i = 0; i < kMirrors; ++i) {
        result.ringed.at(i) = diagram.ringed.at(from.at(i));
        for (int j = 0; j < kMirrors; ++j) {
            if (i != j) result.branches[i][j] = diagram.branches[from.at(i)][from.at(j)];
        }
    }
    return result;
}

std::vector<MirrorPermutation> automorphismsOf(const CoxeterDiagram& diagram) {
    std::vector<MirrorPermutation> symmetries;
    MirrorPermutation order{0, 1, 2, 3};
    do {
        if (permuted(diagram, order) == permuted(diagram, {0, 1, 2, 3})) symmetries.push_back(order);
    } while (std::next_permutation(order.begin(), order.end()));
    return symmetries;
}

CoxeterDiagram canonical(const CoxeterDiagram& diagram) {
    MirrorPermutation order{0, 1, 2, 3};
    CoxeterDiagram least = permuted(diagram, order);
    while (std::next_permutation(order.begin(), order.end())) least = std::min(least, permuted(diagram, order));
    return least;
}

std::vector<MirrorSet> componentsOf(const CoxeterDiagram& diagram, MirrorSet set) {
    std::vector<MirrorSet> components;
    for (int i = 0; i < kMirrors; ++i) {
        if (!containsMirror(set, i)) continue;
        components.push_back(connectedTo(diagram, mirrorBit(i), set));
        set &= ~components.back();
    }
    return components;
}

bool generatesElement(const CoxeterDiagram& diagram, MirrorSet set) {
    return connectedTo(diagram, ringedMirrors(diagram), set) == set;
}

std::uint64_t groupOrder(const CoxeterDiagram& diagram, MirrorSet set) {
    std::uint64_t order = 1;
    for (const MirrorSet component : componentsOf(diagram, set)) order *= groupOrderOfComponent(diagram, component);
    return order;
}

MirrorSet stabilizerOf(const CoxeterDiagram& diagram, MirrorSet set) {
    const MirrorSet taken = ringedMirrors(diagram) | set;
    MirrorSet stabilizer = set;
    for (int i = 0; i < kMirrors; ++i) {
        if (!containsMirror(taken, i) && connectedTo(diagram, mirrorBit(i), set | mirrorBit(i)) == mirrorBit(i))
            stabilizer |= mirrorBit(i);
    }
    return stabilizer;
}

ElementCounts elementCounts(const CoxeterDiagram& diagram) {
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
