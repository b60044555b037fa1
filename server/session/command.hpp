#pragma once
// The commands that change a session. Commands come from messages, from keys and from the page's command line, which
// opens with the key ':'. Each command is a struct. Its constant kMessageType is the type of the messages that contain
// the command. The members of a message have the names of the members that Boost.Describe describes.

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

/// The command that executes the action of a pressed key.
struct KeyPress {
    static constexpr std::string_view kMessageType = "key";
    std::string key;  ///< the value of KeyboardEvent.key in a browser, such as "y", "K", "2" or " "
    bool shift = false, ctrl = false;
};
BOOST_DESCRIBE_STRUCT(KeyPress, (), (key, shift, ctrl))

/// The command that rotates the object in one plane, or in two perpendicular planes at once.
struct Rotate {
    static constexpr std::string_view kMessageType = "rotate";
    geometry::RotationAngles turn;
    /// Whether undo treats the rotation and the previous command as one step, as during a drag with the mouse.
    bool continues = false;
    bool operator==(const Rotate&) const = default;
};
/// The command that turns an element (a cell, face, edge or vertex) toward +w by the shortest rotation.
struct TurnToward {
    static constexpr std::string_view kMessageType = "toward";
    slicing::ElementKind element = slicing::ElementKind::cell;  ///< whether to turn a cell, a face, an edge or a vertex
    /// The index of the element among the elements of its kind. If absent, turnToward() in settings.hpp chooses an
    /// element.
    std::optional<std::size_t> number;
    bool immediately = false;  ///< whether to turn the object at once, without an animation
};
BOOST_DESCRIBE_STRUCT(TurnToward, (), (element, number, immediately))

/// A finer resolution level of a multiscale image. The level replaces the coarser level that is shown.
struct FinerImageLevel {
    std::uint32_t level = 0;  ///< the index of the level in the image; 0 is the finest
    /// The initial isovalue of the field at the coarser resolution. The finer field gets the same initial isovalue, so
    /// that a session that shows this isovalue keeps showing it.
    double initialLevel = 0;
    bool operator==(const FinerImageLevel&) const = default;
};
/// The command that loads an object from a file, or makes a field from a formula, and shows the object.
struct LoadObject {
    static constexpr std::string_view kMessageType = "load";
    std::string name;    ///< the name that the object gets
    std::string format;  ///< the name of the file format: "off", "points", "cloud", "formula", "npy" …
    /// The text of the file or the formula. For an array, the bytes of the file in Base64.
    std::string data;
    /// Whether undo treats the command and the previous command as one step, as while a user edits a formula. If true
    /// and a field replaces a field, FieldSettings stay the same. If both fields also have the same circumradius,
    /// HyperplaneSettings and the focus point stay the same, too.
    bool continues = false;
    /// The domain of the field. If absent, the domain of a formula is fields::kFormulaBox. The domain of an array is
    /// then the box that its file states or, if the file states none, fields::defaultBox().
    std::optional<fields::Box> box = {};
    std::optional<fields::Box> region = {};  ///< for a Zarr folder: the part of the array to read; absent for all
    /// For an array: the axes of its dimensions, such as "tzyx", where t means w. If empty, the file decides.
    std::string axes = {};
    /// For an array: the name of the variable in the file. If empty, the reader chooses a variable.
    std::string variable = {};
    std::string secondFormula = {};  ///< the formula of the field's second function; empty for none
    /// For an array: the variable in the same file that becomes the field's second function. Empty for none.
    std::string secondVariable = {};
    /// Whether to append the time steps in the file to the loaded array `name`, at its end along w, instead of
    /// replacing the array. Undo does not remove them: all states of the history show the longer array.
    bool append = false;
    /// An open file that contains an array; null if `data` contains the object. If `format` is empty, the format is
    /// recognized from the first bytes of the file.
    std::shared_ptr<const fields::FileHandle> file = {};
    /// Open files that contain one time step of an array each; empty if the object is elsewhere.
    std::vector<std::shared_ptr<const fields::FileHandle>> series = {};
    /// A Zarr folder that contains an array; null if the object is elsewhere.
    std::shared_ptr<const fields::FolderFileProvider> folder = {};
    std::string dataName = {};  ///< the name of an array in the server's data folder; empty if none
    /// For a polytope, a surface or points: the point about which the object turns.
    geometry::Centering center = {};
    /// For an array in the server's data folder: the resolution level to read. Set by loadCommandForFinerLevel() only.
    std::optional<FinerImageLevel> finer = {};

    /// Returns whether the object is an array in files or in a folder, not in `data`. The format of such an array may
    /// be empty.
    bool isArrayInFiles() const { return file || folder || !series.empty() || !dataName.empty(); }
    bool operator==(const LoadObject&) const = default;
};
/// A member of LoadObject that says how to read an object, and the name of this member in messages and in the queries
/// of uploads.
struct NamedLoadOption {
    std::string_view name;
    std::string LoadObject::* member;
};
inline constexpr auto kLoadTexts = std::to_array<NamedLoadOption>({{"format", &LoadObject::format},
                                                                   {"axes", &LoadObject::axes},
                                                                   {"variable", &LoadObject::variable},
                                                                   {"values", &LoadObject::secondFormula},
                                                                   {"values_variable", &LoadObject::secondVariable}});

