#include <array>
#include <memory>
#include <stop_token>
#include <string_view>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "unit/polytopes/support.hpp"

namespace {

using namespace oval4d;
using polytopes::PolytopeCache;
using support::designFor;

TEST(PolytopeCache, buildsEachPolytopeOnceWhileItIsHeld) {
    PolytopeCache cache(0);
    const auto design = designFor("runcinated 120-cell");
    EXPECT_EQ(cache.find(design), nullptr);
    std::vector<PolytopeCache::SharedPolytope> got(4);
    {
        std::vector<std::jthread> threads;
        for (auto& mine : got) threads.emplace_back([&] { mine = cache.findOrBuild(design); });
    }
    for (const auto& mine : got) EXPECT_EQ(mine, got[0]);
    EXPECT_EQ(cache.find(design), got[0]);
    EXPECT_EQ(cache.bytes(), 0U);
    const auto serial = got[0]->serial;
    got.clear();
    EXPECT_EQ(cache.find(design), nullptr);
    EXPECT_NE(cache.findOrBuild(design)->serial, serial) << "it is built again";
}

TEST(PolytopeCache, keepsUnusedPolytopesUpToItsBound) {
    const std::size_t bound = std::size_t{1} << 20U;
    PolytopeCache cache(bound);
    const auto serial = cache.findOrBuild(designFor("8-cell"))->serial;
    EXPECT_EQ(cache.findOrBuild(designFor("8-cell"))->serial, serial) << "it is kept though nobody holds it";
    EXPECT_EQ(cache.bytes(), polytopes::memoryOf(*cache.findOrBuild(designFor("8-cell"))));
    for (const char* name :
         {"120-cell", "rectified 600-cell", "rectified 120-cell", "truncated 600-cell", "600-cell", "24-cell"}) {
        (void)cache.findOrBuild(designFor(name));
        EXPECT_LE(cache.bytes(), bound) << name;
    }
    EXPECT_GT(cache.bytes(), 0U);
    EXPECT_EQ(cache.find(designFor("8-cell")), nullptr) << "the least recently used polytope is dropped";
    EXPECT_NE(cache.find(designFor("24-cell")), nullptr);
}

TEST(PolytopeCache, dropsTheLeastRecentlyUsedFirst) {
    const auto sizeOf = [](std::string_view name) { return polytopes::memoryOf(support::named(name)); };
    PolytopeCache cache(sizeOf("8-cell") + sizeOf("16-cell") + sizeOf("24-cell"));
    (void)cache.findOrBuild(designFor("8-cell"));
    (void)cache.findOrBuild(designFor("16-cell"));
    (void)cache.findOrBuild(designFor("24-cell"));
    EXPECT_NE(cache.find(designFor("8-cell")), nullptr);
    (void)cache.findOrBuild(designFor("rectified 5-cell"));
    EXPECT_NE(cache.find(designFor("8-cell")), nullptr) << "a search is a use";
    EXPECT_EQ(cache.find(designFor("16-cell")), nullptr);
}

TEST(PolytopeCache, findsItsOwnWhileOthersAskForThem) {
    PolytopeCache cache;
    const auto design = designFor("8-cell");
    const auto polytope = cache.findOrBuild(design);
    const std::jthread other([&](const std::stop_token& stop) {
        while (!stop.stop_requested()) (void)cache.findOrBuild(design);
    });
    int unknown = 0;
    for (int i = 0; i < 200'000; ++i) unknown += cache.find(design) == polytope ? 0 : 1;
    EXPECT_EQ(unknown, 0);
}

TEST(PolytopeCache, hasOneFiveCellForAll) {
    PolytopeCache one, other(0);
    EXPECT_EQ(one.find(designFor("pentachoron")), polytopes::fiveCell());
    EXPECT_EQ(one.findOrBuild(designFor("5-cell")), polytopes::fiveCell());
    EXPECT_EQ(other.findOrBuild(designFor("5-cell")), polytopes::fiveCell());
    EXPECT_NE(one.findOrBuild(designFor("8-cell")), other.findOrBuild(designFor("8-cell")));
}

TEST(PolytopeCache, marksWhatItsNameIsEnoughToBuild) {
    PolytopeCache cache;
    for (const char* name : {"5-cell", "24-cell", "7,9-duoprism", "snub 24-cell", "{5/2,3,5}", "x3o4x3o"})
        EXPECT_TRUE(cache.findOrBuild(designFor(name))->rebuildableFromName) << name;
    const polytopes::Polytope& cell = *polytopes::fiveCell();
    EXPECT_FALSE(polytopes::makePolytope("5-cell", cell.vertices, cell.faces, cell.cells).rebuildableFromName);
}

}  // namespace
