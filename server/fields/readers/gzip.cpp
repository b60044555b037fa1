#include "fields/readers/gzip.hpp"

#include <isa-l/igzip_lib.h>

#include <algorithm>
#include <cstdint>

namespace oval4d::fields {

namespace {
// The number of bytes by which the output grows at a time. A file that states a large array but contains little
// therefore takes little memory.
constexpr std::size_t kStep = std::size_t{64} << 20U;
}  // namespace

struct GzipReader::State {
    inflate_state inflate;
    std::span<const std::byte> rest;

    // Gives the library the next compressed bytes if it has used all bytes that it was given.
    void refill() {
        if (inflate.avail_in > 0) return;
        const std::size_t count = std::min<std::size_t>(rest.size(), kStep);
        // ISA-L does not change its input, although its type is not const.
        inflate.next_in = const_cast<std::uint8_t*>(reinterpret_cast<const std::uint8_t*>(rest.data()));
        inflate.avail_in = static_cast<std::uint32_t>(count);
        rest = rest.subspan(count);
    }

    // Prepares the library for its next call. If a member of a gzip file (RFC 1952, section 2.2) has ended, begins the
    // next member. Calls refill(). Returns false if the member or zlib stream has ended and no member follows.
    bool prepareNextInflate() {
        if (inflate.block_state == ISAL_BLOCK_FINISH) {
            // The bytes of `rest` directly follow the bytes that the library has not used yet.
            const std::span left(reinterpret_cast<const std::byte*>(inflate.next_in), inflate.avail_in + rest.size());
            if (inflate.crc_flag != ISAL_GZIP || !isGzipStart(left)) return false;
            isal_inflate_reset(&inflate);
        }
        refill();
        return true;
    }
};

bool isGzipStart(std::span<const std::byte> start) {
    return start.size() >= 2 && start[0] == std::byte{0x1f} && start[1] == std::byte{0x8b};
}

GzipReader::GzipReader(std::span<const std::byte> compressed, StreamFormat format) : state_(std::make_unique<State>()) {
    isal_inflate_init(&state_->inflate);
    state_->inflate.crc_flag = format == StreamFormat::gzip ? ISAL_GZIP : ISAL_ZLIB;
    state_->rest = compressed;
}

GzipReader::~GzipReader() = default;

Result<std::monostate> GzipReader::extendTo(std::size_t size, std::vector<std::byte>& to) {
    while (to.size() < size) {
        const std::size_t before = to.size();
        to.resize(std::min(size, before + kStep));
        if (auto filled = decompressInto(std::span(to).subspan(before)); !filled) return filled;
    }
    return std::monostate{};
}

Result<std::monostate> GzipReader::decompressInto(std::span<std::byte> to) {
    inflate_state& inflate = state_->inflate;
    while (!to.empty()) {
        if (!state_->prepareNextInflate()) return Error{ErrorCode::bad_field, "the compressed file is incomplete"};
        const auto room = static_cast<std::uint32_t>(std::min(to.size(), kStep));
        inflate.next_out = reinterpret_cast<std::uint8_t*>(to.data());
        inflate.avail_out = room;
        const int status = isal_inflate(&inflate);
        const bool stuck = inflate.avail_out == room && inflate.avail_in == 0 && state_->rest.empty();
        to = to.subspan(room - inflate.avail_out);
        if (status != ISAL_DECOMP_OK) return Error{ErrorCode::bad_field, "the compressed file is faulty"};
        if (stuck) return Error{ErrorCode::bad_field, "the compressed file is incomplete"};
    }
    return std::monostate{};
}

bool GzipReader::verifyEnd() {
    inflate_state& inflate = state_->inflate;
    std::uint8_t more = 0;
    while (state_->prepareNextInflate()) {  // the checksum or an empty member may follow the last decompressed byte
        inflate.next_out = &more;
        inflate.avail_out = 1;
        if (isal_inflate(&inflate) != ISAL_DECOMP_OK || inflate.avail_out == 0) return false;
        const bool noneLeft = inflate.avail_in == 0 && state_->rest.empty();
        if (noneLeft && inflate.block_state != ISAL_BLOCK_FINISH) return false;
    }
    return true;
}

}  // namespace oval4d::fields
