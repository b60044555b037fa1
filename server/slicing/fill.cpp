#include "slicing/fill.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace oval4d::slicing {

void FilledFaces::clear() {
    faces.clear();
    corners.clear();
    faceBegin.assign(1, 0);
    pieceBegin.assign(1, 0);
    cornerBegin.assign(1, 0);
}

double FaceFiller::LoopSide::at(double y) const {
    if (y <= low.y) return low.x;
    if (y >= high.y) return high.x;
    return low.x + slope * (y - low.y);
}

std::size_t FaceFiller::fill(const SliceSet& slices, double circumradius, FilledFaces& out, std::size_t steps,
                             std::size_t count) {
    stepsLeft_ = steps;
    epsilon_ = 1e-10 * circumradius;
    out.clear();
    for (std::size_t slice = 0; slice + 1 < slices.faceBegin.size(); ++slice) {
        const std::uint32_t first = slices.faceBegin[slice], last = slice < count ? slices.faceBegin[slice + 1] : first;
        for (std::uint32_t begin = first, end = begin; begin < last; begin = end) {
            while (end < last && slices.faceSource[end] == slices.faceSource[begin]) ++end;
            fillFace(slices, slice, begin, end, out);
        }
        out.faceBegin.push_back(static_cast<std::uint32_t>(out.faces.size()));
    }
    return stepsLeft_;
}

void FaceFiller::fillFace(const SliceSet& slices, std::size_t slice, std::uint32_t begin, std::uint32_t end,
                          FilledFaces& out) {
    FilledFaces::FilledFace face{{}, 0, slices.faceSource[begin], begin, end, 0};
    if (!findFaceFrame(slices, slice, begin, end, face)) return;
    if (end - begin == 1 && !isFlat(face)) {
        fillRoughly(slices, begin, end, out);
    } else {
        findLoopSides(slices, begin, end);
        const bool known = spendSteps(sides_.size() * sides_.size());
        if (known) findSweepEvents();
        if (known && spendSteps(sides_.size() * levels_.size())) {
            face.winding = sweep(out);
        } else {
            fillRoughly(slices, begin, end, out);
        }
    }
    if (out.cornerBegin.size() - 1 == out.pieceBegin.back()) return;
    out.faces.push_back(face);
    out.pieceBegin.push_back(static_cast<std::uint32_t>(out.cornerBegin.size() - 1));
}

// Sets sides_ to the sides of the loops of the current face, except horizontal ones. The corners of the loops are
// points_.
void FaceFiller::findLoopSides(const SliceSet& slices, std::uint32_t begin, std::uint32_t end) {
    const auto onPlane = [this](const glm::dvec3& p) {
        return glm::dvec2(glm::dot(p - faceFrame_.origin, faceFrame_.x), glm::dot(p - faceFrame_.origin, faceFrame_.y));
    };
    sides_.clear();
    std::size_t first = 0;
    for (std::uint32_t f = begin; f < end; ++f) {
        const std::size_t size = slices.cornerBegin[f + 1] - slices.cornerBegin[f];
        for (std::size_t i = 0; i < size; ++i) {
            const glm::dvec2 a = onPlane(points_[first + i]);
            const glm::dvec2 b = onPlane(points_[first + (i + 1) % size]);
            // The inside of a loop is to the left of a side that goes up. So across such a side, from left to right,
            // the winding number decreases by 1.
            const double slope = (b.x - a.x) / (b.y - a.y);
            if (a.y < b.y) sides_.push_back({a, b, slope, -1, 0, 0, 0});
            if (a.y > b.y) sides_.push_back({b, a, slope, 1, 0, 0, 0});
        }
        first += size;
    }
}

