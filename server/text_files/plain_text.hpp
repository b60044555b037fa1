#pragma once

#include <string>
#include <string_view>

namespace oval4d::text_files {

/// Returns the text of a file, in UTF-8 without a byte order mark. Converts UTF-16, which is recognized by its byte
/// order mark or, without such a mark, by the fact that exactly one of the first two bytes is zero. Replaces all line
/// ends by "\n", and vertical tabs, form feeds and the spaces of Unicode by U+0020. Keeps bytes that are not UTF-8,
/// because they usually stand in comments. Throws a FileError if the file is empty, contains a zero byte, or begins
/// like a file of another kind, such as a compressed file, a picture or a web page. The reason in the error names this
/// kind.
std::string plainText(std::string_view bytes);

}  // namespace oval4d::text_files
