#include "polytopes/construction/diagram_text.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <numeric>

namespace oval4d::polytopes {

namespace {

using Reason = PolytopeNameError::Reason;

constexpr int kMaxNumber = 1'000'000;  // the largest number that a text may contain; with a larger one, a polytope
                                       // would be too large anyway

bool isDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

// Reads a text from left to right; `rest` is the part that has not been read.
struct TextScanner {
    std::string_view rest;

    bool take(std::string_view token) {
        if (!rest.starts_with(token)) return false;
        rest.remove_prefix(token.size());
        return true;
    }
    bool skipBlanks() {
        const std::size_t blanks = std::min(rest.find_first_not_of(" \t"), rest.size());
        rest.remove_prefix(blanks);
        return blanks > 0;
    }
    std::optional<int> number() {
        int value = 0;
        const auto [end, fault] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
        if (fault != std::errc{} || !isDigit(rest.front()) || value > kMaxNumber) return {};
        rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
        return value;
    }
    std::optional<DiagramBranch> branch() {
        DiagramBranch b;
        const auto numerator = number();
        if (!numerator) return {};
        b.numerator = *numerator;
        if (take("/")) {
            const auto denominator = number();
            if (!denominator) return {};
            b.denominator = *denominator;
        }
        const bool sound = b.denominator == 1 ? b.numerator >= 2
                                              : b.denominator > 1 && 2 * b.denominator < b.numerator &&
                                                    std::gcd(b.numerator, b.denominator) == 1;
        return sound ? std::optional(b) : std::nullopt;
    }
};

PolytopeNameError badBranchError() {
    return PolytopeNameError::impossible(
        "a branch number must be a whole number of at least 2, or a fraction in lowest terms greater than 2, such as "
        "5/2");
}

// Builds a diagram from its nodes in order, and from the branches of each node to earlier nodes. A diagram has four
// mirrors; nodes after the fourth are only counted, and make checkedDiagram() return an error.
class DiagramBuilder {
  public:
    int nodes = 0;
    CoxeterDiagram diagram;

    void addNode(bool ringed) {
        if (nodes < kMirrors) diagram.ringed.at(nodes) = ringed;
        ++nodes;
    }
    void addBranch(int a, int b, DiagramBranch branch) {
        if (a < kMirrors && b < kMirrors) diagram.branches[a][b] = diagram.branches[b][a] = branch;
    }

    std::variant<CoxeterDiagram, PolytopeNameError> checkedDiagram(std::string_view text) const {
        if (nodes != kMirrors) {
            return PolytopeNameError::impossible("the diagram of a polychoron has four nodes, as in x5o3o3x, not " +
                                                 std::to_string(nodes));
        }
        if (groupOrder(diagram) == 0) {
            return PolytopeNameError::impossible(
                "the mirrors of " + std::string(text) +
                " do not generate a finite group; each connected component must be the diagram of a "
                "regular or star polygon, polyhedron or polychoron, or D4, x3o3o *b3o");
        }
        if (!generatesElement(diagram, 0xf)) {
            return PolytopeNameError::impossible("every connected component of " + std::string(text) +
                                                 " needs a ringed node, x");
        }
        for (int i = 0; i < kMirrors; ++i) {
            for (int j = 0; j < i; ++j) {
                const DiagramBranch b = diagram.branches[i][j];
                if (b.denominator % 2 == 0 && diagram.ringed.at(i) && diagram.ringed.at(j)) {
                    return PolytopeNameError::impossible(
                        "a branch " + textOf(b) + " of " + std::string(text) +
                        " with both ends ringed generates polygons that cover themselves twice");
                }
            }
        }
        return diagram;
    }
};

// Returns the mirrors of a connected component that is a chain, in order from the end with the smaller number. Returns
// an empty list if the component is not a chain.
std::vector<int> mirrorsAlongChain(const CoxeterDiagram& diagram, MirrorSet component) {
    std::vector<int> mirrors;
    for (int i = 0; i < kMirrors; ++i) {
        if (containsMirror(component, i)) mirrors.push_back(i);
    }
    do {
        bool chain = true;
        for (std::size_t i = 0; i < mirrors.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j)
                chain = chain && (diagram.branches[mirrors[i]][mirrors[j]].numerator != 2) == (i == j + 1);
        }
        if (chain) return mirrors;
    } while (std::next_permutation(mirrors.begin(), mirrors.end()));
    return {};
}

// Parses the operation before the opening brace of a Schläfli symbol, such as "t0,1". Returns the set of ringed
// mirrors; mirror 0 is the first node of the symbol. Returns an empty optional for an unknown operation.
std::optional<MirrorSet> parseRingPrefix(std::string_view text) {
    constexpr std::pair<std::string_view, MirrorSet> kNamed[] = {
        {"", 1}, {"r", 2}, {"t", 3}, {"2r", 4}, {"rr", 5}, {"2t", 6}, {"tr", 7}, {"2rr", 10}, {"2tr", 14}};
    for (const auto& [name, rings] : kNamed) {
        if (name == text) return rings;
    }
    if (!text.starts_with('t')) return {};
    MirrorSet rings = 0;
    for (std::size_t i = 1; i < text.size(); ++i) {
        const bool digit = text[i] >= '0' && text[i] <= '3';
        if ((i % 2 == 1) != digit || (!digit && (text[i] != ',' || i + 1 == text.size()))) return {};
        if (digit) rings |= 1U << static_cast<unsigned>(text[i] - '0');
    }
    return rings;
}

}  // namespace