// Returns whether points_, the corners of `face`, lie in the plane of `face`. The tolerance is far greater than
// rounding errors, and far less than what can be seen.
bool FaceFiller::isFlat(const FilledFaces::FilledFace& face) const {
    double size = 0, distance = 0;
    for (const glm::dvec3& p : points_) {
        size = std::max(size, glm::distance(p, faceFrame_.origin));
        distance = std::max(distance, std::abs(glm::dot(face.normal, p) - face.offset));
    }
    return distance <= 1e-5 * size + 1e3 * epsilon_;
}

// Subtracts `steps` from the number of steps that are left. Returns false, and subtracts nothing, if fewer than `steps`
// are left.
bool FaceFiller::spendSteps(std::size_t steps) {
    if (steps > stepsLeft_) return false;
    stepsLeft_ -= steps;
    return true;
}

void FaceFiller::fillRoughly(const SliceSet& slices, std::uint32_t begin, std::uint32_t end, FilledFaces& out) const {
    std::size_t first = 0;
    for (std::uint32_t f = begin; f < end; ++f) {
        const std::size_t size = slices.cornerBegin[f + 1] - slices.cornerBegin[f];
        glm::dvec3 middle(0);
        for (std::size_t i = 0; i < size; ++i) middle += points_[first + i] / static_cast<double>(size);
        for (std::size_t i = 0; i < size; ++i) {
            const glm::dvec3& next = points_[first + (i + 1) % size];
            out.corners.insert(out.corners.end(), {middle, points_[first + i], next});
            out.cornerBegin.push_back(static_cast<std::uint32_t>(out.corners.size()));
        }
        first += size;
    }
}

// Finds the plane of one face. The loops of the face are the entries begin … end − 1 of the faces of `slices`. Sets
// points_ to their corners, faceFrame_ to the plane through three corners that are far apart, and the normal and the
// offset of `out`. Returns false if all corners are collinear.
bool FaceFiller::findFaceFrame(const SliceSet& slices, std::size_t slice, std::uint32_t begin, std::uint32_t end,
                               FilledFaces::FilledFace& out) {
    points_.clear();
    glm::dvec3 area(0);  // twice the sum of the area vectors of the loops
    const glm::dvec3* vertices = &slices.vertices[slices.vertexBegin[slice]];
    for (std::uint32_t f = begin; f < end; ++f) {
        const glm::dvec3& apex = vertices[slices.corners[slices.cornerBegin[f]]];
        for (std::uint32_t i = slices.cornerBegin[f]; i < slices.cornerBegin[f + 1]; ++i) {
            points_.push_back(vertices[slices.corners[i]]);
            if (i > slices.cornerBegin[f])
                area += glm::cross(points_[points_.size() - 2] - apex, points_.back() - apex);
        }
    }
    const glm::dvec3 origin = points_.front();
    glm::dvec3 far(0), normal(0);
    for (const glm::dvec3& p : points_) {
        if (glm::dot(p - origin, p - origin) > glm::dot(far, far)) far = p - origin;
    }
    for (const glm::dvec3& p : points_) {
        const glm::dvec3 cross = glm::cross(far, p - origin);
        if (glm::dot(cross, cross) > glm::dot(normal, normal)) normal = cross;
    }
    const double height = glm::length(normal);
    if (!(height > epsilon_ * glm::length(far))) return false;
    normal /= glm::dot(area, normal) < 0 ? -height : height;
    faceFrame_ = {origin, glm::normalize(far), glm::cross(normal, glm::normalize(far))};
    out.normal = normal;
    out.offset = glm::dot(normal, origin);
    return true;
}

