// Measures every step from a state to its picture, as the server performs them. Prints the medians as one line of JSON.
//   bench_pictures POLYTOPE|FILE.npy|formula [SLICES] [WIDTH] [HEIGHT] [FRAMES] [SETTING=VALUE …]
// The scene is the same as in the programs with which oval4d is compared: hyperplanes from w = −1 to 1 for a
// circumradius of 4/√10, and double rotations. If FRAMES is 0, nothing is drawn. For "formula", the setting formula=…
// is required.

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "allocations.hpp"
#include "libpng_encoder.hpp"
#include "pipeline/pipeline.hpp"
#include "session/load.hpp"
#include "session/object_loader.hpp"
#include "session/picture.hpp"
#include "session/query.hpp"
#include "session/settings.hpp"
#include "wire/state_message.hpp"

namespace oval4d::bench {
namespace {

using nlohmann::json;
using wire::Encoding;

struct Job {
    std::string polytope;
    int slices = 21;
    scene::Viewport viewport;
    int frames = 60;
    session::QueryParameters settings;  ///< further settings, such as projection=perspective
};

template <typename Work>
double secondsOf(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The durations of a repeated operation.
class Samples {
  public:
    Samples() { seconds_.reserve(1U << 18U); }  // so that adding a sample allocates nothing
    void add(double seconds) { seconds_.push_back(seconds); }
    double milliseconds() {
        std::sort(seconds_.begin(), seconds_.end());
        return 1e3 * seconds_[seconds_.size() / 2];
    }

  private:
    std::vector<double> seconds_;
};

class Bench {
  public:
    explicit Bench(const Job& job) : job_(job) {
        polytopes::PolytopeCache cache;
        session::ObjectLoader loader(session::Limits{}, cache);
        session::QueryParameters query{{"slices", std::to_string(job.slices)}};
        query.insert(query.end(), job.settings.begin(), job.settings.end());
        session::State start = session::initialState();
        if (job.polytope.ends_with(".npy")) {
            if (!session::replaceObject(start, arrayIn(job.polytope), loader))
                throw std::runtime_error("the array cannot be shown");
        } else if (job.polytope != "formula") {
            query.emplace_back("polytope", job.polytope);
        }
        const auto state = session::stateFromQuery(query, session::Limits{}, loader, std::move(start));
        if (!state) throw std::runtime_error(state.error().message);
        state_ = *state;
        if (std::ranges::find(query, "spacing", &session::QueryParameters::value_type::first) != query.end()) return;
        state_.slices.spacing =
            std::sqrt(10.0) / 4 * slicing::infoOf(state_.object).circumradius / std::max(1, job.slices / 2);
    }

    json run() {
        const auto [vertices, edges, faces, cells] = slicing::elementCounts(state_.object);
        result_ = {{"polytope", slicing::infoOf(state_.object).name},
                   {"slices", job_.slices},
                   {"pixels", job_.viewport.width * job_.viewport.height},
                   {"size", vertices + edges + faces + cells}};
        slices();
        messages(Encoding::json, "json");
        messages(Encoding::cbor, "cbor");
        if (job_.frames > 0) frames();
        rusage used{};
        getrusage(RUSAGE_SELF, &used);
        result_["memory"] = 1024 * used.ru_maxrss;  // the most resident memory, in bytes
        return result_;
    }

  private:
    static slicing::Object arrayIn(const std::string& path) {
        const auto file = fields::FileContents::map(path);
        if (!file) throw std::runtime_error(file.error().message);
        const auto read = session::readArray(*file, path);
        if (!read) throw std::runtime_error(read.error().message);
        return read->object;
    }

    static std::unique_ptr<raster::Rasterizer> makeRasterizer(parallel::ForkJoin& forkJoin) {
        auto rasterizer = std::make_unique<raster::LocalRasterizer>(&forkJoin);
        rasterizer->limitFaceFilling(pipeline::PictureWorkLimits().fillSteps);
        return rasterizer;
    }

    // Calls step(i) at least `least` times, and for some time, after a warm-up. Then all buffers have their final
    // sizes. Calls it again with the same values of i, and records the allocations per step.
    template <typename Step>
    void repeat(const char* name, int least, Step&& step) {
        const int warm = std::min(least, 24);
        constexpr double kWhile = 0.15;
        Samples unused;
        int i = 0;
        while (i < warm) step(i++, unused);
        Samples whole;
        const auto start = std::chrono::steady_clock::now();
        const auto passed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start); };
        while (i < warm + least || passed().count() < kWhile) step(i++, whole);
        result_["ms"][name] = whole.milliseconds();
        const auto before = allocations();
        for (i = warm; i < warm + least; ++i) step(i, unused);
        result_["allocations"][name] = static_cast<double>(allocations() - before) / least;
    }

