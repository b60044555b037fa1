// Measures how long it takes to build polytopes and to read files: 4OFF files and points of convex hulls, of growing
// sizes.

#include <benchmark/benchmark.h>

#include <array>
#include <memory>
#include <sstream>

#include "polytopes/construction/coxeter.hpp"
#include "polytopes/import/import.hpp"

namespace oval4d::bench {
namespace {

/// A polytope that is built from its Coxeter diagram.
struct Subject {
    const char* name;
    int p, q, r;                 ///< the symbol {p, q, r}
    std::array<bool, 4> ringed;  ///< the ringed nodes of the diagram

    polytopes::CoxeterDiagram diagram() const {
        return polytopes::CoxeterDiagram::linear({p, 1}, {q, 1}, {r, 1}, ringed);
    }
    polytopes::Polytope build() const {
        return polytopes::wythoffConstruction(name, diagram(), polytopes::mirrorsOf(diagram()));
    }
};
constexpr Subject kSubjects[] = {
    {"5-cell", 3, 3, 3, {true, false, false, false}},
    {"8-cell", 4, 3, 3, {true, false, false, false}},
    {"24-cell", 3, 4, 3, {true, false, false, false}},
    {"omnitruncated 5-cell", 3, 3, 3, {true, true, true, true}},
    {"120-cell", 5, 3, 3, {true, false, false, false}},
    {"600-cell", 3, 3, 5, {true, false, false, false}},
    {"omnitruncated 24-cell", 3, 4, 3, {true, true, true, true}},
    {"truncated 120-cell", 5, 3, 3, {true, true, false, false}},
    {"cantitruncated 120-cell", 5, 3, 3, {true, true, true, false}},
    {"omnitruncated 120-cell", 5, 3, 3, {true, true, true, true}},
};

/// Returns the polytope of kSubjects[number]. The first call with a number builds it.
std::shared_ptr<const polytopes::Polytope> subject(std::size_t number) {
    static std::array<std::shared_ptr<const polytopes::Polytope>, std::size(kSubjects)> built;
    auto& slot = built.at(number);
    if (!slot) slot = std::make_shared<const polytopes::Polytope>(kSubjects[number].build());
    return slot;
}

void build(benchmark::State& state) {
    const Subject& built = kSubjects[state.range(0)];
    const auto& p = *subject(state.range(0));
    state.SetLabel(built.name);
    for (auto _ : state) benchmark::DoNotOptimize(built.build());
    state.counters["size"] = static_cast<double>(p.vertices.size() + p.edges.size() + p.faces.size() + p.cells.size());
}

void writePoints(const polytopes::Polytope& p, std::ostream& out) {
    out.precision(17);
    for (const auto& v : p.vertices) out << v.x << ' ' << v.y << ' ' << v.z << ' ' << v.w << '\n';
}

std::string off4(const polytopes::Polytope& p) {
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

void read(benchmark::State& state, polytopes::PolytopeFileFormat format, const std::string& text) {
    for (auto _ : state) benchmark::DoNotOptimize(polytopes::importPolytope(format, text, "p", {}));
    state.counters["bytes"] = static_cast<double>(text.size());
}

void importOff4(benchmark::State& state) {
    const auto polytope = subject(state.range(0));
    state.SetLabel(polytope->name + ", " + std::to_string(polytope->edges.size()) + " edges");
    read(state, polytopes::PolytopeFileFormat::off4, off4(*polytope));
}

// Measures the import of the duoprism of two n-gons, which has 2 n² edges.
void importDuoprism(benchmark::State& state) {
    polytopes::CoxeterDiagram diagram;
    const auto n = static_cast<int>(state.range(0));
    for (int i = 0; i < 4; i += 2) diagram.branches[i][i + 1] = diagram.branches[i + 1][i] = {n, 1};
    diagram.ringed = {true, false, true, false};
    const auto polytope = polytopes::wythoffConstruction("duoprism", diagram, polytopes::mirrorsOf(diagram), 100'000);
    state.SetLabel(std::to_string(polytope.edges.size()) + " edges");
    read(state, polytopes::PolytopeFileFormat::off4, off4(polytope));
}

void importPoints(benchmark::State& state) {
    const auto polytope = subject(state.range(0));
    state.SetLabel("hull of " + std::to_string(polytope->vertices.size()) + " points");
    std::ostringstream text;
    writePoints(*polytope, text);
    read(state, polytopes::PolytopeFileFormat::points, text.str());
}

BENCHMARK(build)->DenseRange(0, std::ssize(kSubjects) - 1)->Unit(benchmark::kMillisecond);
BENCHMARK(importOff4)->Arg(0)->Arg(5)->Arg(9)->Unit(benchmark::kMillisecond);
BENCHMARK(importDuoprism)->Arg(224)->Unit(benchmark::kMillisecond);
BENCHMARK(importPoints)->Arg(5)->Arg(4)->Arg(7)->Arg(9)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace oval4d::bench
