# Writes OUTPUT, a C++ source file that contains the text of FILES (paths relative to ROOT).
set(entries "")
foreach(file IN LISTS FILES)
  file(READ ${ROOT}/${file} text)
  string(APPEND entries "    File{\"${file}\", R\"oval4d(${text})oval4d\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"protocol_data/embedded_files.hpp\"

#include <array>
#include <cstddef>

namespace oval4d::protocol_data {

namespace {
struct File {
    std::string_view path, text;
};
constexpr auto kFiles = std::to_array<File>({
${entries}});
}  // namespace

std::span<const std::string_view> embeddedPaths() {
    static const auto paths = [] {
        std::array<std::string_view, kFiles.size()> all;
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = kFiles[i].path;
        return all;
    }();
    return paths;
}

std::string_view embeddedFile(std::string_view path) {
    for (const File& file : kFiles) {
        if (file.path == path) return file.text;
    }
    return {};
}

}  // namespace oval4d::protocol_data
")
