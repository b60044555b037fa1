#include "polytopes/import/simplex_division.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>

#include "geometry/index.hpp"

namespace oval4d::polytopes {

namespace {

using geometry::kNone;
using VertexPair = std::pair<std::uint32_t, std::uint32_t>;

VertexPair sortedPair(std::uint32_t a, std::uint32_t b) { return std::minmax(a, b); }

// Divides 2-faces and cells of a soup. The caller must call divideFaces() first, then divideCells(), which replaces the
// 2-faces and cells of the soup by the new ones. Each new element gets the source position of the divided element; a
// triangle inside a cell gets that of the first 2-face of the cell.
class SimplexDivider {
  public:
    explicit SimplexDivider(PolygonSoup& soup) : soup_(soup), hasPositions_(!soup.cellSourcePositions.empty()) {}

    void divideFaces(const std::vector<bool>& divided) {
        becomes_.resize(soup_.faces.size());
        for (std::uint32_t f = 0; f < soup_.faces.size(); ++f) {
            const auto loop = soup_.faces[f];
            if (!divided[f] || loop.size() == 3) {
                becomes_[f].push_back(addFace(loop, f));
                continue;
            }
            const std::size_t n = loop.size();
            const auto first = static_cast<std::size_t>(std::min_element(loop.begin(), loop.end()) - loop.begin());
            for (std::size_t i = 1; i + 1 < n; ++i) {
                const std::array<std::uint32_t, 3> triangle{loop[first], loop[(first + i) % n],
                                                            loop[(first + i + 1) % n]};
                becomes_[f].push_back(addFace(triangle, f));
            }
        }
    }

    void divideCells(const std::vector<bool>& divided) {
        std::vector<std::uint32_t> pieces;
        for (std::uint32_t c = 0; c < soup_.cells.size(); ++c) {
            pieces.clear();
            for (const std::uint32_t f : soup_.cells[c])
                pieces.insert(pieces.end(), becomes_[f].begin(), becomes_[f].end());
            if (divided[c]) {
                divideCell(c, pieces);
            } else {
                addCell(pieces, c);
            }
        }
        soup_.faces = std::move(faces_);
        soup_.cells = std::move(cells_);
        soup_.faceSourcePositions = std::move(facePositions_);
        soup_.cellSourcePositions = std::move(cellPositions_);
    }

  private:
    std::uint32_t addFace(std::span<const std::uint32_t> loop, std::uint32_t from) {
        faces_.add(loop);
        if (hasPositions_) facePositions_.push_back(soup_.faceSourcePositions[from]);
        return static_cast<std::uint32_t>(faces_.size() - 1);
    }

    void addCell(std::span<const std::uint32_t> faces, std::uint32_t from) {
        cells_.add(faces);
        if (hasPositions_) cellPositions_.push_back(soup_.cellSourcePositions[from]);
    }

    // Divides a cell into tetrahedra. The apex is the cell's vertex with the smallest index. Each triangle of the
    // surface that does not contain the apex is the base of a tetrahedron with this apex.
    void divideCell(std::uint32_t cell, std::span<const std::uint32_t> triangles) {
        std::uint32_t apex = kNone;
        for (const std::uint32_t t : triangles) {
            for (const std::uint32_t v : faces_[t]) apex = std::min(apex, v);
        }
        // `upright` maps an edge that does not contain the apex to the triangle of this edge and the apex. The first
        // loop below adds the triangles on the surface of the cell; the second loop adds those inside the cell.
        std::map<VertexPair, std::uint32_t> upright;
        std::vector<std::pair<std::array<std::uint32_t, 3>, std::uint32_t>> bases;
        for (const std::uint32_t t : triangles) {
            const auto loop = faces_[t];
            const auto at = static_cast<std::size_t>(std::find(loop.begin(), loop.end(), apex) - loop.begin());
            if (at < 3) {
                upright.emplace(sortedPair(loop[(at + 1) % 3], loop[(at + 2) % 3]), t);
            } else {
                bases.push_back({{loop[0], loop[1], loop[2]}, t});
            }
        }
        for (const auto& [corners, base] : bases) {
            std::array<std::uint32_t, 4> tetrahedron{base, 0, 0, 0};
            for (std::size_t i = 0; i < 3; ++i) {
                const VertexPair edge = sortedPair(corners.at(i), corners.at((i + 1) % 3));
                const auto [known, isNew] = upright.try_emplace(edge, kNone);
                if (isNew) {
                    const std::array<std::uint32_t, 3> triangle{apex, edge.first, edge.second};
                    known->second = addFace(triangle, soup_.cells[cell][0]);
                }
                tetrahedron.at(i + 1) = known->second;
            }
            addCell(tetrahedron, cell);
        }
    }

    PolygonSoup& soup_;
    bool hasPositions_;
    std::vector<std::vector<std::uint32_t>> becomes_;  // for each 2-face, the 2-faces that replace this 2-face
    geometry::JaggedArray faces_, cells_;
    std::vector<PolygonSoup::SourcePosition> facePositions_, cellPositions_;
};

}  // namespace

void splitIntoSimplices(PolygonSoup& soup, std::vector<bool> faces, const std::vector<bool>& cells) {
    for (std::size_t c = 0; c < soup.cells.size(); ++c) {
        if (!cells[c]) continue;
        for (const std::uint32_t f : soup.cells[c]) faces[f] = true;
    }
    SimplexDivider divider(soup);
    divider.divideFaces(faces);
    divider.divideCells(cells);
}

}  // namespace oval4d::polytopes
