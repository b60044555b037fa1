#include "wire/export_query.hpp"

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
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

template <typename Choices, typename Value>
Result<std::monostate> parseChoice(const std::string& name, const std::string& value, const Choices& choices,
                                   Value& into) {
    if (const auto found = text::valueNamed(choices, value)) {
        into = *found;
        return std::monostate{};
    }
    return Error{ErrorCode::bad_message,
                 name + " must be " + text::alternatives(text::namesOf(choices)) + ", not " + text::inQuotes(value)};
}

Result<std::monostate> parseSize(const std::string& text, const geometry::Range& bounds, double& size) {
    const char* const end = text.data() + text.size();
    double value = 0;
    const auto [stopped, fault] = std::from_chars(text.data(), end, value);
    if (fault != std::errc{} || stopped != end || !bounds.contains(value)) {
        return Error{ErrorCode::out_of_range, "size must be from " + text::roundedDecimal(bounds.least) + " to " +
                                                  text::roundedDecimal(bounds.most) + " millimeters, not " +
                                                  text::inQuotes(text)};
    }
    size = value;
    return std::monostate{};
}

Result<std::monostate> parseSwitch(const std::string& name, const std::string& value, bool& into) {
    const bool yes = value == "on" || value == "true" || value == "yes" || value == "1";
    const bool no = value == "off" || value == "false" || value == "no" || value == "0";
    if (!yes && !no) return Error{ErrorCode::bad_message, name + " must be on or off, not " + text::inQuotes(value)};
    into = yes;
    return std::monostate{};
}

Result<std::monostate> parseChosenW(const std::string& text, std::vector<double>& at) {
    auto list = session::evaluateList(text);
    if (!list) return Error{list.error().code, "at: " + list.error().message};
    at = std::move(*list);
    return std::monostate{};
}

Result<std::monostate> parseFittedSlices(const std::string& text, int maxSlices, std::optional<int>& fit) {
    const auto value = session::evaluate(text);
    if (!value) return Error{value.error().code, "fit: " + value.error().message};
    if (*value != std::trunc(*value) || !(*value >= 1 && *value <= maxSlices))
        return wrongFit(maxSlices, text::roundedDecimal(*value));
    fit = static_cast<int>(*value);
    return std::monostate{};
}

}  // namespace

Error wrongFit(int maxSlices, const std::string& given) {
    return {ErrorCode::out_of_range,
            "fit must be a whole number of slices from 1 to " + std::to_string(maxSlices) + ", not " + given};
}

Result<exports::ExportRequest> extractExportRequest(session::QueryParameters& query, const exports::Format& format,
                                                    int maxSlices) {
    exports::ExportRequest request = exports::defaultRequestFor(format);
    session::QueryParameters rest;
    bool hasContents = false;
    for (auto& [name, written] : query) {
        const std::string value(text::trimmed(text::withPlainBlanks(written)));
        Result<std::monostate> done = std::monostate{};
        if (name == "of") {
            hasContents = true;
            done = parseChoice(name, value, exports::kExportContents, request.contents);
        } else if (name == "at") {
            done = parseChosenW(value, request.chosenW);
        } else if (name == "fit") {
            done = parseFittedSlices(value, maxSlices, request.fittedSlices);
        } else if (name == "body") {
            done = parseChoice(name, value, exports::kBodies, request.body);
        } else if (name == "label") {
            done = parseChoice(name, value, exports::kLabels, request.label);
        } else if (name == "exact") {
            done = parseSwitch(name, value, request.exact);
        } else if (name == "size") {
            done = parseSize(value, exports::sizeRangeOf(format), request.size);
        } else {
            rest.emplace_back(std::move(name), std::move(written));
        }
        if (!done) return done.error();
    }
    if (!hasContents && request.choosesSlices()) request.contents = exports::ExportContentsKind::oval;
    query = std::move(rest);
    return request;
}

}  // namespace oval4d::wire
