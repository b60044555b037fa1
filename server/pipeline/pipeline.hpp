#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "image/png.hpp"
#include "parallel/fork_join.hpp"
#include "parallel/ownership.hpp"
#include "pipeline/focus_section.hpp"
#include "raster/rasterizer.hpp"
#include "scene/composer.hpp"
#include "scene/picture_request.hpp"
#include "slicing/occlusion.hpp"
#include "slicing/slicer.hpp"
#include "wire/encoding.hpp"
#include "wire/slices_message.hpp"

namespace oval4d::pipeline {

/// The time that each step of making a picture took, in seconds; 0 for a step that did not run. `write` is the time to
/// write a `slices` message, and `encode` the time to encode a PNG file. raster::DrawTimes has the times of the other
/// steps.
struct PictureTimes : raster::DrawTimes {
    double write = 0, encode = 0;
};

/// Limits on the time and the memory that making a picture takes.
struct PictureWorkLimits {
    /// The maximum number of steps to fill self-intersecting faces (see slicing::FaceFiller::fill()).
    std::size_t fillSteps = 20'000'000;
    /// The maximum number of edges of all slices together (see slicing::checkSliceEdges()).
    std::size_t sliceEdges = 5'000'000;
    /// The maximum number of steps to find which elements lie behind other cells (see
    /// slicing::OcclusionFinder::findDrawnElements()).
    std::size_t occlusionSteps = slicing::OcclusionFinder::kDefaultSteps;
};

/// Makes what a client displays from a scene::PictureRequest, the description of a picture: a `slices` message (picture
/// → slices → scene → message) or a PNG file (picture → pixels → file). Used by the server and the command line. Keeps
/// its memory between calls. Only one thread at a time may use a pipeline.
class Pipeline {
  public:
    /// `rasterizer` draws the pictures. If `forkJoin` is not null, large objects and pictures are processed on two
    /// cores; `forkJoin` must outlive this object. PictureWorkLimits::fillSteps and PictureWorkLimits::occlusionSteps
    /// limit only messages, because the rasterizer has limits of its own.
    Pipeline(std::unique_ptr<raster::Rasterizer> rasterizer, parallel::ForkJoin* forkJoin,
             PictureWorkLimits limits = {});

    /// Returns the section in the focus slice (the middle one) with its two names, for the `state` message: the name of
    /// the slice, such as "icosahedron", and the name of the convex hull of the object's vertices in the slice (see
    /// slicing::SliceAndHullNames). A name is empty if the section has no such name. `slices` is the result of slice()
    /// for this picture; if it is null, the focus slice is cut. If this section was named last, returns the same names
    /// without finding them again.
    slicing::NamedSection nameFocusSection(const scene::PictureRequest& picture,
                                           const slicing::SliceSet* slices = nullptr);
    /// Gives the pipeline the names of a section, so that later calls need not find these names.
    void reuseFocusSectionNames(const slicing::NamedSection& section);

    /// Slices the object of the picture, and writes the slices to `out`. Overwrites `out` and reuses its memory. Throws
    /// slicing::TooManySliceEdges if the slices exceed PictureWorkLimits::sliceEdges, and std::runtime_error if the
    /// samples of a field are in a file that can no longer be read.
    void slice(const scene::PictureRequest& picture, slicing::SliceSet& out);

    /// Writes to `out` the `slices` message for this picture. `slices` is the result of slice() for this picture, or
    /// for a picture that differs only in its look and viewport. `revision` is Session::revision. `id` is the id of the
    /// request that the message answers; empty if there is none. Overwrites `out`.
    void writeSlices(const scene::PictureRequest& picture, const slicing::SliceSet& slices, std::uint64_t revision,
                     std::optional<double> id, wire::Encoding encoding, std::string& out);

    /// Returns the `at` message, which says what the picture shows at `point`, in pixels from the upper left corner
    /// (see scene::pickElement() and scene::pickLevel()). `revision` is Session::revision. `id` is the id of the
    /// request that the message answers; empty if there is none. Slices the object, unless the last call has cut the
    /// same slices. Extracts no surfaces of a field; instead, evaluates its function along one ray and, in the matrix,
    /// for the contours. Throws slicing::TooManySliceEdges and std::runtime_error as slice() does.
    std::string describePoint(const scene::PictureRequest& picture, std::uint64_t revision, std::optional<double> id,
                              glm::dvec2 point);

    /// Draws the picture and encodes it as a PNG file, with `stateText`, the `state` message, in a text chunk.
    /// Overwrites `out`. Calls `drawn`, if given, when the picture is drawn but not yet encoded. Throws
    /// slicing::TooManySliceEdges as slice() does. Throws std::runtime_error if the picture cannot be drawn; the most
    /// likely reason is that no GL context can be created.
    void drawPng(const scene::PictureRequest& picture, std::string_view stateText, std::vector<std::uint8_t>& out,
                 const std::function<void()>& drawn = {});

    /// Prepares for drawing, so that the first frame takes no longer than later ones (see Rasterizer::warmUp()).
    void warmUp() { rasterizer_->warmUp(); }

    /// Frees the memory that the pipeline keeps for the next picture, which is as much as the largest picture needed.
    /// Call this function when the pipeline is idle, because allocating the memory again takes a few milliseconds.
    void freeMemory();

    /// Returns the times of the last calls. slice() and drawPng() first set all times to 0. writeSlices() replaces only
    /// `compose` and `write`.
    const PictureTimes& times() const { return times_; }

  private:
    // The slices of the last call of describePoint(), without the surfaces and the fog of a field, and the data that
    // determine them.
    struct SlicesForPointing {
        struct SlicingInput {
            std::uint64_t object = 0;  // the serial number of the object
            geometry::Rotation orientation;
            geometry::Hyperplanes planes;
            bool operator==(const SlicingInput&) const = default;
        };
        std::optional<SlicingInput> input;  // empty if `slices` is not valid
        slicing::SliceSet slices;
    };

    // The objects and the memory that the next call reuses.
    struct Workspace {
        explicit Workspace(parallel::ForkJoin* forkJoin) : slicer(forkJoin), encoder(forkJoin) {}
        slicing::Slicer slicer;
        slicing::SurfaceDetail detail;
        SlicesForPointing toPointAt;
        FocusSectionNamer sectionNamer;
        scene::Composer composer;
        scene::Scene scene;
        wire::SlicesMessageWriter slicesWriter;
        image::PngEncoder encoder;
    };

    const slicing::SliceSet& slicesForPointing(const scene::PictureRequest& picture);

    const std::unique_ptr<raster::Rasterizer> rasterizer_;
    parallel::ForkJoin* const forkJoin_;
    const PictureWorkLimits limits_;
    Workspace workspace_;
    PictureTimes times_;
    parallel::ExclusiveUseAssertion inUse_;
};

}  // namespace oval4d::pipeline
