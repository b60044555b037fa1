#pragma once
// What a file is asked to be.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace oval4d::exports {

enum class Format : std::uint8_t { stl, three_mf, obj, ply, glb, off, csv, svg };
enum class Extent : std::uint8_t { focus, oval };  ///< the focus slice alone, or all slices
enum class Body : std::uint8_t { solid, frame };   ///< filled, or balls and bars grown together
enum class Label : std::uint8_t { none, engraved, separate };

inline constexpr double kLeastSize = 1, kMostSize = 10'000;  ///< millimetres

struct Wish {
    Format format = Format::stl;
    Extent of = Extent::focus;
    Body body = Body::solid;
    double size = 60;  ///< of the polytope's circumscribed sphere, its diameter in millimetres
    Label label = Label::none;
};

/// One value of a choice and how it is written.
template <typename Choice>
struct Named {
    std::string_view name;
    Choice value;
};
inline constexpr std::array<Named<Format>, 8> kFormats{{{"stl", Format::stl},
                                                        {"3mf", Format::three_mf},
                                                        {"obj", Format::obj},
                                                        {"ply", Format::ply},
                                                        {"glb", Format::glb},
                                                        {"off", Format::off},
                                                        {"csv", Format::csv},
                                                        {"svg", Format::svg}}};
inline constexpr std::array<Named<Extent>, 2> kExtents{{{"focus", Extent::focus}, {"oval", Extent::oval}}};
inline constexpr std::array<Named<Body>, 2> kBodies{{{"solid", Body::solid}, {"frame", Body::frame}}};
inline constexpr std::array<Named<Label>, 3> kLabels{
    {{"none", Label::none}, {"engraved", Label::engraved}, {"separate", Label::separate}}};

/// The value of that name.
template <typename Choice, std::size_t n>
constexpr std::optional<Choice> named(const std::array<Named<Choice>, n>& choices, std::string_view name) {
    for (const auto& choice : choices) {
        if (choice.name == name) return choice.value;
    }
    return {};
}

/// "stl", "3mf", …: as the extension of a file too.
std::string_view nameOf(Format format);
/// As HTTP's Content-Type has it.
std::string_view mediaType(Format format);

}  // namespace oval4d::exports
