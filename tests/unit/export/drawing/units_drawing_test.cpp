// Tests of the units in drawings of fields.

#include <algorithm>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "export/drawing/ascii_text.hpp"
#include "export/drawing/coordinates_drawing.hpp"
#include "export/drawing/matrix_drawing.hpp"
#include "fields/array_field.hpp"
#include "scene/composer.hpp"
#include "slicing/slicer.hpp"

namespace {

using namespace oval4d;

TEST(AsciiText, KeepsTheSignsOfUnits) {
    for (const char* same : {"", "K", "m s-1", "degrees_east"}) EXPECT_EQ(exports::asciiText(same), same);
    EXPECT_EQ(exports::asciiText("µg m⁻³"), "ug m^-3");
    EXPECT_EQ(exports::asciiText("10¹² m²·s"), "10^12 m^2*s");
    EXPECT_EQ(exports::asciiText("°C"), "degC");
    EXPECT_EQ(exports::asciiText("温度 …"), "?? ...");
}

slicing::Object fieldWithUnits() {
    fields::FieldArray array;
    array.shape = {2, 2, 2, 2};
    array.box = {glm::dvec4(-1), glm::dvec4(1, 1, 1, 9)};
    array.samples = fields::SampleStorage(std::vector<float>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15});
    array.units = {"µm", "µm", "", "s"};
    array.quantity = {"temperature", "°C"};
    return std::make_shared<const fields::Field>(*fields::fieldFromArray("run", array));
}

// Returns the texts in the drawing of a field: in the drawing of its planar sections if `view` is the matrix view,
// otherwise in the drawing of its histogram.
std::vector<std::string> textsOf(const slicing::Object& object, scene::View view) {
    slicing::SliceSet slices;
    slicing::Slicer().sliceWithoutSurfaces(object, {}, {0, 1, 1}, slices);
    scene::Look look;
    look.view = view;
    look.parts.faces = false;
    look.field.levels = {4};
    scene::Scene scene;
    scene::Composer().compose(object, {}, slices, 0, look, {}, scene);
    const exports::Drawing drawing = view == scene::View::matrix ? exports::drawMatrix(scene, glm::dvec4(0))
                                                                 : exports::drawCoordinates(scene, object, {});
    std::vector<std::string> texts;
    for (const exports::ShapeGroup& group : drawing.groups) {
        for (const exports::DrawnShape& shape : group.shapes) {
            if (const auto* line = std::get_if<exports::TextLine>(&shape)) texts.push_back(line->text);
        }
    }
    return texts;
}

TEST(CoordinatesDrawing, HasTheUnitsAndTheQuantity) {
    EXPECT_EQ(textsOf(fieldWithUnits(), scene::View::oval),
              (std::vector<std::string>{"x, um", "y, um", "z", "w, s", "temperature, degC"}));
}

TEST(CoordinatesDrawing, LeavesOutWhatDoesNotFit) {
    fields::Field field = *slicing::fieldIn(fieldWithUnits());
    field.units[0] = std::string(64, 'm');
    field.quantity = {std::string(64, 'q'), std::string(64, 'u')};
    EXPECT_EQ(textsOf(std::make_shared<const fields::Field>(field), scene::View::oval),
              (std::vector<std::string>{"x", "y, um", "z", "w, s"}));
}

TEST(MatrixDrawing, HasTheUnitsInWhichTheNumbersAre) {
    const std::vector<std::string> texts = textsOf(fieldWithUnits(), scene::View::matrix);
    EXPECT_EQ(std::ranges::count(texts, "um"), 2);
    EXPECT_EQ(std::ranges::count(texts, "s"), 0) << "w is scaled, so its numbers are no seconds";
}

}  // namespace
