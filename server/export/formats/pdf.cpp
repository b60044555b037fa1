#include "export/formats/writers.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <hpdf.h>
#include <boost/locale/encoding_utf.hpp>
#include <glm/vec2.hpp>

#include "export/drawing/bounds.hpp"

namespace oval4d::exports {

namespace {

constexpr double kPointsPerMillimeter = 72 / 25.4;

// An error handler for libharu, with the parameters that libharu prescribes. `first` points to an HPDF_STATUS, which
// keeps the first error. After an error, functions of libharu do nothing.
void recordError(HPDF_STATUS error, HPDF_STATUS /*detail*/, void* first) {
    auto& status = *static_cast<HPDF_STATUS*>(first);
    if (status == HPDF_OK) status = error;
}

float colorChannel(scene::Color color, int shift) { return static_cast<float>(color >> shift & 255U) / 255; }

// The absolute coordinate at which shapes are cut, in units of the drawing. libharu writes numbers beyond ±32,767 as
// ±32,767, which would change the direction of longer lines. Lines of slices close to the eye extend so far.
constexpr double kFarthest = 30'000;

// A visitor that draws shapes on a page. Positions in PDF count from the lower left corner.
class PdfPageWriter {
  public:
    PdfPageWriter(HPDF_Doc document, HPDF_Page page, double height)
        : document_(document), page_(page), height_(height), font_(HPDF_GetFont(document, "Helvetica", nullptr)) {}

    void operator()(const LineSegment& line) {
        setOpacity(line.opacity);
        setStroke(line.color, line.width, line.roundEnds);
        HPDF_Page_MoveTo(page_, x(line.from), y(line.from));
        HPDF_Page_LineTo(page_, x(line.to), y(line.to));
        HPDF_Page_Stroke(page_);
    }
    void operator()(const Polyline& line) {
        setOpacity(1);
        setStroke(line.color, line.width, true);
        HPDF_Page_SetLineJoin(page_, HPDF_ROUND_JOIN);
        HPDF_Page_MoveTo(page_, x(line.points[0]), y(line.points[0]));
        for (std::size_t i = 1; i < line.points.size(); ++i)
            HPDF_Page_LineTo(page_, x(line.points[i]), y(line.points[i]));
        HPDF_Page_Stroke(page_);
    }
    void operator()(const FilledPolygon& polygon) {
        const std::vector<glm::dvec2>& corners = polygon.corners;
        setFill(polygon.color, polygon.opacity);
        HPDF_Page_MoveTo(page_, x(corners[0]), y(corners[0]));
        for (std::size_t i = 1; i < corners.size(); ++i) HPDF_Page_LineTo(page_, x(corners[i]), y(corners[i]));
        HPDF_Page_ClosePath(page_);
        HPDF_Page_Fill(page_);
    }
    void operator()(const Disk& disk) {
        setFill(disk.color, disk.opacity);
        HPDF_Page_Circle(page_, x(disk.center), y(disk.center), static_cast<float>(disk.radius));
        HPDF_Page_Fill(page_);
    }
    void operator()(const TextLine& line) {
        setFill(line.color, 1);
        HPDF_Page_BeginText(page_);
        HPDF_Page_SetFontAndSize(page_, font_, static_cast<float>(line.size));
        const float width = HPDF_Page_TextWidth(page_, line.text.c_str());
        HPDF_Page_TextOut(page_, x(line.at) - width / 2, y(line.at), line.text.c_str());
        HPDF_Page_EndText(page_);
    }
    // Draws an image with the colors of OpacityImage::colorOfPixelColumn(). OpacityImage::alphas is its soft mask,
    // which gives the opacity of each pixel.
    void operator()(const OpacityImage& density) {
        setOpacity(1);
        std::vector<HPDF_BYTE> colors;
        for (int row = 0; row < density.rows(); ++row) {
            for (int column = 0; column < density.columns; ++column) {
                const scene::Color color = density.colorOfPixelColumn(column);
                for (const int shift : {16, 8, 0}) colors.push_back(static_cast<HPDF_BYTE>(color >> shift & 255U));
            }
        }
        const auto width = static_cast<HPDF_UINT>(density.columns), height = static_cast<HPDF_UINT>(density.rows());
        const auto image = HPDF_LoadRawImageFromMem(document_, colors.data(), width, height, HPDF_CS_DEVICE_RGB, 8);
        const auto mask =
            HPDF_LoadRawImageFromMem(document_, density.alphas.data(), width, height, HPDF_CS_DEVICE_GRAY, 8);
        HPDF_Image_AddSMask(image, mask);
        // The centers of the outer pixels lie on the edges of the rectangle (see OpacityImage), so the image extends
        // half a pixel beyond it.
        const glm::dvec2 size = density.bottomRight - density.topLeft;
        const double across = size.x / (density.columns - 1), down = size.y / (density.rows() - 1);
        const glm::dvec2 corner{density.topLeft.x - across / 2, density.bottomRight.y + down / 2};
        HPDF_Page_DrawImage(page_, image, x(corner), y(corner), static_cast<float>(size.x + across),
                            static_cast<float>(size.y + down));
    }

