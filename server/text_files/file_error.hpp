#pragma once

#include <cstddef>
#include <string>
#include <utility>

namespace oval4d::text_files {

/// The reason why a file was refused. Functions that read files throw a FileError.
struct FileError {
    std::size_t line = 0;  ///< the line of the fault, counted from 1; 0 if the fault is not in one line
    std::string reason;
    bool tooLarge = false;  ///< whether the reason is that the file exceeds a limit, such as a maximum number of points
    /// The column of a table, counted from 1; 0 if the fault is not in one column.
    std::size_t column = 0;
};

/// Throws a FileError with this line, reason and column.
[[noreturn]] inline void throwFileError(std::size_t line, std::string reason, std::size_t column = 0) {
    throw FileError{line, std::move(reason), false, column};
}

/// Returns the error as a text for the user, such as "line 2, column 3: …". Returns only the reason if `error.line` is
/// 0.
inline std::string fileErrorText(const FileError& error) {
    if (error.line == 0) return error.reason;
    std::string text = "line " + std::to_string(error.line);
    if (error.column > 0) text += ", column " + std::to_string(error.column);
    return text + ": " + error.reason;
}

}  // namespace oval4d::text_files
