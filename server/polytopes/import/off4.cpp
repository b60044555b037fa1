#include "polytopes/import/off4.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "text/ascii.hpp"
#include "text/message_text.hpp"
#include "text/words.hpp"
#include "text_files/file_error.hpp"
#include "text_files/tokenizer.hpp"

namespace oval4d::polytopes {

using text::inQuotes;
using text_files::FileError;
using text_files::parseCoordinate;
using text_files::parseCount;
using text_files::throwFileError;
using text_files::Tokenizer;

namespace {

// The lengths in bytes of the shortest records of a vertex, a 2-face and a cell: "0 0 0 0\n", "3 0 1 2\n", "4 0 1 2
// 3\n".
constexpr std::size_t kVertexBytes = 8, kFaceBytes = 8, kCellBytes = 10;

// The keyword of a file may say that more numbers follow the coordinates of a vertex. The constants say how many such
// numbers there are for the letter C (a color: red, green, blue, opacity), for N (a normal vector) and for ST (texture
// coordinates) (Geomview, OFF file format).
constexpr int kColorNumbers = 4, kNormalNumbers = 4, kTextureNumbers = 2;

constexpr std::string_view kKeyword = "off";

// The numbers in the header of a 4OFF file.
struct Off4Header {
    std::uint32_t vertices = 0, faces = 0, edges = 0, cells = 0;
    int numbersPerVertex = 4;  // the number of numbers for each vertex, including its coordinates
};

// Reads the keyword: [ST][C][N][4][n]OFF. The number of vertices may follow the keyword in the same word. Returns the
// number of numbers for each vertex, including its coordinates.
int readKeyword(Tokenizer& file) {
    const std::string_view word = file.nextWord();
    const std::string keyword = text::normalizedName(word);
    const std::size_t at = keyword.find(kKeyword);
    std::string_view letters = std::string_view(keyword).substr(0, std::min(at, keyword.size()));
    int numbers = 4;
    const auto take = [&](std::string_view letter, int more) {
        if (!letters.starts_with(letter)) return;
        letters.remove_prefix(letter.size());
        numbers += more;
    };
    take("st", kTextureNumbers);
    take("c", kColorNumbers);
    take("n", letters == "n" ? 0 : kNormalNumbers);
    const bool four = letters.starts_with('4');
    take("4", 0);
    const std::string_view rest =
        at == std::string::npos ? std::string_view{} : std::string_view(keyword).substr(at + kKeyword.size());
    if (at != std::string::npos && letters.empty() && keyword.find('n') < at && !four)
        throwFileError(file.lineNumber(),
                       inQuotes(word) +
                           " cannot be read; a file must begin with 4OFF, or be a list of points x y z w, "
                           "whose convex hull is shown");
    if (!four || !letters.empty() || !(rest.empty() || text::isDigit(rest.front())))
        throwFileError(file.lineNumber(), "the file must begin with 4OFF, not " + inQuotes(word));
    file.putBack(rest.size());
    return numbers;
}

Off4Header readHeader(Tokenizer& file) {
    Off4Header header;
    header.numbersPerVertex = readKeyword(file);
    const auto count = [&](std::string_view word, const char* what) {
        return parseCount(word, file.lineNumber(), what);
    };
    std::string_view word = file.nextWord();
    if (text::normalizedName(word) == "binary")
        throwFileError(file.lineNumber(), "the file is in the binary form of OFF; only its text form can be read");
    header.vertices = count(word, "a number of vertices");
    header.faces = count(file.nextWord(), "a number of 2-faces");
    header.edges = count(file.nextWord(), "a number of edges");
    word = file.nextWordOnLine();
    if (word.empty()) {
        // The line has only three counts. Either the fourth count follows on a line of its own, or the file has no
        // cells and no fourth count, as in files of Geomview.
        const Tokenizer afterThree = file;
        word = file.nextWord();
        const bool alone = !word.empty() && file.nextWordOnLine().empty();
        if (!alone) {
            file = afterThree;
            return header;
        }
    }
    header.cells = count(word, "a number of cells");
    return header;
}

// The name of a type of elements, in the singular and the plural.
struct SingularAndPlural {
    std::string one, many;
};

// The way in which the records of a kind (vertices, 2-faces or cells) are divided into lines:
// - `lines`: each record begins on a new line and may continue on further lines; words after the record are ignored.
// - `continuous`: line breaks do not matter.
// - `own_lines`: each record begins and ends on a line of its own.
enum class Off4RecordLayout { lines, continuous, own_lines };

// Returns the next word of a record. With Off4RecordLayout::own_lines, throws a FileError if the current line has no
// further word; the error says that `record` has only `found` of `needed` `members`. With another layout, returns an
// empty text at the end of the file.
std::string_view nextRecordWord(Tokenizer& file, Off4RecordLayout layout, const std::string& record,
                                std::uint32_t found, std::uint32_t needed, const char* members) {
    if (layout != Off4RecordLayout::own_lines) return file.nextWord();
    const std::string_view word = file.nextWordOnLine();
    if (word.empty())
        throwFileError(file.lineNumber(),
                       record + " has " + std::to_string(found) + " of " + std::to_string(needed) + ' ' + members);
    return word;
}

void readVertices(Tokenizer& file, const Off4Header& header, Off4RecordLayout layout,
                  std::vector<glm::dvec4>& vertices) {
    vertices.resize(header.vertices);
    for (std::size_t n = 0; n < vertices.size(); ++n) {
        if (layout != Off4RecordLayout::continuous) file.skipLine();
        for (int i = 0; i < 4; ++i) {
            const auto word = i == 0 ? file.nextWord()
                                     : nextRecordWord(file, layout, "vertex " + std::to_string(n), i, 4, "coordinates");
            vertices[n][i] = parseCoordinate(word, file.lineNumber());
        }
        for (int i = 4; layout == Off4RecordLayout::continuous && i < header.numbersPerVertex; ++i) {
            const auto word = file.nextWord();
            parseCoordinate(word, file.lineNumber());
        }
    }
}

// The least and the greatest number of indices in a record.
struct RecordSizeRange {
    std::size_t least, most;
};

// Reads `records` records into `lists`, and their positions in the file into `positions`. A record is a number within
// `sizes`, followed by that many indices, each less than `below`. Error messages contain `what` and `member`: if they
// are "2-face" and "vertex", a message may say that "2-face 7" has too few vertices.
void readIndexLists(Tokenizer& file, Off4RecordLayout layout, std::uint32_t records, std::size_t below,
                    RecordSizeRange sizes, const std::string& what, const SingularAndPlural& member,
                    geometry::JaggedArray& lists, std::vector<PolygonSoup::SourcePosition>& positions) {
    lists.begin.reserve(std::size_t{records} + 1);
    std::vector<std::uint32_t> list;
    for (std::uint32_t i = 0; i < records; ++i) {
        if (layout != Off4RecordLayout::continuous) file.skipLine();
        const std::string owner = what + " " + std::to_string(i);
        const auto first = file.nextWord();
        if (first.empty())
            throwFileError(file.lineNumber(), "the file ends before " + owner + " of " + std::to_string(records));
        const std::size_t lineNumber = file.lineNumber();
        const std::uint32_t size = parseCount(first, lineNumber, "the size of " + owner);
        if (size < sizes.least || size > sizes.most) {
            throwFileError(lineNumber, owner + " has " + std::to_string(size) + " " + member.many + "; " +
                                           std::to_string(sizes.least) + " to " + std::to_string(sizes.most) +
                                           " are allowed");
        }
        list.clear();
        for (std::uint32_t j = 0; j < size; ++j) {
            const auto word = nextRecordWord(file, layout, owner, j, size, member.many.c_str());
            const std::uint32_t index = parseCount(word, file.lineNumber(), "the number of a " + member.one);
            if (index >= below) {
                throwFileError(file.lineNumber(), owner + " refers to " + member.one + ' ' + std::to_string(index) +
                                                      ", but the last is " + member.one + ' ' +
                                                      std::to_string(below - 1));
            }
            list.push_back(index);
        }
        lists.add(list);
        positions.push_back({lineNumber, i});
    }
}

// The layouts of the records of vertices, 2-faces and cells, in this order. readOff4() tries several combinations,
// because the three layouts may differ.
using Off4RecordLayouts = std::array<Off4RecordLayout, 3>;

// Reads all records of the file. `file` must stand at the first record, after the header.
PolygonSoup readRecords(Tokenizer file, const Off4Header& header, const Off4RecordLayouts& layouts) {
    PolygonSoup soup;
    readVertices(file, header, layouts[0], soup.vertices);
    // The greatest sizes limit the use of memory. If there are cells, the loop of a 2-face may have more corners than
    // the file has vertices: it may pass through a vertex more than once, and repair() splits it at this vertex.
    const std::size_t mostCorners = std::size_t{header.vertices} * (header.cells > 0 ? 2 : 1);
    readIndexLists(file, layouts[1], header.faces, header.vertices, {3, mostCorners}, "2-face", {"vertex", "vertices"},
                   soup.faces, soup.faceSourcePositions);
    readIndexLists(file, layouts[2], header.cells, header.faces, {4, 2 * std::size_t{header.faces}}, "cell",
                   {"2-face", "2-faces"}, soup.cells, soup.cellSourcePositions);
    if (layouts[2] != Off4RecordLayout::continuous) file.skipLine();
    if (const auto rest = file.nextWord(); !rest.empty())
        throwFileError(file.lineNumber(),
                       inQuotes(rest) + " follows the last " + (header.cells > 0 ? "cell" : "2-face"));
    return soup;
}

// If the file has as many lines as records, returns the fault of the first record whose line has too few words.
// Otherwise returns an empty optional. Without this function, the error would name a later record: a reader that
// ignores line breaks completes the short record with words of the next line. `file` must stand after the header.
std::optional<FileError> firstShortRecordFault(Tokenizer file, const Off4Header& header) {
    const std::size_t records = std::size_t{header.vertices} + header.faces + header.cells;
    Tokenizer counted = file;
    if (!counted.nextWordOnLine().empty()) return {};
    std::size_t lines = 0;
    for (; lines <= records && !counted.nextWord().empty(); ++lines) counted.skipLine();
    if (lines != records) return {};
    try {
        readRecords(file, header,
                    {Off4RecordLayout::own_lines, Off4RecordLayout::own_lines, Off4RecordLayout::own_lines});
    } catch (const FileError& fault) {
        return fault;
    }
    return {};
}

}  // namespace

Off4Contents readOff4(std::string_view text, std::size_t maxVertices) {
    Tokenizer file(text);
    const Off4Header header = readHeader(file);
    if (header.vertices > maxVertices)
        throw FileError{file.lineNumber(),
                        std::to_string(header.vertices) + " vertices are too many; at most " +
                            std::to_string(maxVertices) + " are allowed",
                        true};
    if (header.vertices * kVertexBytes + header.faces * kFaceBytes + header.cells * kCellBytes > text.size() + 1)
        throwFileError(file.lineNumber(), "the file is too short for its numbers of vertices, 2-faces and cells");
    try {
        return {readRecords(file, header, {Off4RecordLayout::lines, Off4RecordLayout::lines, Off4RecordLayout::lines}),
                header.edges,
                {}};
    } catch (const FileError&) {
        const auto shortRecord = firstShortRecordFault(file, header);
        for (const Off4RecordLayout vertices : {Off4RecordLayout::continuous, Off4RecordLayout::lines}) {
            for (const Off4RecordLayout faces : {Off4RecordLayout::lines, Off4RecordLayout::continuous}) {
                for (const Off4RecordLayout cells : {Off4RecordLayout::lines, Off4RecordLayout::continuous}) {
                    try {
                        return {readRecords(file, header, {vertices, faces, cells}), header.edges, shortRecord};
                    } catch (const FileError&) {
                        continue;
                    }
                }
            }
        }
        if (shortRecord) throw FileError(*shortRecord);
        throw;
    }
}

bool listsCells(std::string_view text) {
    Tokenizer file(text);
    return readHeader(file).cells > 0;
}

bool isOffFormat(std::string_view text) {
    const std::string word = text::normalizedName(Tokenizer(text).nextWord());
    const std::size_t at = word.find(kKeyword);
    if (at == std::string::npos) return false;
    const std::string_view letters = std::string_view(word).substr(0, at);
    const std::string_view rest = std::string_view(word).substr(at + kKeyword.size());
    return letters.find_first_not_of("stcn0123456789") == std::string_view::npos &&
           (rest.empty() || text::isDigit(rest.front()));
}

}  // namespace oval4d::polytopes
