#pragma once
// The encoder of PNG files.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "image/image.hpp"
#include "parallel/fork_join.hpp"

namespace oval4d::image {

/// Encodes images as 8-bit RGB PNG files. Not thread-safe: one thread at a time may use an encoder.
class PngEncoder {
  public:
    /// With `forkJoin`, large images are encoded on two cores.
    explicit PngEncoder(parallel::ForkJoin* forkJoin = nullptr) : forkJoin_(forkJoin) {}

    /// Writes `image` without alpha as a PNG file to `out`, which is overwritten and whose memory is reused. The UTF-8
    /// text `state` follows IHDR in an uncompressed iTXt chunk with the keyword "oval4d". Throws std::invalid_argument
    /// if the image is empty, lacks pixels or is larger than 2 GiB.
    void encode(const ImageView& image, std::string_view state, std::vector<std::uint8_t>& out);
    void encode(const Image& image, std::string_view state, std::vector<std::uint8_t>& out) {
        encode(ImageView{image.width, image.height, image.pixels}, state, out);
    }

  private:
    /// The encoding of some rows, and its buffers.
    struct Band {
        std::vector<std::uint8_t> filtered, levelBuffer, chunk;
        std::uint32_t checksum = 0;  // Adler-32 of `filtered`
    };
    static void encode(const ImageView& image, int from, int to, Band& band);

    parallel::ForkJoin* forkJoin_;
    std::array<Band, 2> bands_;
};

}  // namespace oval4d::image
