#include "polytopes/construction/uniform.hpp"

#include <array>

namespace oval4d::polytopes {

namespace {

constexpr auto kUniform = std::to_array<NamedWythoffianPolychoron>({
    {"regular", "5-cell", "pen", "x3o3o3o", "", "pentachoron,4-simplex,simplex,pentatope,hyperpyramid"},
    {"regular", "8-cell", "tes", "x4o3o3o", "x4o x4o", "tesseract,hypercube,4-cube,octachoron,cubic prism,cube prism"},
    {"regular", "16-cell", "hex", "x3o3o4o", "x3o3o *b3o", "hexadecachoron,4-orthoplex,cross-polytope"},
    {"regular", "24-cell", "ico", "x3o4o3o", "o4o3x3o,o3x3o *b3o", "icositetrachoron,octaplex,polyoctahedron"},
    {"regular", "120-cell", "hi", "x5o3o3o", "", "hecatonicosachoron,dodecaplex,polydodecahedron"},
    {"regular", "600-cell", "ex", "x3o3o5o", "", "hexacosichoron,tetraplex,polytetrahedron"},

    {"star", "small stellated 120-cell", "sishi", "x5/2o5o3o", "", "stellated 120-cell"},
    {"star", "icosahedral 120-cell", "fix", "x3o5o5/2o", "", "faceted 600-cell"},
    {"star", "great 120-cell", "gohi", "x5o5/2o5o", "", ""},
    {"star", "grand 120-cell", "gahi", "x5o3o5/2o", "", ""},
    {"star", "great stellated 120-cell", "gishi", "x5/2o3o5o", "", ""},
    {"star", "grand stellated 120-cell", "gashi", "x5/2o5o5/2o", "", ""},
    {"star", "great grand 120-cell", "gaghi", "x5o5/2o3o", "", ""},
    {"star", "great icosahedral 120-cell", "gofix", "x3o5/2o5o", "", "great faceted 600-cell"},
    {"star", "grand 600-cell", "gax", "x3o3o5/2o", "", ""},
    {"star", "great grand stellated 120-cell", "gogishi", "x5/2o3o3o", "", ""},

    {"uniform A4", "rectified 5-cell", "rap", "o3x3o3o", "", ""},
    {"uniform A4", "truncated 5-cell", "tip", "x3x3o3o", "", ""},
    {"uniform A4", "cantellated 5-cell", "srip", "x3o3x3o", "", ""},
    {"uniform A4", "bitruncated 5-cell", "deca", "o3x3x3o", "", "decachoron"},
    {"uniform A4", "runcinated 5-cell", "spid", "x3o3o3x", "", ""},
    {"uniform A4", "cantitruncated 5-cell", "grip", "x3x3x3o", "", ""},
    {"uniform A4", "runcitruncated 5-cell", "prip", "x3x3o3x", "", ""},
    {"uniform A4", "omnitruncated 5-cell", "gippid", "x3x3x3x", "", ""},

    {"uniform B4", "rectified tesseract", "rit", "o4x3o3o", "x3o3x *b3o", ""},
    {"uniform B4", "truncated tesseract", "tat", "x4x3o3o", "", ""},
    {"uniform B4", "cantellated tesseract", "srit", "x4o3x3o", "", ""},
    {"uniform B4", "bitruncated tesseract", "tah", "o4x3x3o", "x3x3x *b3o", "tesseractihexadecachoron"},
    {"uniform B4", "truncated 16-cell", "thex", "o4o3x3x", "x3x3o *b3o", ""},
    {"uniform B4", "runcinated tesseract", "sidpith", "x4o3o3x", "", ""},
    {"uniform B4", "cantitruncated tesseract", "grit", "x4x3x3o", "", ""},
    {"uniform B4", "runcitruncated tesseract", "proh", "x4x3o3x", "", ""},
    {"uniform B4", "runcitruncated 16-cell", "prit", "x4o3x3x", "", ""},
    {"uniform B4", "omnitruncated tesseract", "gidpith", "x4x3x3x", "", ""},

    {"uniform F4", "rectified 24-cell", "rico", "o3x4o3o", "o4x3o3x,x3o3x *b3x", ""},
    {"uniform F4", "truncated 24-cell", "tico", "x3x4o3o", "o4x3x3x,x3x3x *b3x", ""},
    {"uniform F4", "cantellated 24-cell", "srico", "x3o4x3o", "", ""},
    {"uniform F4", "bitruncated 24-cell", "cont", "o3x4x3o", "", "tetracontoctachoron,48-cell"},
    {"uniform F4", "runcinated 24-cell", "spic", "x3o4o3x", "", ""},
    {"uniform F4", "cantitruncated 24-cell", "grico", "x3x4x3o", "", ""},
    {"uniform F4", "runcitruncated 24-cell", "prico", "x3x4o3x", "", ""},
    {"uniform F4", "omnitruncated 24-cell", "gippic", "x3x4x3x", "", ""},

    {"uniform H4", "rectified 120-cell", "rahi", "o5x3o3o", "", ""},
    {"uniform H4", "truncated 120-cell", "thi", "x5x3o3o", "", ""},
    {"uniform H4", "cantellated 120-cell", "srahi", "x5o3x3o", "", ""},
    {"uniform H4", "bitruncated 120-cell", "xhi", "o5x3x3o", "", ""},
    {"uniform H4", "truncated 600-cell", "tex", "o5o3x3x", "", ""},
    {"uniform H4", "rectified 600-cell", "rox", "o5o3x3o", "", ""},
    {"uniform H4", "cantellated 600-cell", "srix", "o5x3o3x", "", ""},
    {"uniform H4", "runcinated 120-cell", "sidpixhi", "x5o3o3x", "", ""},
    {"uniform H4", "cantitruncated 120-cell", "grahi", "x5x3x3o", "", ""},
    {"uniform H4", "cantitruncated 600-cell", "grix", "o5x3x3x", "", ""},
    {"uniform H4", "runcitruncated 120-cell", "prix", "x5x3o3x", "", ""},
    {"uniform H4", "runcitruncated 600-cell", "prahi", "x5o3x3x", "", ""},
    {"uniform H4", "omnitruncated 120-cell", "gidpixhi", "x5x3x3x", "", ""},
});

}  // namespace

std::span<const NamedWythoffianPolychoron> namedWythoffianPolychora() { return kUniform; }

}  // namespace oval4d::polytopes