std::string textOf(DiagramBranch branch) {
    return std::to_string(branch.numerator) + (branch.denominator == 1 ? "" : "/" + std::to_string(branch.denominator));
}

std::optional<DiagramBranch> parseBranch(std::string_view text) {
    TextScanner reader{text};
    const auto branch = reader.branch();
    return reader.rest.empty() ? branch : std::nullopt;
}

std::variant<CoxeterDiagram, PolytopeNameError> parseDiagram(std::string_view text) {
    TextScanner reader{text};
    DiagramBuilder builder;
    int last = -1;
    while (true) {
        bool joined = !reader.skipBlanks();
        if (reader.rest.empty()) return builder.checkedDiagram(text);
        if (reader.take("*")) {
            const int back = reader.rest.empty() ? -1 : reader.rest.front() - 'a';
            if (back < 0 || back >= builder.nodes || back >= kMirrors) {
                return PolytopeNameError::impossible(
                    "* must be followed by the letter of an earlier node: a for the first, b for the second");
            }
            reader.rest.remove_prefix(1);
            last = back;
            joined = true;
        } else if (builder.nodes > 0 && joined && !isDigit(reader.rest.front())) {
            return PolytopeNameError::impossible(
                "two nodes must be separated by a branch number or a blank, as in x5o3o3x and x5o x7o");
        }
        if (builder.nodes > 0 && joined) {
            const auto branch = reader.branch();
            if (!branch) return badBranchError();
            builder.addBranch(last, builder.nodes, *branch);
        }
        const bool ringed = reader.rest.starts_with('x');
        if (!ringed && !reader.rest.starts_with('o')) {
            return PolytopeNameError::impossible("the nodes of a diagram are written x (ringed) and o, as in x5o3o3x");
        }
        reader.rest.remove_prefix(1);
        last = builder.nodes;
        builder.addNode(ringed);
    }
}

std::variant<CoxeterDiagram, PolytopeNameError> parseSchlaefli(std::string_view text) {
    TextScanner reader{text};
    DiagramBuilder builder;
    do {
        reader.skipBlanks();
        const std::size_t brace = reader.rest.find('{');
        const auto rings =
            brace == std::string_view::npos ? std::nullopt : parseRingPrefix(reader.rest.substr(0, brace));
        if (!rings) {
            return PolytopeNameError::impossible(
                "a Schläfli symbol has a form such as {3,3,5}, t0,1{4,3,3}, {5}×{7} or t{4,3}×{}");
        }
        reader.rest.remove_prefix(brace + 1);
        const int first = builder.nodes;
        builder.addNode(containsMirror(*rings, 0));
        while (!reader.take("}")) {
            if (builder.nodes > first + 1) reader.take(",");
            const auto branch = reader.branch();
            if (!branch) return badBranchError();
            builder.addNode(builder.nodes - first < kMirrors && containsMirror(*rings, builder.nodes - first));
            builder.addBranch(builder.nodes - 2, builder.nodes - 1, *branch);
        }
        // Check that the symbol has all nodes that its prefix rings. A prefix can ring only the nodes 0 to 3, so a
        // symbol of four or more nodes needs no check. Without the condition own < kMirrors, a long symbol would also
        // cause a shift by 32 or more, which is undefined.
        if (const int own = builder.nodes - first; own < kMirrors && (*rings >> static_cast<unsigned>(own)) != 0) {
            return PolytopeNameError::impossible(
                "the numbers before { must be node numbers, from 0 to the last node of the symbol");
        }
        reader.skipBlanks();
    } while (reader.take("×") || reader.take("x"));
    if (!reader.rest.empty())
        return PolytopeNameError::impossible("the } of a Schläfli symbol may be followed only by × and another symbol");
    return builder.checkedDiagram(text);
}

std::string linearNotationOf(const CoxeterDiagram& diagram) {
    std::string text;
    for (int i = 0; i < kMirrors; ++i) {
        int joined = -1;
        for (int j = 0; j < i; ++j) {
            if (diagram.branches[i][j].numerator != 2) joined = j;
        }
        if (i > 0 && joined != i - 1) text += ' ';
        if (joined >= 0 && joined != i - 1) text += std::string("*") + static_cast<char>('a' + joined);
        if (joined >= 0) text += textOf(diagram.branches[i][joined]);
        text += diagram.ringed.at(i) ? 'x' : 'o';
    }
    return text;
}

std::string schlaefliOf(const CoxeterDiagram& diagram) {
    std::string text;
    for (const MirrorSet component : componentsOf(diagram)) {
        const std::vector<int> chain = mirrorsAlongChain(diagram, component);
        if (chain.empty()) return {};
        if (!text.empty()) text += "×";
        std::string rings;
        for (std::size_t i = 0; i < chain.size(); ++i) {
            if (diagram.ringed.at(chain[i])) rings += (rings.empty() ? "" : ",") + std::to_string(i);
        }
        if (rings != "0") text += "t" + rings;
        text += '{';
        for (std::size_t i = 1; i < chain.size(); ++i)
            text += (i > 1 ? "," : "") + textOf(diagram.branches[chain[i - 1]][chain[i]]);
        text += '}';
    }
    return text;
}

}  // namespace oval4d::polytopes
