// Fuzzes the command line. Each line of the input is executed on one session, and is also parsed as an expression and
// as a rotation.

#include "session/expression.hpp"
#include "support.hpp"

using namespace oval4d;
using fuzz::require;

namespace {

void evaluateIt(std::string_view text) {
    const auto value = session::evaluateNumber(text);
    if (!value) {
        fuzz::requireSentence(value.error());
        return;
    }
    require(std::isfinite(*value), "an expression is a finite number");
    // The value must stay the same when it is formatted, as the command line does it, and parsed again.
    std::array<char, 32> digits;
    const std::size_t length = std::snprintf(digits.data(), digits.size(), "%.17g", *value);
    const auto again = session::evaluateNumber({digits.data(), length});
    const bool tiny = *value != 0 && std::abs(*value) < 1e-300;  // the parser may refuse denormal numbers
    require(tiny || (again && *again == *value), "a number's own text is that number:", digits.data());
    if (text.size() > 900) return;
    const auto bracketed = session::evaluateNumber("(" + std::string(text) + ")");
    require(!bracketed || *bracketed == *value, "brackets change nothing");
}

}  // namespace

OVAL4D_FUZZER(command_line) {
    std::string_view rest = fuzz::textOf(data, size);
    session::Session session;
    for (int lines = 0; !rest.empty() && lines < 16; ++lines) {
        const std::string_view line = fuzz::takeUntil(rest, '\n');
        evaluateIt(line);
        if (const auto turn = session::parseTurn(line)) {
            const glm::dmat4 matrix = geometry::Rotation(*turn).matrix();
            require(std::abs(glm::determinant(matrix) - 1) < 1e-9, "a rotation has determinant 1");
        } else {
            fuzz::requireSentence(turn.error());
        }
        fuzz::execute(session, session::CommandLine{std::string(line)});
    }
    fuzz::requireHistory(session);
    fuzz::requireRoundTrip(session.current, session.loaded);
    return 0;
}
