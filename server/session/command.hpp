#pragma once
// The commands that change a session. They come from messages, from keys and from the page's command line, which is
// typed after ':'. Each command is a struct; its constant kMessageType is the type of the messages that contain it. If
// the members of the struct are described with Boost.Describe, the message has members with the same names.

#include <any>
#include <array>
#include <boost/describe/class.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "fields/readers/folder_files.hpp"
#include "fields/scalar_function.hpp"
#include "geometry/centering.hpp"
#include "geometry/rotation.hpp"
#include "slicing/element.hpp"
#include "slicing/field_settings.hpp"

namespace oval4d::session {

/// A key press.
struct Key {
    static constexpr std::string_view kMessageType = "key";
    std::string key;  ///< the value of KeyboardEvent.key in a browser: "y", "K", "2", " ", "["
    bool shift = false, ctrl = false;
};
BOOST_DESCRIBE_STRUCT(Key, (), (key, shift, ctrl))

/// Rotates the object.
struct Rotate {
    static constexpr std::string_view kMessageType = "rotate";
    geometry::Turn turn;
    /// Whether the rotation belongs to the undo step of the previous command, as within a gesture.
    bool continues = false;
    bool operator==(const Rotate&) const = default;
};
/// Turns an element of the object toward +w, by the shortest rotation.
struct TurnToward {
    static constexpr std::string_view kMessageType = "toward";
    slicing::ElementKind element = slicing::ElementKind::cell;  ///< the kind of the element
    /// The index of the element (slicing::Element::index). If it is absent, turnToward() (settings.hpp) chooses an
    /// element.
    std::optional<std::size_t> number;
    bool immediately = false;  ///< whether to turn the object at once, without a continuous motion
};
BOOST_DESCRIBE_STRUCT(TurnToward, (), (element, number, immediately))

/// A level of a multiscale image that is to replace a coarser one.
struct FinerLevel {
    std::uint32_t level = 0;  ///< see fields::ImageLevel
    double initialLevel = 0;  ///< of the field with the coarser one, which the field with the finer one gets, too, so
                              ///< that the levels that are shown are still the initial ones
    bool operator==(const FinerLevel&) const = default;
};
/// Loads an object from a file, or makes a field from a formula, and shows it.
struct LoadObject {
    static constexpr std::string_view kMessageType = "load";
    std::string name;    ///< the name to give to the object
    std::string format;  ///< the name of the file format: "off", "points", "cloud", "formula", "npy" …
    std::string data;    ///< the text of the file (of an array: its bytes in Base64), or the formula
    /// Whether the command belongs to the undo step of the previous command, as while a user edits a formula. If true,
    /// and if a field replaces a field, FieldSettings stay the same; if both fields also have the same circumradius,
    /// HyperplaneSettings and the focus point stay the same, too.
    bool continues = false;
    /// The domain of the field. If it is absent, the domain of a formula is fields::kFormulaBox, and that of an array
    /// is the box that the file states or, without one, fields::defaultBox().
    std::optional<fields::Box> box = {};
    std::optional<fields::Box> region = {};  ///< for a Zarr folder: see fields::FieldReadOptions
    std::string axes = {};                   ///< for an array: see fields::FieldReadOptions
    std::string variable = {};               ///< for an array: see fields::FieldReadOptions
    std::string secondFormula = {};          ///< the formula of the second function; empty for none
    std::string secondVariable = {};  ///< for an array: the variable of the same file that is the second function
    /// Whether to add the time steps in the file to the loaded array called `name`, at the end of w, instead of
    /// replacing the array. Makes no undo step: the states of the history show the longer array, too.
    bool append = false;
    /// The file of an array, instead of `data`. If the format is empty, it is recognized from the first bytes of the
    /// file.
    std::shared_ptr<const fields::FileHandle> file = {};
    /// The files of an array, instead of `data`. Each file contains one time step.
    std::vector<std::shared_ptr<const fields::FileHandle>> series = {};
    /// A Zarr folder, instead of `data`.
    std::shared_ptr<const fields::FolderFiles> folder = {};
    std::string dataName = {};             ///< the name of an array in the server's data folder, instead of `data`
    geometry::Centering center = {};       ///< for a polytope, a surface or points: the point about which they turn
    std::optional<FinerLevel> finer = {};  ///< for an array in the server's data folder: see loadOfFinerLevel()

