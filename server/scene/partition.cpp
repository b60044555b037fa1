#include "scene/partition.hpp"

#include <algorithm>
#include <limits>

#include "scene/scene.hpp"

namespace oval4d::scene {

namespace {

// Where one face plane after the other leaves all the rest on one side, half-way planes keep the tree low.
constexpr std::size_t kMany = 24;
constexpr int kDeepest = 200;

}  // namespace

void Partition::build(const geometry::Polytope& polytope, const geometry::SliceSet& slices,
                      const Presences& presences) {
    clear();
    if (polytope.convex) return;
    filler_.fill(slices, polytope.circumradius, fill_);
    tiny_ = 1e-8 * polytope.circumradius;
    nodes_.clear();
    pieces_.clear();
    corners_.assign(fill_.corners.begin(), fill_.corners.end());
    // Planes in general position cut each other into ever more pieces; the bound is far beyond the star polychora.
    most_ = 16 * fill_.cornerBegin.size() + 10'000;
    for (std::size_t slice = 0; slice + 1 < fill_.patchBegin.size(); ++slice) {
        todo_.clear();
        for (std::uint32_t p = fill_.patchBegin[slice]; p < fill_.patchBegin[slice + 1]; ++p) {
            if (presences.face(fill_.patches[p].of) == Presence::hidden) continue;
            for (std::uint32_t k = fill_.pieceBegin[p]; k < fill_.pieceBegin[p + 1]; ++k)
                todo_.push_back({p, fill_.cornerBegin[k], fill_.cornerBegin[k + 1]});
        }
        roots_.push_back(grow(0, todo_.size(), 0));
    }
}

// Makes a tree of the pieces todo_[begin] … todo_[end − 1], and leaves todo_ as long as it was.
std::uint32_t Partition::grow(std::size_t begin, std::size_t end, int depth) {
    if (begin == end) return kNone;
    Plane plane = choose(begin, end);
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    const auto first = static_cast<std::uint32_t>(pieces_.size());
    const auto own = [&] {
        const geometry::Fill::Patch& patch = fill_.patches[todo_[begin].patch];
        return Plane{patch.normal, patch.offset};
    };
    if (depth >= kDeepest || pieces_.size() + (end - begin) > most_) {
        // Given up: all in one node, in any order.
        plane = own();
        pieces_.insert(pieces_.end(), todo_.begin() + static_cast<std::ptrdiff_t>(begin),
                       todo_.begin() + static_cast<std::ptrdiff_t>(end));
        nodes_.push_back({plane.normal, plane.offset, kNone, kNone, first, static_cast<std::uint32_t>(pieces_.size())});
        return number;
    }
    if (!parts(plane, begin, end)) plane = own();
    const std::size_t room = todo_.size();
    for (std::size_t i = begin; i < end; ++i) {
        const Piece piece = todo_[i];
        switch (whereIs(piece, plane)) {
            case Where::in:
                pieces_.push_back(piece);
                break;
            case Where::below:
                todo_.push_back(piece);
                break;
            case Where::above:
                break;
            case Where::across: {
                Piece under{}, over{};
                cut(piece, plane, under, over);
                todo_.push_back(under);
                todo_[i] = over;
                break;
            }
        }
    }
    nodes_.push_back({plane.normal, plane.offset, kNone, kNone, first, static_cast<std::uint32_t>(pieces_.size())});
    // What is above stays in the list itself.
    const std::size_t middle = todo_.size();
    for (std::size_t i = begin; i < end; ++i) {
        if (whereIs(todo_[i], plane) == Where::above) todo_.push_back(todo_[i]);
    }
    const std::size_t last = todo_.size();
    const std::uint32_t over = grow(middle, last, depth + 1);
    todo_.resize(middle);
    const std::uint32_t under = grow(room, middle, depth + 1);
    todo_.resize(room);
    nodes_[number].below = under;
    nodes_[number].above = over;
    return number;
}

// Whether there is less on either side of the plane than in all.
bool Partition::parts(const Plane& plane, std::size_t begin, std::size_t end) const {
    bool allReachBelow = true, allReachAbove = true;
    for (std::size_t i = begin; i < end && (allReachBelow || allReachAbove); ++i) {
        const Where where = whereIs(todo_[i], plane);
        allReachBelow = allReachBelow && (where == Where::below || where == Where::across);
        allReachAbove = allReachAbove && (where == Where::above || where == Where::across);
    }
    return !allReachBelow && !allReachAbove;
}

// Of the planes of a few pieces, and where there are many of three half-way planes, the one that cuts least and parts
// most evenly.
Partition::Plane Partition::choose(std::size_t begin, std::size_t end) {
    const auto planeOf = [this](const Piece& piece) {
        return Plane{fill_.patches[piece.patch].normal, fill_.patches[piece.patch].offset};
    };
    Plane best = planeOf(todo_[begin]);
    const std::size_t count = end - begin;
    if (count <= 2) return best;
    constexpr std::size_t kTried = 4;
    double least = std::numeric_limits<double>::infinity();
    const auto attempt = [&](const Plane& plane, double handicap) {
        if (const double costs = cost(plane, begin, end) + handicap; costs < least) {
            least = costs;
            best = plane;
        }
    };
    for (std::size_t i = 0; i < std::min(count, kTried); ++i)
        attempt(planeOf(todo_[begin + i * count / std::min(count, kTried)]), 0);
    if (count < kMany) return best;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t step = std::max<std::size_t>(count / 31, 1);
        middles_.clear();
        for (std::size_t i = begin; i < end; i += step) middles_.push_back(corners_[todo_[i].begin][axis]);
        const auto half = middles_.begin() + static_cast<std::ptrdiff_t>(middles_.size() / 2);
        std::nth_element(middles_.begin(), half, middles_.end());
        glm::dvec3 normal(0);
        normal[axis] = 1;
        attempt({normal, *half}, 1);
    }
    return best;
}

