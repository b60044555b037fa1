#include "fields/readers/npy.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fields/readers/axis_mapping.hpp"
#include "text/message_text.hpp"

namespace oval4d::fields {

namespace {

constexpr std::string_view kMagic("\x93NUMPY", 6);
constexpr std::size_t kMaxHeader = 65'536;  // the maximum size of a header in bytes; usual headers have less than 200
constexpr std::size_t kMaxNumpyDimensions = 32;          // the maximum number of dimensions of an array in NumPy 1
constexpr std::size_t kMaxSize = std::size_t{1} << 48U;  // the maximum size of a dimension in a header

struct NpyHeader {
    std::string_view descr;
    bool fortranOrder = false;
    std::vector<std::size_t> shape;
};

// Parses the header of a .npy file, a Python dictionary: {'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }.
// Accepts only these three members, in any order.
class NpyHeaderParser {
  public:
    explicit NpyHeaderParser(std::string_view text) : text_(text) {}

    std::optional<NpyHeader> parse() {
        NpyHeader header;
        if (!take('{')) return {};
        unsigned seen = 0;
        while (!take('}')) {
            std::string_view key;
            if (!takeString(key) || !take(':')) return {};
            const auto* const member = std::find(kMembers.begin(), kMembers.end(), key);
            const unsigned bit = 1U << static_cast<unsigned>(member - kMembers.begin());
            if (member == kMembers.end() || (seen & bit) != 0) return {};
            seen |= bit;
            const bool parsed = bit == 1   ? takeString(header.descr)
                                : bit == 2 ? takeBoolean(header.fortranOrder)
                                           : takeTuple(header.shape);
            if (!parsed) return {};
            if (!take(',') && !nextIs('}')) return {};
        }
        skipBlanks();
        if (!text_.empty() || seen != 7) return {};
        return header;
    }

  private:
    static constexpr std::array<std::string_view, 3> kMembers{"descr", "fortran_order", "shape"};

    void skipBlanks() { text_.remove_prefix(std::min(text_.find_first_not_of(" \t\r\n"), text_.size())); }
    bool nextIs(char c) {
        skipBlanks();
        return text_.starts_with(c);
    }
    bool take(char c) {
        if (!nextIs(c)) return false;
        text_.remove_prefix(1);
        return true;
    }
    bool takeWord(std::string_view word) {
        skipBlanks();
        if (!text_.starts_with(word)) return false;
        text_.remove_prefix(word.size());
        return true;
    }
    bool takeString(std::string_view& string) {
        skipBlanks();
        if (!text_.starts_with('\'') && !text_.starts_with('"')) return false;
        const std::size_t end = text_.find(text_.front(), 1);
        if (end == std::string_view::npos) return false;
        string = text_.substr(1, end - 1);
        text_.remove_prefix(end + 1);
        return string.find('\\') == std::string_view::npos;
    }
    bool takeBoolean(bool& value) {
        value = takeWord("True");
        return value || takeWord("False");
    }
    bool takeNumber(std::size_t& number) {
        skipBlanks();
        std::size_t digits = 0;
        number = 0;
        for (; digits < text_.size() && '0' <= text_[digits] && text_[digits] <= '9'; ++digits) {
            number = number * 10 + static_cast<std::size_t>(text_[digits] - '0');
            if (number > kMaxSize) return false;
        }
        text_.remove_prefix(digits);
        takeWord("L");  // the suffix of long integers in Python 2
        return digits > 0;
    }
    bool takeTuple(std::vector<std::size_t>& numbers) {
        if (!take('(')) return false;
        while (!take(')')) {
            if (numbers.size() == kMaxNumpyDimensions || !takeNumber(numbers.emplace_back())) return false;
            if (!take(',') && (numbers.size() == 1 || !nextIs(')'))) return false;  // (3) is a number, not a tuple
        }
        return true;
    }

    std::string_view text_;
};

}  // namespace

bool isNpyStart(std::span<const std::byte> start) {
    return std::string_view(reinterpret_cast<const char*>(start.data()), start.size()).starts_with(kMagic);
}

Result<FieldArray> readNpy(const FileContents& file, const FieldReadOptions& options) {
    const std::string_view bytes(reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size());
    if (!isNpyStart(file.bytes)) return badFieldError("the file is not in NumPy's format .npy");
    const auto byteAt = [&](std::size_t i) { return std::size_t{static_cast<unsigned char>(bytes[i])}; };
    if (bytes.size() < kMagic.size() + 2) return badFieldError("the header of the file is incomplete");
    const std::size_t version = byteAt(6), lengthSize = version == 1 ? 2 : 4, headerAt = 8 + lengthSize;
    if (version < 1 || version > 3)
        return badFieldError("version " + std::to_string(version) + " of the format is not known");
    if (bytes.size() < headerAt) return badFieldError("the header of the file is incomplete");
    std::size_t length = 0;
    for (std::size_t i = headerAt; i-- > 8;) length = length << 8U | byteAt(i);
    if (length > kMaxHeader) return badFieldError("the header of the file is too long");
    if (bytes.size() - headerAt < length) return badFieldError("the header of the file is incomplete");

    const auto header = NpyHeaderParser(bytes.substr(headerAt, length)).parse();
    if (!header) {
        return badFieldError(
            "the header of the file cannot be read; it must be {'descr': …, 'fortran_order': …, 'shape': …}, as of "
            "an array of numbers");
    }
    const auto format = numberFormatOf(header->descr);
    if (!format) {
        return badFieldError("the type of the numbers is " + text::inQuotes(header->descr) +
                             "; it must be Boolean, integer or real");
    }
    auto shape = header->shape;
    if (header->fortranOrder) std::reverse(shape.begin(), shape.end());  // from the slowest dimension to the fastest
    const std::vector<std::size_t> kept = squeezedDimensionIndices(shape);
    auto axes = parseAxes(options.axes, kept.size());
    if (!axes) return axes.error();
    // `options.axes` has the order of the shape in the header, so its axes are reversed like the shape.
    if (header->fortranOrder) std::reverse(axes->begin(), axes->end());
    std::vector<ArrayDimension> dimensions;
    for (std::size_t i = 0; i < kept.size(); ++i) dimensions.push_back({shape[kept[i]], (*axes)[i]});
    const auto mapping = AxisMapping::fromDimensions(dimensions, options.maxSamples);
    if (!mapping) return mapping.error();
    const auto data = file.bytes.subspan(headerAt + length);
    const std::size_t size = mapping->count() * sizeOf(format->type);
    if (data.size() < size) {
        return badFieldError("the array should take " + std::to_string(size) +
                             " bytes after the header, but the file has only " + std::to_string(data.size()));
    }
    FieldArray field;
    if (data.size() > size) field.warnings.emplace_back("the file is longer than its array; the rest is ignored");
    field.shape = mapping->shape();
    const bool time = options.axes.empty() || options.axes.find('t') != std::string::npos;
    field.boxIsKnown = options.box.has_value();
    field.box = options.box.value_or(defaultBox(field.shape, time));
    auto samples = mapping->samples(file, data, *format, options);
    if (!samples) return samples.error();
    field.samples = std::move(*samples);
    return field;
}

}  // namespace oval4d::fields
