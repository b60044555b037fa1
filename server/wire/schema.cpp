#include "wire/schema.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "protocol_data/embedded_files.hpp"
#include "text/message_text.hpp"

namespace oval4d::wire {

namespace {

using namespace nlohmann::literals;
using nlohmann::json;
using valijson::adapters::NlohmannJsonAdapter;

struct MessageSchema {
    json text;
    valijson::Schema compiled;
};

// Adds the keywords of `more` to `schema`. If both have a keyword, the value from `more` wins; but `properties`,
// `items` and `required` are combined.
void addKeywords(const json& more, json& schema) {
    for (const auto& [keyword, value] : more.items()) {
        const auto own = schema.find(keyword);
        if (own == schema.end()) {
            schema[keyword] = value;
        } else if (keyword == "properties") {
            for (const auto& [name, property] : value.items()) {
                if (own->contains(name)) {
                    addKeywords(property, own->at(name));
                } else {
                    (*own)[name] = property;
                }
            }
        } else if (keyword == "items") {
            addKeywords(value, *own);
        } else if (keyword == "required") {
            for (const json& name : value) {
                if (std::ranges::find(*own, name) == own->end()) own->push_back(name);
            }
        } else {
            *own = value;
        }
    }
}

// A reader of schemas, which reads each file only once.
class SchemaReader {
  public:
    // Returns the schema at a reference of the form "<file>" or "<file>#<JSON pointer>".
    json read(const std::string& reference) {
        const std::size_t end = std::min(reference.find('#'), reference.size());
        auto& file = files_[reference.substr(0, end)];
        if (file.is_null()) file = json::parse(protocol_data::embeddedFile("schema/" + reference.substr(0, end)));
        json part = file.at(json::json_pointer(reference.substr(std::min(end + 1, reference.size()))));
        resolveReferences(part);
        return part;
    }

  private:
    // Replaces references to other files by the schemas in these files. Leaves references within a file ("#/…") to
    // valijson. Also replaces the keyword unevaluatedProperties, which valijson does not know, by additionalProperties.
    // Both keywords mean the same after the reference is replaced.
    void resolveReferences(json& schema) {
        if (!schema.is_structured()) return;
        for (json& part : schema) resolveReferences(part);
        const bool refers =
            schema.is_object() && schema.contains("$ref") && !schema.at("$ref").get<std::string>().starts_with('#');
        if (!refers) return;
        json whole = read(schema.at("$ref"));
        schema.erase("$ref");
        addKeywords(schema, whole);
        if (const auto rule = whole.find("unevaluatedProperties"); rule != whole.end()) {
            whole["additionalProperties"] = *rule;
            whole.erase("unevaluatedProperties");
        }
        schema = std::move(whole);
    }