// Sets levels_: the heights y at which a side begins, ends or crosses another. Sets the levels of the ends of each
// side. Between two successive levels, no side begins, ends or crosses another.
void FaceFiller::findSweepEvents() {
    levels_.clear();
    for (const LoopSide& side : sides_) {
        levels_.push_back(side.low.y);
        levels_.push_back(side.high.y);
    }
    for (std::size_t i = 0; i < sides_.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            const LoopSide &a = sides_[i], &b = sides_[k];
            const double bottom = std::max(a.low.y, b.low.y);
            const double top = std::min(a.high.y, b.high.y);
            if (top - bottom <= epsilon_ || std::max(a.low.x, a.high.x) < std::min(b.low.x, b.high.x) ||
                std::max(b.low.x, b.high.x) < std::min(a.low.x, a.high.x)) {
                continue;
            }
            const double before = a.at(bottom) - b.at(bottom);
            const double after = a.at(top) - b.at(top);
            if ((before < 0) == (after < 0) || before == after) continue;
            levels_.push_back(bottom + (top - bottom) * (before / (before - after)));
        }
    }
    std::sort(levels_.begin(), levels_.end());
    const auto same = [this](double a, double b) { return b - a <= epsilon_; };
    levels_.erase(std::unique(levels_.begin(), levels_.end(), same), levels_.end());
    for (LoopSide& side : sides_) {
        const auto level = [this](double y) {
            return static_cast<std::uint32_t>(std::upper_bound(levels_.begin(), levels_.end(), y) - levels_.begin() -
                                              1);
        };
        side.from = level(side.low.y);
        side.to = level(side.high.y);
    }
}

// Sweeps a line upward from level to level, and appends the pieces of the face to `out`. In the strip between two
// levels, the order of the sides from left to right does not change. Returns the greatest absolute winding number.
int FaceFiller::sweep(FilledFaces& out) {
    waiting_.resize(sides_.size());
    for (std::uint32_t i = 0; i < sides_.size(); ++i) waiting_[i] = i;
    std::sort(waiting_.begin(), waiting_.end(),
              [this](std::uint32_t a, std::uint32_t b) { return sides_[a].from < sides_[b].from; });
    active_.clear();
    open_.clear();
    std::size_t next = 0;
    int most = 0;
    for (std::uint32_t strip = 0; strip + 1 < levels_.size(); ++strip) {
        const double bottom = levels_[strip];
        const double top = levels_[strip + 1];
        std::erase_if(active_, [&](std::uint32_t i) { return sides_[i].to <= strip; });
        for (; next < waiting_.size() && sides_[waiting_[next]].from == strip; ++next) {
            if (sides_[waiting_[next]].to > strip) active_.push_back(waiting_[next]);
        }
        sortActiveSides((bottom + top) / 2);

        arrivals_.clear();
        for (ConvexPiece& piece : open_) {
            piece.continued = false;
            arrivals_.push_back({sides_[piece.leftSide].at(bottom), static_cast<std::uint32_t>(arrivals_.size())});
        }
        std::ranges::sort(arrivals_);
        int winding = 0;
        std::uint32_t left = 0;
        bool hasPositiveWinding = true;
        for (const std::uint32_t i : active_) {
            const int before = winding;
            winding += sides_[i].winding;
            most = std::max(most, std::abs(winding));
            if (before == 0) {
                left = i;
                hasPositiveWinding = winding > 0;
            } else if (winding == 0 && sides_[i].middle - sides_[left].middle > epsilon_) {
                addRegionBetweenSides(left, i, hasPositiveWinding, bottom);
            }
        }
        for (const ConvexPiece& piece : open_) {
            if (!piece.continued) closePiece(piece, bottom, out);
        }
        std::erase_if(open_, [](const ConvexPiece& piece) { return !piece.continued; });
    }
    for (const ConvexPiece& piece : open_) closePiece(piece, levels_.back(), out);
    return most;
}

// Sorts the active sides from left to right at height y. The sides are nearly sorted already, from the previous strip,
// so insertion sort is fastest.
void FaceFiller::sortActiveSides(double y) {
    for (std::size_t i = 0; i < active_.size(); ++i) {
        const std::uint32_t side = active_[i];
        const double x = sides_[side].middle = sides_[side].at(y);
        std::size_t at = i;
        for (; at > 0 && sides_[active_[at - 1]].middle > x; --at) active_[at] = active_[at - 1];
        active_[at] = side;
    }
}

