#include "export/label/letters.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include <glm/common.hpp>

namespace oval4d::exports {

namespace {

constexpr double kLineStep = 1.7;  // distance between baselines, in heights of a capital letter
constexpr int kPieces = 4;         // number of line segments per curve

// A converter from lines of text to the contours of their letters, with FreeType. Lengths are in heights of a capital
// letter.
class TextOutliner {
  public:
    TextOutliner() {
        if (FT_Init_FreeType(&library_) != 0) throw std::runtime_error("FreeType cannot be initialized");
        const char* const named = std::getenv("OVAL4D_FONT");
        const std::string file = named != nullptr && *named != 0 ? named : OVAL4D_FONT;
        if (FT_New_Face(library_, file.c_str(), 0, &face_) != 0) {
            FT_Done_FreeType(library_);
            throw std::runtime_error("cannot read a font from " + file);
        }
        if (FT_Load_Char(face_, 'H', FT_LOAD_NO_SCALE) == 0)
            capital_ = static_cast<double>(face_->glyph->metrics.horiBearingY);
    }
    ~TextOutliner() {
        FT_Done_Face(face_);
        FT_Done_FreeType(library_);
    }
    TextOutliner(const TextOutliner&) = delete;
    TextOutliner& operator=(const TextOutliner&) = delete;

    /// Appends the contours of a line of text to `out`. The baseline starts at (0, y). Returns the length of the line.
    /// Leaves out characters that FreeType cannot load.
    double outlineText(const std::string& text, double y, std::vector<Contour>& out) {
        origin_ = {0, y};
        out_ = &out;
        for (const char32_t character : decodeUtf8(text)) {
            if (FT_Load_Char(face_, character, FT_LOAD_NO_SCALE) != 0) continue;
            FT_Outline_Funcs funcs{};
            funcs.move_to = [](const FT_Vector* to, void* pen) { return static_cast<TextOutliner*>(pen)->moveTo(to); };
            funcs.line_to = [](const FT_Vector* to, void* pen) { return static_cast<TextOutliner*>(pen)->lineTo(to); };
            funcs.conic_to = [](const FT_Vector* control, const FT_Vector* to, void* pen) {
                return static_cast<TextOutliner*>(pen)->addCurve(control, control, to, 2);
            };
            funcs.cubic_to = [](const FT_Vector* first, const FT_Vector* second, const FT_Vector* to, void* pen) {
                return static_cast<TextOutliner*>(pen)->addCurve(first, second, to, 3);
            };
            FT_Outline_Decompose(&face_->glyph->outline, &funcs, this);
            origin_.x += static_cast<double>(face_->glyph->metrics.horiAdvance) / capital_;
        }
        return origin_.x;
    }

  private:
    static std::u32string decodeUtf8(const std::string& text) {
        std::u32string out;
        for (const char c : text) {
            const auto byte = static_cast<unsigned char>(c);
            if ((byte & 0xc0U) != 0x80U) {
                out += byte < 0x80 ? byte : byte < 0xe0 ? byte & 0x1fU : byte < 0xf0 ? byte & 0xfU : byte & 0x7U;
            } else if (!out.empty()) {
                out.back() = out.back() << 6U | (byte & 0x3fU);
            }
        }
        return out;
    }

    glm::dvec2 toOutlineUnits(const FT_Vector* v) const {
        return origin_ + glm::dvec2(static_cast<double>(v->x), static_cast<double>(v->y)) / capital_;
    }
    int moveTo(const FT_Vector* to) {
        out_->push_back({toOutlineUnits(to)});
        return 0;
    }
    int lineTo(const FT_Vector* to) {
        out_->back().push_back(toOutlineUnits(to));
        return 0;
    }
    int addCurve(const FT_Vector* first, const FT_Vector* second, const FT_Vector* to, int degree) {
        const glm::dvec2 a = out_->back().back();
        const glm::dvec2 d = toOutlineUnits(to);
        // Convert a quadratic Bézier curve to an equal cubic curve. Each control point of the cubic curve lies two
        // thirds of the way from an end to the control point of the quadratic curve.
        const glm::dvec2 b = degree == 3 ? toOutlineUnits(first) : glm::mix(a, toOutlineUnits(first), 2.0 / 3);
        const glm::dvec2 c = degree == 3 ? toOutlineUnits(second) : glm::mix(d, toOutlineUnits(second), 2.0 / 3);
        for (int i = 1; i <= kPieces; ++i) {
            const double t = static_cast<double>(i) / kPieces;
            const double s = 1 - t;
            out_->back().push_back(s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d);
        }
        return 0;
    }

    FT_Library library_ = nullptr;
    FT_Face face_ = nullptr;
    double capital_ = 1;  // height of a capital letter in font units
    glm::dvec2 origin_{0};
    std::vector<Contour>* out_ = nullptr;
};

/// Removes each point that is equal to the point before it. The last point counts as the point before the first.
void removeRepeatedPoints(Contour& contour) {
    contour.erase(std::unique(contour.begin(), contour.end()), contour.end());
    while (contour.size() > 1 && contour.front() == contour.back()) contour.pop_back();
}

}  // namespace

TextOutlines textOutlinesOf(const std::vector<std::string>& lines) {
    TextOutliner pen;
    std::vector<Contour> drawn;
    double y = 0;
    for (const std::string& line : lines) {
        const std::size_t first = drawn.size();
        const double length = pen.outlineText(line, y, drawn);
        for (std::size_t i = first; i < drawn.size(); ++i) {
            for (glm::dvec2& p : drawn[i]) p.x -= length / 2;
        }
        y -= kLineStep;
    }
    for (Contour& contour : drawn) removeRepeatedPoints(contour);
    TextOutlines out;
    out.contours = outlineOf(drawn);
    glm::dvec2 least(1e300);
    glm::dvec2 most(-1e300);
    for (Contour& contour : out.contours) {
        removeRepeatedPoints(contour);
        for (const glm::dvec2& p : contour) {
            least = glm::min(least, p);
            most = glm::max(most, p);
        }
    }
    if (out.contours.empty()) return out;
    out.size = most - least;
    for (Contour& contour : out.contours) {
        for (glm::dvec2& p : contour) p -= (least + most) / 2.0;
    }
    return out;
}

}  // namespace oval4d::exports
