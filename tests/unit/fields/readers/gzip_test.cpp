#include "fields/readers/gzip.hpp"

#include <gtest/gtest.h>
#include <isa-l/igzip_lib.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace oval4d::fields::test {
namespace {

std::string gzipMember(std::string data) {
    isal_zstream stream;
    isal_deflate_stateless_init(&stream);
    stream.gzip_flag = IGZIP_GZIP;
    stream.end_of_stream = 1;
    std::string out(data.size() + 1000, '\0');
    stream.next_in = reinterpret_cast<std::uint8_t*>(data.data());
    stream.avail_in = static_cast<std::uint32_t>(data.size());
    stream.next_out = reinterpret_cast<std::uint8_t*>(out.data());
    stream.avail_out = static_cast<std::uint32_t>(out.size());
    EXPECT_EQ(isal_deflate_stateless(&stream), COMP_OK);
    out.resize(stream.total_out);
    return out;
}

// Returns a member with an extra field (RFC 1952, section 2.3.1.1) in its header, as bgzip writes it.
std::string withExtraField(std::string member) {
    constexpr std::size_t kFlags = 3, kHeader = 10;
    member[kFlags] = static_cast<char>(member[kFlags] | 4);
    return member.insert(kHeader, std::string_view("\x06\0BC\x02\0\xff\xff", 8));
}

std::span<const std::byte> spanOf(const std::string& text) {
    return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

// Reads `size` bytes in pieces of at most `piece` bytes. Returns the bytes, or the error message if reading fails.
std::string readInPieces(GzipReader& reader, std::size_t size, std::size_t piece) {
    std::string text(size, '\0');
    const std::span<std::byte> to(reinterpret_cast<std::byte*>(text.data()), size);
    for (std::size_t done = 0; done < size; done += piece) {
        const auto filled = reader.decompressInto(to.subspan(done, std::min(piece, size - done)));
        if (!filled) return filled.error().message;
    }
    return text;
}

const std::string kFirstMember = "The first member. " + std::string(1000, 'a'), kSecondMember = "The second member.";

TEST(GzipReader, ReadsAllMembers) {
    const std::string all = kFirstMember + kSecondMember;
    const std::string empty = withExtraField(gzipMember(""));
    for (const std::string& file :
         {gzipMember(all), gzipMember(kFirstMember) + gzipMember(kSecondMember),
          gzipMember(kFirstMember) + withExtraField(gzipMember(kSecondMember)),
          empty + gzipMember(kFirstMember) + empty + empty + gzipMember(kSecondMember) + empty}) {
        for (const std::size_t piece : {all.size(), kFirstMember.size(), std::size_t{7}, std::size_t{1}}) {
            GzipReader reader(spanOf(file));
            EXPECT_EQ(readInPieces(reader, all.size(), piece), all) << piece;
            EXPECT_TRUE(reader.verifyEnd()) << piece;
        }
        GzipReader reader(spanOf(file));
        EXPECT_EQ(readInPieces(reader, all.size() + 1, all.size() + 1), "the compressed file is incomplete");
    }
}

TEST(GzipReader, FindsBytesAndFaultsInLaterMembers) {
    const std::string file = gzipMember(kFirstMember) + gzipMember(kSecondMember);
    GzipReader left(spanOf(file));
    EXPECT_EQ(readInPieces(left, kFirstMember.size(), kFirstMember.size()), kFirstMember);
    EXPECT_FALSE(left.verifyEnd());
    const std::string shorter = file.substr(0, file.size() - 1);
    GzipReader cut(spanOf(shorter));
    EXPECT_EQ(readInPieces(cut, kFirstMember.size() + kSecondMember.size(), 1), kFirstMember + kSecondMember);
    EXPECT_FALSE(cut.verifyEnd());
    const std::string padded = gzipMember(kFirstMember) + std::string(100, '\0');  // padding, as on tapes
    GzipReader tail(spanOf(padded));
    EXPECT_EQ(readInPieces(tail, kFirstMember.size(), kFirstMember.size()), kFirstMember);
    EXPECT_TRUE(tail.verifyEnd());
    EXPECT_EQ(readInPieces(tail, 1, 1), "the compressed file is incomplete");
}

}  // namespace
}  // namespace oval4d::fields::test
