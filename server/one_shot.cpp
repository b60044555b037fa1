#include "one_shot.hpp"

#include <fstream>
#include <iostream>

namespace oval4d {

session::Query queryOf(const std::vector<std::string>& words) {
    session::Query query;
    for (auto word = words.begin(); word != words.end(); ++word) {
        if (!word->starts_with("--"))
            throw std::runtime_error("'" + *word + "' is not an option; options begin with --");
        const std::size_t equals = word->find('=');
        const std::string name = word->substr(2, equals == std::string::npos ? equals : equals - 2);
        if (equals != std::string::npos) {
            query.emplace_back(name, word->substr(equals + 1));
        } else if (++word != words.end()) {
            query.emplace_back(name, *word);
        } else {
            throw std::runtime_error("--" + name + " needs a value");
        }
    }
    return query;
}

void writeOutput(const std::string& path, std::string_view bytes) {
    std::ofstream file;
    if (path != "-") file.open(path, std::ios::binary);
    std::ostream& out = path == "-" ? std::cout : file;
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.flush();
    if (!out) throw std::runtime_error("cannot write to " + path);
}

}  // namespace oval4d
