// How long files take to read: 4OFF of growing size, and hulls of points.

#include <benchmark/benchmark.h>

#include <sstream>

#include "geometry/import.hpp"
#include "path.hpp"

namespace oval4d::bench {
namespace {

void writePoints(const geometry::Polytope& p, std::ostream& out) {
    out.precision(17);
    for (const auto& v : p.vertices) out << v.x << ' ' << v.y << ' ' << v.z << ' ' << v.w << '\n';
}

std::string off4(const geometry::Polytope& p) {
    std::ostringstream out;
    out << "4OFF\n" << p.vertices.size() << ' ' << p.faces.size() << " 0 " << p.cells.size() << '\n';
    writePoints(p, out);
    for (const auto* lists : {&p.faces, &p.cells}) {
        for (std::size_t i = 0; i < lists->size(); ++i) {
            out << (*lists)[i].size();
            for (const auto item : (*lists)[i]) out << ' ' << item;
            out << '\n';
        }
    }
    return out.str();
}

void read(benchmark::State& state, geometry::FileFormat format, const std::string& text) {
    for (auto _ : state) benchmark::DoNotOptimize(geometry::importPolytope(format, text, "p", {}));
    state.counters["bytes"] = static_cast<double>(text.size());
}

void importOff4(benchmark::State& state) {
    const auto polytope = subject(state.range(0));
    state.SetLabel(polytope->name + ", " + std::to_string(polytope->edges.size()) + " edges");
    read(state, geometry::FileFormat::off4, off4(*polytope));
}

// A duoprism of two n-gons: 2 n² edges.
void importDuoprism(benchmark::State& state) {
    geometry::Diagram diagram;
    const auto n = static_cast<int>(state.range(0));
    for (int i = 0; i < 4; i += 2) diagram.branches[i][i + 1] = diagram.branches[i + 1][i] = {n, 1};
    diagram.ringed = {true, false, true, false};
    const auto polytope = geometry::wythoff("duoprism", diagram, geometry::mirrorsOf(diagram), 100'000);
    state.SetLabel(std::to_string(polytope.edges.size()) + " edges");
    read(state, geometry::FileFormat::off4, off4(polytope));
}

void importPoints(benchmark::State& state) {
    const auto polytope = subject(state.range(0));
    state.SetLabel("hull of " + std::to_string(polytope->vertices.size()) + " points");
    std::ostringstream text;
    writePoints(*polytope, text);
    read(state, geometry::FileFormat::points, text.str());
}

BENCHMARK(importOff4)->Arg(0)->Arg(5)->Arg(9)->Unit(benchmark::kMillisecond);
BENCHMARK(importDuoprism)->Arg(224)->Unit(benchmark::kMillisecond);
BENCHMARK(importPoints)->Arg(5)->Arg(4)->Arg(7)->Arg(9)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace oval4d::bench