    void turn(int i) {
        state_.orientation = geometry::Rotation(geometry::RotationAngles{
            geometry::Plane::xw, 0.3 + i * std::numbers::pi / 97, 0.2 + i * std::numbers::pi / 131});
    }

    const scene::PictureRequest& picture(slicing::Quality quality = slicing::Quality::full) {
        session::writePictureRequest(state_, job_.viewport, quality, picture_);
        return picture_;
    }

    void cut(int i) {
        turn(i);
        pipeline_.slice(picture(), set_);
    }

    void slices() {
        std::size_t vertices = 0, edges = 0, faces = 0, steps = 0;
        repeat("slice", 50, [&](int i, Samples& whole) {
            cut(i);
            whole.add(pipeline_.times().slice);
            vertices += set_.vertices.size();
            edges += set_.edges.size();
            faces += set_.faceSource.size();
            ++steps;
        });
        result_["cut"] = {vertices / steps, edges / steps, faces / steps};
    }

    void messages(Encoding encoding, const std::string& name) {
        Samples write;
        std::size_t bytes = 0, steps = 0;
        repeat(("state to " + name).c_str(), 50, [&](int i, Samples& whole) {
            whole.add(secondsOf([&] {
                cut(i);
                pipeline_.writeSlices(picture_, set_, 1, {}, encoding, text_);
            }));
            write.add(pipeline_.times().write);
            bytes += text_.size();
            ++steps;
        });
        result_["ms"][name] = write.milliseconds();
        result_["bytes"][name] = bytes / steps;
    }

    void frames() {
        Samples compose, draw, encode, libpng;
        std::size_t ours = 0, theirs = 0, steps = 0;
        repeat("frame", job_.frames, [&](int i, Samples& whole) {
            whole.add(secondsOf([&] {
                turn(i);
                wire::stateMessage(state_, pipeline_.nameFocusSection(picture()).names, 1, {}, text_);
                pipeline_.drawPng(picture_, text_, png_);
            }));
            compose.add(pipeline_.times().compose);
            draw.add(pipeline_.times().draw);
            encode.add(pipeline_.times().encode);
        });
        if (slicing::fieldIn(state_.object) != nullptr) {
            repeat("draft", job_.frames, [&](int i, Samples& whole) {
                whole.add(secondsOf([&] {
                    turn(i);
                    wire::stateMessage(state_, pipeline_.nameFocusSection(picture(slicing::Quality::draft)).names, 1,
                                       {}, text_);
                    pipeline_.drawPng(picture_, text_, png_);
                }));
            });
        }
        for (int i = 0; i < std::min(job_.frames, 24); ++i) {
            turn(5 * i);
            pipeline_.drawPng(picture(), {}, png_);
            const LibpngFile again = encodeByLibpng(png_);
            libpng.add(again.seconds);
            ours += png_.size();
            theirs += again.bytes;
            ++steps;
        }
        result_["ms"]["compose"] = compose.milliseconds();
        result_["ms"]["draw"] = draw.milliseconds();
        result_["ms"]["encode"] = encode.milliseconds();
        result_["ms"]["libpng"] = libpng.milliseconds();
        result_["bytes"]["frame"] = ours / steps;
        result_["bytes"]["libpng"] = theirs / steps;
    }

    const Job job_;
    session::State state_ = session::initialState();
    scene::PictureRequest picture_;  // the last result of picture()
    parallel::ForkJoin forkJoin_;
    pipeline::Pipeline pipeline_{makeRasterizer(forkJoin_), &forkJoin_};
    slicing::SliceSet set_;
    std::string text_;
    std::vector<std::uint8_t> png_;
    json result_;
};

}  // namespace
}  // namespace oval4d::bench

int main(int argc, char** argv) {
    const auto number = [&](int i, int otherwise) { return argc > i ? std::atoi(argv[i]) : otherwise; };
    try {
        oval4d::bench::Job job{
            argc > 1 ? argv[1] : "5-cell", number(2, 21), {number(3, 1280), number(4, 720)}, number(5, 60), {}};
        for (int i = 6; i < argc; ++i) {
            const std::string setting = argv[i];
            const std::size_t equals = std::min(setting.find('='), setting.size());
            job.settings.emplace_back(setting.substr(0, equals), setting.substr(std::min(equals + 1, setting.size())));
        }
        std::puts(oval4d::bench::Bench(job).run().dump().c_str());
    } catch (const std::exception& fault) {
        std::fprintf(stderr, "pictures: %s\n", fault.what());
        return 1;
    }
}
