#include "store/cbor.hpp"

#include "text/message_text.hpp"

namespace oval4d::store {

using nlohmann::json;

namespace {

constexpr std::size_t kMaxDepth = 16;  // the maximum nesting depth of arrays and objects in a record
// The maximum length of a short text: 64 characters with at most 4 bytes each, in UTF-8.
constexpr std::size_t kMaxNameBytes = 256;

/// A handler of parser events (SAX) that stops parsing if values are nested too deeply. The limit is needed because the
/// parser uses stack space for each level. Declared sizes of arrays need no limit: the parser allocates nothing for
/// them, and each byte of input yields at most one value.
class NestingDepthLimiter : public json::json_sax_t {
  public:
    bool null() override { return true; }
    bool boolean(bool /*value*/) override { return true; }
    bool number_integer(number_integer_t /*value*/) override { return true; }
    bool number_unsigned(number_unsigned_t /*value*/) override { return true; }
    bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return true; }
    bool string(string_t& /*value*/) override { return true; }
    bool binary(binary_t& /*value*/) override { return true; }
    bool key(string_t& /*value*/) override { return true; }
    bool start_object(std::size_t /*size*/) override { return ++depth_ <= kMaxDepth; }
    bool start_array(std::size_t /*size*/) override { return ++depth_ <= kMaxDepth; }
    bool end_object() override { return --depth_, true; }
    bool end_array() override { return --depth_, true; }
    bool parse_error(std::size_t /*position*/, const std::string& /*token*/, const json::exception& fault) override {
        throwUnreadableRecord(fault.what());
    }

  private:
    std::size_t depth_ = 0;
};

}  // namespace

void throwUnreadableRecord(const std::string& what) { throw UnreadableRecord(what); }

void throwLaterRecord(const std::string& what) {
    throw NewerVersionRecord("a later version of oval4d has stored it: " + what);
}

std::string encodeCbor(const json& value) {
    std::string bytes;
    json::to_cbor(value, bytes);
    return bytes;
}

json parseRecord(std::string_view bytes, int latestVersion) {
    NestingDepthLimiter limiter;
    if (!json::sax_parse(bytes, &limiter, json::input_format_t::cbor)) throwUnreadableRecord("it is nested too deeply");
    json value = json::from_cbor(bytes);
    if (!value.is_array() || value.empty()) throwUnreadableRecord("it is not a session record");
    const json& version = value.at(0);
    const auto number = version.is_number_integer() ? version.get<std::int64_t>() : 0;
    if (number < 1 || number > latestVersion) {
        const std::string what = "it has version " + version.dump() + ", and this program reads version " +
                                 (latestVersion == 1 ? "1" : "1 to " + std::to_string(latestVersion));
        if (number > latestVersion) throwLaterRecord(what);
        throwUnreadableRecord(what);
    }
    return value;
}

void refuseUnknownMembers(const json& array, std::size_t known) {
    if (array.size() > known) throwLaterRecord("it has settings that this version does not know");
}

double readNumber(const json& value, double least, double most) {
    const auto found = value.get<double>();
    if (!(found >= least && found <= most)) throwLaterRecord("a number is out of range");
    return found;
}

double readNumber(const json& value, double most) { return readNumber(value, -most, most); }

std::vector<std::uint32_t> readIntegers(const json& value) {
    std::vector<std::uint32_t> list;
    for (const json& each : value) list.push_back(readInteger<std::uint32_t>(each));
    return list;
}

void checkShortText(std::string_view text) {
    if (text.size() > kMaxNameBytes || !text::isUtf8(text)) throwUnreadableRecord("a name is too long or is not UTF-8");
}

std::string readShortText(const json& value) {
    auto text = value.get<std::string>();
    checkShortText(text);
    return text;
}

}  // namespace oval4d::store
