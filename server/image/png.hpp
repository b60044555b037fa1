#pragma once
// Encodes images as PNG files.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "image/image.hpp"
#include "parallel/fork_join.hpp"

namespace oval4d::image {

/// Encodes images as PNG files with 8 bits per channel. Only one thread at a time may use an encoder.
class PngEncoder {
  public:
    /// If `forkJoin` (a helper thread) is not null, the encoder uses it to encode large images on two cores. `forkJoin`
    /// must outlive this object.
    explicit PngEncoder(parallel::ForkJoin* forkJoin = nullptr) : forkJoin_(forkJoin) {}

    /// Encodes `image` as an RGB file or, if ImageView::hasAlpha is true, as an RGBA file. Overwrites `out` and reuses
    /// its memory. Before the image data, the file contains the UTF-8 text `state` in an uncompressed iTXt chunk with
    /// the keyword "oval4d". Throws std::invalid_argument if the image is empty, if `pixels` has not
    /// 4 · width · height bytes, or if the uncompressed data exceed 2 GiB. Throws std::runtime_error if compression
    /// fails.
    void encode(const ImageView& image, std::string_view state, std::vector<std::uint8_t>& out);
    void encode(const Image& image, std::string_view state, std::vector<std::uint8_t>& out) {
        encode(ImageView{image.width, image.height, image.pixels}, state, out);
    }

  private:
    // The upper or the lower half of an image, or a whole small image. `filtered` contains its rows after PNG filtering
    // (see makeFilteredRows()), `levelBuffer` is working memory of the compressor, and `chunk` is the IDAT chunk that
    // contains the compressed rows.
    struct ImageBand {
        std::vector<std::uint8_t> filtered, levelBuffer, chunk;
        std::uint32_t checksum = 0;  // the Adler-32 checksum of `filtered`
    };
    // Encodes the rows `from` … `to` − 1 of `image`, and sets all members of `band`. Rows are counted from the top of
    // the image.
    static void encode(const ImageView& image, int from, int to, ImageBand& band);

    parallel::ForkJoin* forkJoin_;
    std::array<ImageBand, 2> bands_;
};

}  // namespace oval4d::image