    std::map<std::string, json> files_;
};

// Returns the schemas of all messages: the schemas of objects with a constant member "type".
std::map<std::string, std::unique_ptr<const MessageSchema>, std::less<>> readSchemas() {
    std::map<std::string, std::unique_ptr<const MessageSchema>, std::less<>> schemas;
    SchemaReader reader;
    for (const std::string_view path : protocol_data::embeddedPaths()) {
        constexpr std::string_view kFolder = "schema/";
        if (!path.starts_with(kFolder)) continue;
        auto schema = std::make_unique<MessageSchema>();
        schema->text = reader.read(std::string(path.substr(kFolder.size())));
        const json type = schema->text.value("/properties/type/const"_json_pointer, json());
        if (!type.is_string()) continue;
        valijson::SchemaParser parser;
        parser.populateSchema(NlohmannJsonAdapter(schema->text), schema->compiled);
        schemas.emplace(type.get<std::string>(), std::move(schema));
    }
    return schemas;
}

const MessageSchema& schemaOf(std::string_view type) {
    static const auto schemas = readSchemas();
    const auto schema = schemas.find(type);
    if (schema == schemas.end()) throw std::logic_error("no schema describes the message " + std::string(type));
    return *schema->second;
}

// Returns the name in a step of valijson's path to an error. Steps have the form "<root>", "[angles]" or "[0]".
std::string pathStepName(const std::string& step) { return step.substr(1, step.size() - 2); }

// Returns the error with the longest path, because this is the most specific error. Returns nullptr if there is none.
const valijson::ValidationResults::Error* mostSpecificError(const valijson::ValidationResults& results) {
    const valijson::ValidationResults::Error* deepest = nullptr;
    for (const auto& error : results) {
        if (!deepest || error.context.size() > deepest->context.size()) deepest = &error;
    }
    return deepest;
}

// Returns the end of an error message after "must be": the title of the schema, such as "a finite number of radians".
// For a schema without a title but with both bounds, returns a text such as "a number from 0.25 to 4" or "an integer
// from 1 to 9". For other schemas, returns "different".
std::string expectedValueText(const json& schema) {
    if (schema.contains("title") || !schema.contains("minimum") || !schema.contains("maximum"))
        return schema.value("title", "different");
    const std::string kind = schema.at("type") == "integer" ? "an integer" : "a number";
    return kind + " from " + text::roundedDecimal(schema.at("minimum").get<double>()) + " to " +
           text::roundedDecimal(schema.at("maximum").get<double>());
}

// Returns the description of one fault: a missing required member of an object, or an unknown member. Returns an empty
// string if there is no such fault.
std::string describeMembersFault(const json& schema, const json& value, const std::string& path) {
    if (!value.is_object() || !schema.contains("properties")) return {};
    const json& properties = schema.at("properties");
    if (schema.contains("required")) {
        for (const std::string name : schema.at("required")) {
            if (!value.contains(name))
                return path + "/" + name + " is missing; it must be " + expectedValueText(properties.at(name));
        }
    }
    if (schema.value("additionalProperties", json(true)) != json(false)) return {};
    for (const auto& [name, member] : value.items()) {
        if (properties.contains(name)) continue;
        std::vector<std::string_view> known;
        for (const auto& [property, ignored] : properties.items()) known.emplace_back(property);
        return (path.empty() ? "" : path + ": ") + "unknown member " + text::inQuotes(name) +
               text::didYouMean(name, known) + "; allowed members: " + text::commaSeparated(known);
    }
    return {};
}

// Returns whether a value is a number of the right type, but outside the bounds of its schema.
bool isOutOfBounds(const json& schema, const json& value) {
    if (!value.is_number()) return false;
    const json type = schema.value("type", json());
    if (type == "integer" && !value.is_number_integer()) return false;
    const double number = value.get<double>();
    return (schema.contains("minimum") && number < schema.at("minimum").get<double>()) ||
           (schema.contains("maximum") && number > schema.at("maximum").get<double>()) ||
           (schema.contains("exclusiveMinimum") && number <= schema.at("exclusiveMinimum").get<double>());
}

// Returns a number as text, rounded for readability. Returns all digits if rounding would make the number equal to a
// bound of its schema.
std::string numberText(const json& schema, const json& value) {
    const auto number = value.get<double>();
    std::string rounded = text::roundedDecimal(number);
    for (const char* const keyword : {"minimum", "maximum", "exclusiveMinimum"}) {
        const auto bound = schema.find(keyword);
        if (bound == schema.end() || text::roundedDecimal(bound->get<double>()) != rounded) continue;
        return (number < 0 ? "\u2212" : "") + text::shortestDecimal(std::abs(number));
    }
    return rounded;
}

// Returns the end of an error message: ", not " and the value. Returns an empty string for an array or object, whose
// text may be long.
std::string actualValueText(const json& schema, const json& value) {
    if (value.is_structured()) return {};
    if (value.is_number()) return ", not " + numberText(schema, value);
    return ", not " + (value.is_string() ? text::inQuotes(value.get<std::string>()) : value.dump());
}

}  // namespace

json readSchema(const std::string& reference) { return SchemaReader().read(reference); }

std::optional<Error> validationError(std::string_view type, const json& message) {
    const MessageSchema& schema = schemaOf(type);
    valijson::Validator validator;
    // The first pass collects no errors, because most messages are valid and this pass is faster.
    if (validator.validate(schema.compiled, NlohmannJsonAdapter(message), nullptr)) return {};

    valijson::ValidationResults results;
    validator.validate(schema.compiled, NlohmannJsonAdapter(message), &results);
    const json* node = &schema.text;
    const json* value = &message;
    std::string path;
    if (const auto* fault = mostSpecificError(results)) {
        for (std::size_t i = 1; i < fault->context.size(); ++i) {
            const std::string step = pathStepName(fault->context[i]);
            const json* next = nullptr;
            if (value->is_object() && value->contains(step)) {
                if (node->contains("properties") && node->at("properties").contains(step))
                    next = &node->at("properties").at(step);
                value = &value->at(step);
            } else if (value->is_array()) {
                if (node->contains("items")) next = &node->at("items");
                value = &value->at(std::stoul(step));
            }
            if (!next) break;
            node = next;
            path += "/" + step;
        }
    }
    const std::string prefix = std::string(type) + ": ";
    if (std::string text = describeMembersFault(*node, *value, path); !text.empty())
        return Error{ErrorCode::bad_message, prefix + text};
    return Error{isOutOfBounds(*node, *value) ? ErrorCode::out_of_range : ErrorCode::bad_message,
                 prefix + (path.empty() ? "the message" : path) + " must be " + expectedValueText(*node) +
                     actualValueText(*node, *value)};
}

}  // namespace oval4d::wire
