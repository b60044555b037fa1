#include "scene/partition.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/scene.hpp"

namespace oval4d::scene {

namespace {

// Where one face plane after the other leaves nearly all the rest on one side, half-way planes keep the tree low.
constexpr std::size_t kMany = 1000;
constexpr std::size_t kSampled = 24;
constexpr double kUneven = 0.8;
constexpr int kDeepest = 200;
constexpr double kSmallest = 8;  // square pixels
constexpr double kLevels = 255;  // of colour

// Of a face of this opacity: so that full weight is reached where less than a level is left of what is behind.
int weightOf(double opacity) {
    const double faces = std::log(1 / kLevels) / std::log(1 - opacity);
    return static_cast<int>(Coverage::kCovered / faces);
}

}  // namespace

void Partition::build(const geometry::Polytope& polytope, const geometry::SliceSet& slices, const Presences& presences,
                      std::span<const View> views) {
    clear();
    if (polytope.convex) return;
    filler_.fill(slices, polytope.circumradius, fill_);
    tiny_ = 1e-8 * polytope.circumradius;
    nodes_.clear();
    pieces_.clear();
    corners_.clear();
    outline_.clear();
    // Planes in general position cut each other into ever more pieces; the bound is beyond the star polychora.
    most_ = 16 * fill_.cornerBegin.size() + 100'000;
    for (std::size_t slice = 0; slice + 1 < fill_.patchBegin.size(); ++slice) {
        const View* view = views.empty() ? nullptr : &views[slice];
        roots_.push_back(kNone);
        if (view != nullptr && !view->drawn) continue;
        take(slice, presences);
        begin(view);
        roots_.back() = grow(0, 0);
    }
}

// Puts the pieces of a slice's fill on the list.
void Partition::take(std::size_t slice, const Presences& presences) {
    view_ = nullptr;
    todo_.clear();
    weights_.resize(fill_.patches.size());
    for (std::uint32_t p = fill_.patchBegin[slice]; p < fill_.patchBegin[slice + 1]; ++p) {
        const Presence presence = presences.face(fill_.patches[p].of);
        if (presence == Presence::hidden) continue;
        weights_[p] = weightOf(style().faceOpacity * opacityOf(presence));
        for (std::uint32_t k = fill_.pieceBegin[p]; k < fill_.pieceBegin[p + 1]; ++k) {
            const auto first = static_cast<std::uint32_t>(corners_.size());
            for (std::uint32_t c = fill_.cornerBegin[k]; c < fill_.cornerBegin[k + 1]; ++c) addCorner(fill_.corners[c]);
            todo_.push_back({p, first, static_cast<std::uint32_t>(corners_.size()), 0});
            todo_.back().area = areaOf(todo_.back());
        }
    }
}

// Where in the picture the slice at hand is. One that reaches behind the eye is parted for any eye.
void Partition::begin(const View* view) {
    view_ = view;
    smallest_ = 0;
    if (view_ == nullptr || todo_.empty()) return;
    glm::vec2 least(std::numeric_limits<float>::max()), most = -least;
    for (std::size_t i = todo_.front().begin; i < corners_.size(); ++i) {
        if ((view_->toPixels * glm::dvec4(corners_[i], 1)).w <= 0) view_ = nullptr;
        if (view_ == nullptr) return;
        outline_[i] = pixelOf(corners_[i]);
        least = glm::min(least, outline_[i]);
        most = glm::max(most, outline_[i]);
    }
    coverage_.begin(least, most);
    smallest_ = kSmallest / (view_->pixelsPerUnit * view_->pixelsPerUnit);
}

glm::vec2 Partition::pixelOf(const glm::dvec3& corner) const {
    const glm::dvec4 clip = view_->toPixels * glm::dvec4(corner, 1);
    return glm::dvec2(clip) / clip.w;
}

void Partition::addCorner(const glm::dvec3& corner) {
    corners_.push_back(corner);
    outline_.push_back(view_ == nullptr ? glm::vec2(0) : pixelOf(corner));
}

double Partition::areaOf(const Piece& piece) const {
    glm::dvec3 sum(0);
    for (std::uint32_t i = piece.begin + 2; i < piece.end; ++i)
        sum += glm::cross(corners_[i - 1] - corners_[piece.begin], corners_[i] - corners_[piece.begin]);
    return glm::length(sum) / 2;
}

// Makes a tree of the pieces from `begin` to the end of todo_, which are taken off. What is nearer to the eye comes
// first, so that what it covers need not be gone into.
std::uint32_t Partition::grow(std::size_t begin, int depth) {
    if (todo_.size() == begin) return kNone;
    const auto from = todo_.begin() + static_cast<std::ptrdiff_t>(begin);
    if (view_ != nullptr) {
        const auto covered = [this](const Piece& piece) { return coverage_.covers(outlineOf(piece)); };
        todo_.erase(std::remove_if(from, todo_.end(), covered), todo_.end());
        if (todo_.size() == begin) return kCovered;
    }
    const std::size_t end = todo_.size();
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    const auto first = static_cast<std::uint32_t>(pieces_.size());
    const bool givenUp = depth >= kDeepest || pieces_.size() + (end - begin) > most_;
    Plane plane = givenUp ? planeOf(*from) : choose(begin, end);
    if (!givenUp && !parts(plane, begin, end)) plane = planeOf(*from);
    const bool eyeAbove = view_ == nullptr || glm::dot(plane.normal, view_->eye) > plane.offset;

    // What is in the plane is put down; what is behind it stays, what is before it goes on top.
    std::size_t behind = begin;
    near_.clear();
    for (std::size_t i = begin; i < end; ++i) {
        const Piece piece = todo_[i];
        const Where where = givenUp ? Where::in : whereIs(piece, plane);
        if (where == Where::in) {
            pieces_.push_back(piece);
        } else if (where == Where::across) {
            Piece below{}, above{};
            cut(piece, plane, below, above);
            todo_[behind++] = eyeAbove ? below : above;
            near_.push_back(eyeAbove ? above : below);
        } else if ((where == Where::above) == eyeAbove) {
            near_.push_back(piece);
        } else {
            todo_[behind++] = piece;
        }
    }
    const auto last = static_cast<std::uint32_t>(pieces_.size());
    nodes_.push_back({plane.normal, plane.offset, kNone, kNone, first, last});
    todo_.resize(behind);
    todo_.insert(todo_.end(), near_.begin(), near_.end());
    const std::uint32_t near = grow(behind, depth + 1);
    todo_.resize(behind);
    for (std::uint32_t i = first; i < last; ++i) lay(pieces_[i]);
    const std::uint32_t far = grow(begin, depth + 1);
    todo_.resize(begin);
    nodes_[number].above = eyeAbove ? near : far;
    nodes_[number].below = eyeAbove ? far : near;
    return number;
}

// Lays a piece over what is behind it; one that is covered itself is made empty.
void Partition::lay(Piece& piece) {
    if (view_ == nullptr) return;
    if (coverage_.covers(outlineOf(piece))) {
        piece.end = piece.begin;
    } else {
        coverage_.add(outlineOf(piece), weights_[piece.patch]);
    }
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

// Of the planes of a few pieces the one that cuts least and parts most evenly; where there are many and none does, of
// three half-way planes.
Partition::Plane Partition::choose(std::size_t begin, std::size_t end) {
    Plane best = planeOf(todo_[begin]);
    const std::size_t count = end - begin;
    if (count <= 2) return best;
    constexpr std::size_t kTried = 3;
    double least = std::numeric_limits<double>::infinity();
    const auto attempt = [&](const Plane& plane) {
        if (const double costs = cost(plane, begin, end); costs < least) {
            least = costs;
            best = plane;
        }
    };
    const std::size_t tried = std::min(count, kTried);
    for (std::size_t i = 0; i < tried; ++i) attempt(planeOf(todo_[begin + i * count / tried]));
    if (count < kMany || least < kUneven * kSampled) return best;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t step = std::max<std::size_t>(count / 31, 1);
        middles_.clear();
        for (std::size_t i = begin; i < end; i += step) middles_.push_back(corners_[todo_[i].begin][axis]);
        const auto half = middles_.begin() + static_cast<std::ptrdiff_t>(middles_.size() / 2);
        std::nth_element(middles_.begin(), half, middles_.end());
        glm::dvec3 normal(0);
        normal[axis] = 1;
        attempt({normal, *half});
    }
    return best;
}

double Partition::cost(const Plane& plane, std::size_t begin, std::size_t end) const {
    constexpr int kCut = 1;  // as bad as so many more on one side
    const std::size_t step = std::max<std::size_t>((end - begin) / kSampled, 1);
    int costs = 0, unevenness = 0;
    for (std::size_t i = begin; i < end; i += step) {
        const Where where = whereIs(todo_[i], plane);
        costs += where == Where::across ? kCut : 0;
        unevenness += where == Where::above ? 1 : where == Where::below ? -1 : 0;
    }
    return costs + std::abs(unevenness);
}

Partition::Where Partition::whereIs(const Piece& piece, const Plane& plane) const {
    double lowest = 0, highest = 0, sum = 0;
    for (std::uint32_t i = piece.begin; i < piece.end; ++i) {
        const double height = glm::dot(plane.normal, corners_[i]) - plane.offset;
        lowest = std::min(lowest, height);
        highest = std::max(highest, height);
        sum += height;
    }
    const bool below = lowest<-tiny_, above = highest> tiny_;
    if (below && above) return piece.area > smallest_ ? Where::across : sum < 0 ? Where::below : Where::above;
    return below ? Where::below : above ? Where::above : Where::in;
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
            if (h >= -tiny_) addCorner(a);
            if ((h < -tiny_ && g > tiny_) || (h > tiny_ && g < -tiny_)) addCorner(a + (b - a) * (h / (h - g)));
        }
        Piece part{piece.patch, first, static_cast<std::uint32_t>(corners_.size()), 0};
        part.area = areaOf(part);
        return part;
    };
    below = take(-1);
    above = take(1);
}

}  // namespace oval4d::scene