// Adds the region between the sides `left` and `right` in the current strip. The region lies inside the face and begins
// at height `bottom`. Extends an open piece by the region if the piece stays convex, else begins a new piece. Only a
// piece whose left side arrives at the left end of the region can be extended. There is at most one such piece, except
// where several sides meet.
void FaceFiller::addRegionBetweenSides(std::uint32_t left, std::uint32_t right, bool hasPositiveWinding,
                                       double bottom) {
    const LoopSide &l = sides_[left], &r = sides_[right];
    const double x = l.at(bottom);
    auto arrival = std::ranges::lower_bound(arrivals_, x - epsilon_, {}, &PieceAtLevel::x);
    for (; arrival != arrivals_.end() && arrival->x <= x + epsilon_; ++arrival) {
        ConvexPiece& piece = open_[arrival->piece];
        if (piece.continued || piece.hasPositiveWinding != hasPositiveWinding || !canExtendPiece(piece, l, r, bottom))
            continue;
        if (piece.leftSide != left) piece.left.at(piece.leftCount++) = {l.at(bottom), bottom};
        if (piece.rightSide != right) piece.right.at(piece.rightCount++) = {r.at(bottom), bottom};
        piece.leftSide = left;
        piece.rightSide = right;
        piece.continued = true;
        return;
    }
    ConvexPiece piece{};
    piece.left[0] = {l.at(bottom), bottom};
    piece.right[0] = {r.at(bottom), bottom};
    piece.leftCount = piece.rightCount = 1;
    piece.leftSide = left;
    piece.rightSide = right;
    piece.hasPositiveWinding = hasPositiveWinding;
    piece.continued = true;
    open_.push_back(piece);
}

// Returns whether the piece can continue upward from height `bottom` along the sides `left` and `right`: whether the
// piece stays convex, and its chains have room for another corner.
bool FaceFiller::canExtendPiece(const ConvexPiece& piece, const LoopSide& left, const LoopSide& right,
                                double bottom) const {
    const LoopSide &l = sides_[piece.leftSide], &r = sides_[piece.rightSide];
    const auto follows = [&](const LoopSide& before, const LoopSide& after, double inward) {
        if (&before == &after) return true;
        if (std::abs(before.at(bottom) - after.at(bottom)) > epsilon_) return false;
        return inward * (after.slope - before.slope) >= 0;
    };
    return piece.leftCount < ConvexPiece::kMaxCorners && piece.rightCount < ConvexPiece::kMaxCorners &&
           follows(l, left, 1) && follows(r, right, -1);
}

// Completes a piece at height `top` and appends it to `out`, unless the piece is degenerate.
void FaceFiller::closePiece(const ConvexPiece& piece, double top, FilledFaces& out) const {
    const std::size_t first = out.corners.size();
    glm::dvec2 last(0);
    const auto add = [&](const glm::dvec2& p) {
        if (out.corners.size() > first && glm::distance(p, last) <= epsilon_) return;
        last = p;
        out.corners.push_back(faceFrame_.origin + p.x * faceFrame_.x + p.y * faceFrame_.y);
    };
    add(piece.left[0]);
    for (std::size_t i = 0; i < piece.rightCount; ++i) add(piece.right.at(i));
    add({sides_[piece.rightSide].at(top), top});
    add({sides_[piece.leftSide].at(top), top});
    for (std::size_t i = piece.leftCount; i-- > 1;) add(piece.left.at(i));
    if (out.corners.size() - first < 3) {
        out.corners.resize(first);
        return;
    }
    if (!piece.hasPositiveWinding)
        std::reverse(out.corners.begin() + static_cast<std::ptrdiff_t>(first), out.corners.end());
    out.cornerBegin.push_back(static_cast<std::uint32_t>(out.corners.size()));
}

}  // namespace oval4d::slicing
