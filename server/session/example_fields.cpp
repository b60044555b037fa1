#include "session/example_fields.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "fields/formula_field.hpp"
#include "protocol_data/embedded_files.hpp"
#include "text/words.hpp"

namespace oval4d::session {

namespace {

std::vector<ExampleField> readExampleFields() {
    std::vector<ExampleField> examples;
    const auto table = nlohmann::json::parse(protocol_data::embeddedFile("fields.json"));
    for (const nlohmann::json& row : table.at("fields")) {
        ExampleField example{
            row.at("name"), row.at("formula"), row.value("aliases", std::vector<std::string>()), {}, {}};
        for (glm::length_t axis = 0; axis < 4; ++axis) {
            const nlohmann::json& range = row.at("box").at(static_cast<std::size_t>(axis));
            example.box.min[axis] = range.at(0);
            example.box.max[axis] = range.at(1);
        }
        auto field =
            fields::fieldFromFormula(example.name, example.formula, example.box, row.value("values", std::string()));
        if (!field) throw std::logic_error("fields.json: " + example.name + ": " + field.error().message);
        field->shared = true;
        example.field = std::make_shared<const fields::Field>(std::move(*field));
        examples.push_back(std::move(example));
    }
    return examples;
}

}  // namespace

std::span<const ExampleField> exampleFields() {
    static const std::vector<ExampleField> examples = readExampleFields();
    return examples;
}

const ExampleField* exampleNamed(std::string_view name) {
    const std::string wanted = text::normalizedName(name);
    const auto examples = exampleFields();
    const auto isWanted = [&](std::string_view known) { return text::normalizedName(known) == wanted; };
    const auto found = std::ranges::find_if(examples, [&](const ExampleField& one) {
        return isWanted(one.name) || std::ranges::any_of(one.aliases, isWanted);
    });
    return found == examples.end() ? nullptr : &*found;
}

}  // namespace oval4d::session
