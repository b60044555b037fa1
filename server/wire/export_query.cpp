#include "wire/export_query.hpp"

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "session/expression.hpp"
#include "text/choice.hpp"
#include "text/message_text.hpp"
#include "text/words.hpp"

namespace oval4d::wire {

namespace {

/// A parser of export options, with an overload of parse() for each type of value. parse() sets its last parameter or,
/// if the value is wrong, returns an error that contains `name`, the name of the option.
struct ExportOptionParser {
    const exports::Format& format;
    int maxSlices;

    template <text::HasChoices Enum>
    Result<std::monostate> parse(std::string_view name, const std::string& value, Enum& into) const {
        const auto& choices = choicesOf(Enum{});
        if (const auto found = text::valueNamed(choices, value)) {
            into = *found;
            return std::monostate{};
        }
        return Error{ErrorCode::bad_message, std::string(name) + " must be " +
                                                 text::joinedWithOr(text::namesOf(choices)) + ", not " +
                                                 text::inQuotes(value)};
    }

    /// Parses a size in millimeters, within the bounds for the file format.
    Result<std::monostate> parse(std::string_view name, const std::string& text, double& size) const {
        const geometry::NumberRange bounds = exports::sizeRangeOf(format);
        const char* const end = text.data() + text.size();
        double value = 0;
        const auto [stopped, fault] = std::from_chars(text.data(), end, value);
        if (fault != std::errc{} || stopped != end || !bounds.contains(value)) {
            return Error{ErrorCode::out_of_range,
                         std::string(name) + " must be from " + text::roundedDecimal(bounds.least) + " to " +
                             text::roundedDecimal(bounds.most) + " millimeters, not " + text::inQuotes(text)};
        }
        size = value;
        return std::monostate{};
    }

    Result<std::monostate> parse(std::string_view name, const std::string& value, bool& into) const {
        const bool yes = value == "on" || value == "true" || value == "yes" || value == "1";
        const bool no = value == "off" || value == "false" || value == "no" || value == "0";
        if (!yes && !no)
            return Error{ErrorCode::bad_message,
                         std::string(name) + " must be on or off, not " + text::inQuotes(value)};
        into = yes;
        return std::monostate{};
    }

    /// Parses a list of values of w, separated by commas.
    Result<std::monostate> parse(std::string_view name, const std::string& text, std::vector<double>& at) const {
        auto list = session::evaluateList(text);
        if (!list) return Error{list.error().code, std::string(name) + ": " + list.error().message};
        at = std::move(*list);
        return std::monostate{};
    }

    /// Parses a number of slices, from 1 to `maxSlices`.
    Result<std::monostate> parse(std::string_view name, const std::string& text, std::optional<int>& fit) const {
        const auto value = session::evaluateNumber(text);
        if (!value) return Error{value.error().code, std::string(name) + ": " + value.error().message};
        if (*value != std::trunc(*value) || !(*value >= 1 && *value <= maxSlices))
            return invalidFitError(maxSlices, text::roundedDecimal(*value));
        fit = static_cast<int>(*value);
        return std::monostate{};
    }
};

}  // namespace

Error invalidFitError(int maxSlices, const std::string& given) {
    return {ErrorCode::out_of_range,
            "fit must be a whole number of slices from 1 to " + std::to_string(maxSlices) + ", not " + given};
}

Result<exports::ExportRequest> extractExportRequest(session::QueryParameters& query, const exports::Format& format,
                                                    int maxSlices) {
    exports::ExportRequest request = exports::defaultRequestFor(format);
    const ExportOptionParser parser{format, maxSlices};
    session::QueryParameters rest;
    bool hasContents = false;
    for (auto& parameter : query) {
        const std::string value(text::trimmed(text::withPlainBlanks(parameter.second)));
        bool isOption = false;
        Result<std::monostate> done = std::monostate{};
        exports::forEachOption(request, [&](std::string_view name, auto& into) {
            if (name != parameter.first) return;
            isOption = true;
            done = parser.parse(name, value, into);
        });
        if (!done) return done.error();
        hasContents = hasContents || parameter.first == "of";
        if (!isOption) rest.push_back(std::move(parameter));
    }
    if (!hasContents && request.choosesSlices()) request.contents = exports::ExportContentsKind::oval;
    query = std::move(rest);
    return request;
}

}  // namespace oval4d::wire
