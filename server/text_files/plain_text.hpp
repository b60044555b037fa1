#pragma once

#include <string>
#include <string_view>

namespace oval4d::text_files {

/// Returns the text of a file in UTF-8, without a byte order mark. Converts UTF-16. A file is in UTF-16 if it begins
/// with the byte order mark of UTF-16, or if exactly one of its first two bytes is zero. Replaces all line ends by
/// "\n", and vertical tabs, form feeds and Unicode spaces by U+0020. Keeps bytes that are not valid UTF-8, because they
/// are usually in comments. Throws a FileError if the file is empty or blank, or if its text contains a zero byte. Also
/// throws a FileError if the file begins like a file of another kind, such as a picture or a web page; the error names
/// this kind.
std::string decodePlainText(std::string_view bytes);

}  // namespace oval4d::text_files