  private:
    static float x(const glm::dvec2& at) { return static_cast<float>(at.x); }
    float y(const glm::dvec2& at) const { return static_cast<float>(height_ - at.y); }

    void setStroke(scene::Color color, double width, bool roundEnds) {
        HPDF_Page_SetRGBStroke(page_, colorChannel(color, 16), colorChannel(color, 8), colorChannel(color, 0));
        HPDF_Page_SetLineWidth(page_, static_cast<float>(width));
        HPDF_Page_SetLineCap(page_, roundEnds ? HPDF_ROUND_END : HPDF_BUTT_END);
    }

    void setFill(scene::Color color, double opacity) {
        setOpacity(opacity);
        HPDF_Page_SetRGBFill(page_, colorChannel(color, 16), colorChannel(color, 8), colorChannel(color, 0));
    }

    // Sets the opacity of the next shapes, rounded to percent. In PDF, the opacity is a parameter of a graphics state.
    // All shapes with the same opacity share a state.
    void setOpacity(double opacity) {
        const int percent = static_cast<int>(std::lround(100 * std::clamp(opacity, 0.0, 1.0)));
        if (percent == percent_) return;
        percent_ = percent;
        HPDF_ExtGState& state = states_[percent];
        if (state == nullptr) {
            state = HPDF_CreateExtGState(document_);
            HPDF_ExtGState_SetAlphaFill(state, static_cast<float>(percent) / 100);
            HPDF_ExtGState_SetAlphaStroke(state, static_cast<float>(percent) / 100);
        }
        HPDF_Page_SetExtGState(page_, state);
    }

    HPDF_Doc document_;
    HPDF_Page page_;
    double height_;
    HPDF_Font font_;
    int percent_ = 100;
    std::map<int, HPDF_ExtGState> states_;
};

// Returns a text in the form of PDF's document information: UTF-16BE with a byte order mark, as a hexadecimal string
// (PDF 1.4, section 3.8.1).
std::string pdfTextString(const std::string& text) {
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    std::string out = "<FEFF";
    for (const char16_t unit : boost::locale::conv::utf_to_utf<char16_t>(text)) {
        for (int shift = 12; shift >= 0; shift -= 4) out += kDigits[(static_cast<unsigned>(unit) >> shift) % 16];
    }
    return out + '>';
}

bool isAscii(const std::string& text) {
    return std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

}  // namespace

std::string pdf(const Drawing& drawing) {
    HPDF_STATUS error = HPDF_OK;
    const std::unique_ptr<std::remove_pointer_t<HPDF_Doc>, decltype(&HPDF_Free)> document(HPDF_New(recordError, &error),
                                                                                          HPDF_Free);
    if (!document) throw std::runtime_error("libharu cannot create a document");
    HPDF_SetCompressionMode(document.get(), HPDF_COMP_ALL);
    // libharu accepts titles in ASCII, but not in UTF-16, which contains zero bytes. So for any other title, write a
    // placeholder of the same length, and replace it in the finished file.
    const std::string title = isAscii(drawing.title) ? "" : pdfTextString(drawing.title);
    const std::string placeholder(title.size() - std::min<std::size_t>(title.size(), 2), 'T');
    HPDF_SetInfoAttr(document.get(), HPDF_INFO_TITLE, title.empty() ? drawing.title.c_str() : placeholder.c_str());
    HPDF_SetInfoAttr(document.get(), HPDF_INFO_CREATOR, "oval4d");
    const HPDF_Page page = HPDF_AddPage(document.get());
    const double scale = drawing.millimetersPerUnit() * kPointsPerMillimeter;
    HPDF_Page_SetWidth(page, static_cast<float>(drawing.width * scale));
    HPDF_Page_SetHeight(page, static_cast<float>(drawing.height * scale));
    HPDF_Page_Concat(page, static_cast<float>(scale), 0, 0, static_cast<float>(scale), 0, 0);
    PdfPageWriter writer(document.get(), page, drawing.height);
    for (const ShapeGroup& group : drawing.groups) {
        for (const DrawnShape& shape : group.shapes) {
            if (const auto drawn = cutAtBounds(shape, kFarthest)) std::visit(writer, *drawn);
        }
    }
    HPDF_SaveToStream(document.get());
    std::string out(HPDF_GetStreamSize(document.get()), '\0');
    auto size = static_cast<HPDF_UINT32>(out.size());
    HPDF_ResetStream(document.get());
    HPDF_ReadFromStream(document.get(), reinterpret_cast<HPDF_BYTE*>(out.data()), &size);
    out.resize(size);
    if (error != HPDF_OK) throw std::runtime_error("libharu cannot write the document: error " + std::to_string(error));
    if (!title.empty()) {
        const std::string written = '(' + placeholder + ')';
        const std::size_t at = out.find(written);
        if (at == std::string::npos) throw std::runtime_error("libharu has changed the title of the document");
        out.replace(at, written.size(), title);
    }
    return out;
}

}  // namespace oval4d::exports