    /// Returns whether the object is an array in files or in a folder, not in `data`. The format of such an array may
    /// be empty.
    bool isArrayInFiles() const { return file || folder || !series.empty() || !dataName.empty(); }
    bool operator==(const LoadObject&) const = default;
};
/// A text that says how to read an object: its name in messages and in the queries of uploads, and the member.
struct LoadText {
    std::string_view name;
    std::string LoadObject::* member;
};
inline constexpr auto kLoadTexts = std::to_array<LoadText>({{"format", &LoadObject::format},
                                                            {"axes", &LoadObject::axes},
                                                            {"variable", &LoadObject::variable},
                                                            {"values", &LoadObject::secondFormula},
                                                            {"values_variable", &LoadObject::secondVariable}});

/// Values of the plain settings (see forEachSetting() in setting_table.hpp), by their names on the command line.
class PlainSettings {
  public:
    /// Returns a reference through which the caller may set the value of a setting; until then, the value is an empty
    /// optional. `Value` must be the type that the value has in a State. `name` must be a string constant of the
    /// program, because this object stores only a reference to its characters.
    template <typename Value>
    std::optional<Value>& of(std::string_view name) {
        std::any& value = values_.try_emplace(name, std::optional<Value>()).first->second;
        return std::any_cast<std::optional<Value>&>(value);
    }
    /// Returns the value of a setting; an empty optional if it is not set.
    template <typename Value>
    const std::optional<Value>& of(std::string_view name) const {
        static const std::optional<Value> none;
        const auto found = values_.find(name);
        return found == values_.end() ? none : std::any_cast<const std::optional<Value>&>(found->second);
    }

  private:
    std::map<std::string_view, std::any> values_;
};
/// Changes the settings that are present; the others keep their values.
struct Set {
    static constexpr std::string_view kMessageType = "set";
    bool continues = false;                   ///< whether the change belongs to the undo step of the previous command
    std::optional<std::string> object;        ///< the name of the object to show; see findObject()
    std::optional<LoadObject> formula;        ///< how to make the field called `object` from a formula; the field is
                                              ///< loaded first, unless the session already has the same one
    std::optional<double> pace;               ///< ReferenceFrame::pace
    std::optional<glm::dvec3> follow, boost;  ///< ReferenceFrame::follow, ReferenceFrame::boost
    std::optional<glm::dmat4> orientation;
    std::optional<int> count;       ///< HyperplaneSettings::count, which is odd
    std::optional<double> spacing;  ///< HyperplaneSettings::spacing
    std::optional<int> focus;       ///< HyperplaneSettings::focus
    std::optional<double> offset;   ///< HyperplaneSettings::offset
    std::optional<double> focusW;   ///< w of the focus slice, in the coordinates of the object's file: sets focus and
                                    ///< offset (see moveFocusTo())
    std::optional<glm::dvec4> focusPoint;  ///< in the coordinates of the object's file. x, y, z: Look::focusPoint. w:
                                           ///< like `focusW`, but ignored if `focus`, `offset` or `focusW` is present
    std::optional<bool> turning;           ///< whether the object turns continuously
    std::optional<bool> playing;           ///< State::playing
    std::optional<std::vector<double>> levels;                 ///< FieldSettings::levels; for fields only
    std::optional<fields::Inside> inside;                      ///< FieldSettings::inside; for fields only
    std::optional<std::vector<slicing::FogControlPoint>> fog;  ///< FieldSettings::fog; for fields only
    std::optional<std::vector<std::uint32_t>> hidden, faded;   ///< indices of cell types, in any order
    /// The element that is drawn in another color. The outer optional is empty if the highlight stays the same; the
    /// inner optional is empty if the command removes the highlight.
    std::optional<std::optional<slicing::Element>> highlight;
    std::optional<geometry::Turn> lastTurn;  ///< the last rotation, which the keys '.' and space repeat
    PlainSettings plain;                     ///< all other settings
};
struct Undo {
    static constexpr std::string_view kMessageType = "undo";
};
BOOST_DESCRIBE_STRUCT(Undo, (), ())

struct Redo {
    static constexpr std::string_view kMessageType = "redo";
};
BOOST_DESCRIBE_STRUCT(Redo, (), ())

/// Restores the initial orientation and focus, and ends all motion.
struct Reset {
    static constexpr std::string_view kMessageType = "reset";
};
BOOST_DESCRIBE_STRUCT(Reset, (), ())

/// Replaces the orientation by a random rotation; all rotations are equally probable.
struct TurnAtRandom {
    static constexpr std::string_view kMessageType = "random";
    std::optional<std::uint64_t> seed;  ///< determines the rotation; if it is absent, the seed is random
};
BOOST_DESCRIBE_STRUCT(TurnAtRandom, (), (seed))

/// Applies a line of the page's command line; see parseCommandLine().
struct CommandLine {
    static constexpr std::string_view kMessageType = "command";
    std::string line;  ///< with or without the ':'
};
BOOST_DESCRIBE_STRUCT(CommandLine, (), (line))

/// Shows the view that the query of an address describes. Settings that the query does not contain stay as they are.
/// However, if the query contains an object or rotations, the orientation is first set back to the initial one.
struct ShowLinkedView {
    static constexpr std::string_view kMessageType = "address";
    std::string query;  ///< see parseQuery()
};
BOOST_DESCRIBE_STRUCT(ShowLinkedView, (), (query))

using Command = std::variant<Key, Rotate, TurnToward, TurnAtRandom, Set, LoadObject, Undo, Redo, Reset, CommandLine,
                             ShowLinkedView>;

}  // namespace oval4d::session
