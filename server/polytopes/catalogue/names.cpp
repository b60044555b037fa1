#include "polytopes/catalogue/names.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "polytopes/construction/solids.hpp"
#include "text/message_text.hpp"
#include "text/words.hpp"

namespace oval4d::polytopes {

namespace {

// Returns the words with which the names of constructions begin, such as "dual", "prism" and "hull". In a name, "of"
// follows such a word, as in "hull of X and Y"; only after "dual", "of" may be omitted.
const std::vector<std::string_view>& constructionWords() {
    static const std::vector<std::string_view> all = [] {
        std::vector<std::string_view> found;
        for (const PolytopeNotation* notation : kNotations) {
            for (const std::string_view word : text::splitAtCommas(notation->constructions)) found.push_back(word);
        }
        return found;
    }();
    return all;
}

// Counts the constructions in a name: each word of constructionWords() that is followed by "of", and each "dual" that
// is followed by any word.
std::size_t countConstructions(const std::vector<std::string>& words) {
    std::size_t count = 0;
    for (std::size_t i = 0; i + 1 < words.size(); ++i) {
        const bool begins = std::ranges::find(constructionWords(), words[i]) != constructionWords().end();
        if (begins && (words[i + 1] == "of" || words[i] == "dual")) ++count;
    }
    return count;
}

// Returns whether the words contain "of circumradius", but neither "hull" nor "intersection" before it. Only the names
// of the two polytopes of a hull or an intersection may state a circumradius.
bool hasMisplacedCircumradius(const std::vector<std::string>& words) {
    for (std::size_t i = 0; i + 1 < words.size(); ++i) {
        if (words[i] == "hull" || words[i] == "intersection") return false;
        if (words[i] == "of" && words[i + 1] == "circumradius") return true;
    }
    return false;
}

// Returns why a text names no polytope, for a text that is in none of the notations. There are two known reasons: the
// text names a polyhedron, or it has the form of a construction but begins with an unknown word. Returns an empty
// string for other texts.
std::string unknownNameReason(const std::vector<std::string>& words) {
    if (const auto solid = solidNamed(words); solid && std::holds_alternative<SolidDescription>(*solid)) {
        const std::string name = nameOf(std::get<SolidDescription>(*solid));
        return "the " + name + " is a polyhedron; 4-D polytopes over it are the prism of " + name +
               ", the pyramid of " + name + " and the bipyramid of " + name;
    }
    if (words.size() < 3 || words[1] != "of") return {};
    const std::vector<std::string_view>& known = constructionWords();
    return text::inQuotes(words[0]) + " is not a construction" + text::didYouMean(words[0], known) + "; there are " +
           text::commaSeparated(known);
}

}  // namespace

PolytopeDesignOrError designDescribedBy(std::string_view text, const DesignLookup& lookup) {
    const std::vector<std::string> words = text::lowerCaseWords(text);
    if (words.empty()) return PolytopeNameError{};
    if (const std::size_t count = countConstructions(words); count > kMaxConstructions) {
        return PolytopeNameError::impossible("the name has " + std::to_string(count) + " constructions; at most " +
                                             std::to_string(kMaxConstructions) + " are allowed");
    }
    if (hasMisplacedCircumradius(words)) {
        return PolytopeNameError::impossible(
            "'of circumradius' and a number may follow only a polytope of a hull or an intersection, as in hull of "
            "tesseract and 16-cell of circumradius 3");
    }
    for (const PolytopeNotation* notation : kNotations) {
        auto found = notation->parse({words, lookup});
        if (!found) continue;
        const auto* error = std::get_if<PolytopeNameError>(&*found);
        if (error == nullptr || error->reason != PolytopeNameError::Reason::unknown || !error->message.empty())
            return *std::move(found);
    }
    return PolytopeNameError{PolytopeNameError::Reason::unknown, unknownNameReason(words)};
}

}  // namespace oval4d::polytopes
