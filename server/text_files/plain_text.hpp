#pragma once

#include <string>
#include <string_view>

namespace oval4d::text_files {

/// Returns the text of a file in UTF-8, without a byte order mark. Converts UTF-16, which is recognized by its byte
/// order mark or, without a mark, by exactly one zero among its first two bytes. Replaces all line ends by "\n", and
/// vertical tabs, form feeds and Unicode spaces by U+0020. Keeps bytes that are not valid UTF-8, because they are
/// usually in comments. Throws a FileError if the file is empty, contains a zero byte, or begins like a file of another
/// kind, such as a compressed file, a picture or a web page. The error names this kind.
std::string decodePlainText(std::string_view bytes);

}  // namespace oval4d::text_files