double Partition::cost(const Plane& plane, std::size_t begin, std::size_t end) const {
    constexpr std::size_t kSampled = 24;
    const std::size_t step = std::max<std::size_t>((end - begin) / kSampled, 1);
    int below = 0, above = 0, across = 0;
    for (std::size_t i = begin; i < end; i += step) {
        switch (whereIs(todo_[i], plane)) {
            case Where::in:
                break;
            case Where::below:
                ++below;
                break;
            case Where::above:
                ++above;
                break;
            case Where::across:
                ++across;
                break;
        }
    }
    return 3 * across + std::abs(below - above);
}

Partition::Where Partition::whereIs(const Piece& piece, const Plane& plane) const {
    bool below = false, above = false;
    for (std::uint32_t i = piece.begin; i < piece.end; ++i) {
        const double height = glm::dot(plane.normal, corners_[i]) - plane.offset;
        below = below || height < -tiny_;
        above = above || height > tiny_;
    }
    return below ? (above ? Where::across : Where::below) : (above ? Where::above : Where::in);
}

void Partition::cut(const Piece& piece, const Plane& plane, Piece& below, Piece& above) {
    heights_.clear();
    for (std::uint32_t i = piece.begin; i < piece.end; ++i)
        heights_.push_back(glm::dot(plane.normal, corners_[i]) - plane.offset);
    const std::size_t count = heights_.size();
    const auto take = [&](double sign) {
        const auto first = static_cast<std::uint32_t>(corners_.size());
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t next = i + 1 < count ? i + 1 : 0;
            const double h = sign * heights_[i], g = sign * heights_[next];
            const glm::dvec3 a = corners_[piece.begin + i], b = corners_[piece.begin + next];
            if (h >= -tiny_) corners_.push_back(a);
            if ((h < -tiny_ && g > tiny_) || (h > tiny_ && g < -tiny_)) corners_.push_back(a + (b - a) * (h / (h - g)));
        }
        return Piece{piece.patch, first, static_cast<std::uint32_t>(corners_.size())};
    };
    below = take(-1);
    above = take(1);
}

}  // namespace oval4d::scene