/// The new values of the plain settings: those that a command only stores (see forEachSetting() in setting_table.hpp).
/// The names are those on the command line.
class PlainSettingValues {
  public:
    /// Returns a reference to the new value of the setting `name`, so that the caller can set it. Until then, the value
    /// is an empty optional. `Value` must be the type of the value in a State. `name` must be a string constant,
    /// because only a reference to its characters is stored.
    template <typename Value>
    std::optional<Value>& valueOf(std::string_view name) {
        std::any& value = values_.try_emplace(name, std::optional<Value>()).first->second;
        return std::any_cast<std::optional<Value>&>(value);
    }
    /// Returns the new value of the setting `name`, or an empty optional if the command does not change the setting.
    template <typename Value>
    const std::optional<Value>& valueOf(std::string_view name) const {
        static const std::optional<Value> none;
        const auto found = values_.find(name);
        return found == values_.end() ? none : std::any_cast<const std::optional<Value>&>(found->second);
    }

  private:
    std::map<std::string_view, std::any> values_;
};
/// The command that changes settings. Settings whose member is empty keep their values.
struct ChangeSettings {
    static constexpr std::string_view kMessageType = "set";
    bool continues = false;             ///< whether undo treats the change and the previous command as one step
    std::optional<std::string> object;  ///< the name of the object to show (see findObject())
    /// The formula of the field called `object`. The field is made and loaded first, unless the session already has the
    /// same field.
    std::optional<LoadObject> formula;
    std::optional<double> pace;  ///< the number of units of length per unit of w, which is time (ReferenceFrame::pace)
    /// Velocities of the frame of reference (ReferenceFrame::follow and ReferenceFrame::boost).
    std::optional<glm::dvec3> follow, boost;
    std::optional<glm::dmat4> orientation;
    std::optional<int> count;       ///< the number of slices, which is odd
    std::optional<double> spacing;  ///< the distance between neighboring slices
    std::optional<int> focus;       ///< the index of the focus slice, the slice in the middle
    /// The w of the hyperplane with the index 0.
    std::optional<double> offset;
    /// The w of the focus slice, in the coordinates of the object's file. Sets the focus and the offset (see
    /// moveFocusTo()).
    std::optional<double> focusW;
    /// The focus point, through which the planes of the matrix pass: (x, y, z, w), in the coordinates of the object's
    /// file. x, y and z set Look::focusPoint. w acts like `focusW`, but is ignored if `focus`, `offset` or `focusW` is
    /// present.
    std::optional<glm::dvec4> focusPoint;
    std::optional<bool> turning;  ///< whether the object turns continuously
    /// Whether the focus plays, that is, moves to and fro along w.
    std::optional<bool> playing;
    /// The isovalues of the surfaces of a field.
    std::optional<std::vector<double>> levels;
    /// The side of the isovalues that is inside the surfaces of a field.
    std::optional<fields::BodySide> inside;
    /// The fog (transfer function) of a field.
    std::optional<std::vector<slicing::FogControlPoint>> fog;
    /// Indices of hidden and of faded (translucent) cell types, in any order.
    std::optional<std::vector<std::uint32_t>> hidden, faded;
    /// The element that is highlighted in another color. The outer optional is empty if the highlight stays the same.
    /// The inner optional is empty if the command removes the highlight.
    std::optional<std::optional<slicing::Element>> highlight;
    std::optional<geometry::RotationAngles> lastTurn;  ///< the last rotation, which the keys '.' and space repeat
    PlainSettingValues plain;                          ///< all other settings
};
struct Undo {
    static constexpr std::string_view kMessageType = "undo";
};
BOOST_DESCRIBE_STRUCT(Undo, (), ())

struct Redo {
    static constexpr std::string_view kMessageType = "redo";
};
BOOST_DESCRIBE_STRUCT(Redo, (), ())

/// The command that restores the initial orientation and focus, and ends all motion.
struct ResetOrientationAndFocus {
    static constexpr std::string_view kMessageType = "reset";
};
BOOST_DESCRIBE_STRUCT(ResetOrientationAndFocus, (), ())

/// The command that replaces the orientation by a random rotation. All rotations are equally probable.
struct TurnAtRandom {
    static constexpr std::string_view kMessageType = "random";
    std::optional<std::uint64_t> seed;  ///< the same seed gives the same rotation; if absent, the seed is random
};
BOOST_DESCRIBE_STRUCT(TurnAtRandom, (), (seed))

/// The command that executes a line of the page's command line (see parseCommandLine()).
struct CommandLine {
    static constexpr std::string_view kMessageType = "command";
    std::string line;  ///< with or without the ':'
};
BOOST_DESCRIBE_STRUCT(CommandLine, (), (line))

/// The command that shows the view that the query of an address describes. Settings that the query does not contain
/// stay the same. But if the query contains an object or rotations, the orientation is first reset to the initial one.
struct ShowLinkedView {
    static constexpr std::string_view kMessageType = "address";
    std::string query;  ///< the query of the address, percent-encoded, without the question mark
};
BOOST_DESCRIBE_STRUCT(ShowLinkedView, (), (query))

using Command = std::variant<KeyPress, Rotate, TurnToward, TurnAtRandom, ChangeSettings, LoadObject, Undo, Redo,
                             ResetOrientationAndFocus, CommandLine, ShowLinkedView>;

}  // namespace oval4d::session
