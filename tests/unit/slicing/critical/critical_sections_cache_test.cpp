#include "slicing/critical/critical_sections_cache.hpp"

#include <memory>

#include <gtest/gtest.h>

#include "unit/slicing/support.hpp"

namespace oval4d::slicing {
namespace {

CriticalSectionsPtr resultOfSize(std::size_t changes) {
    CriticalSections result;
    result.all.resize(changes);
    return std::make_shared<const CriticalSections>(std::move(result));
}

TEST(CriticalSectionsCache, FindsOnlyWhatHasTheSameArguments) {
    const polytopes::Polytope polytope = support::rectifiedFiveCell();
    polytopes::Polytope other = polytope;
    ++other.serial;
    const Object object = support::objectOf(polytope);
    const geometry::Rotation turned(geometry::RotationAngles{geometry::Plane::xw, 0.1, {}});
    CriticalSectionsCache cache(1U << 20U);
    const CriticalSectionsPtr result = resultOfSize(3);
    cache.add(object, turned, {{1}}, result);
    EXPECT_EQ(cache.find(object, turned, {{1}}), result);
    EXPECT_EQ(cache.find(object, {}, {{1}}), nullptr);
    EXPECT_EQ(cache.find(object, turned, {{2}}), nullptr);
    EXPECT_EQ(cache.find(object, turned, {{1}, fields::BodySide::above}), nullptr);
    EXPECT_EQ(cache.find(support::objectOf(other), turned, {{1}}), nullptr);
}

TEST(CriticalSectionsCache, ForgetsTheLeastRecentlyUsed) {
    const polytopes::Polytope polytope = support::rectifiedFiveCell();
    const Object object = support::objectOf(polytope);
    CriticalSectionsCache cache(3500 * sizeof(CriticalSection));
    for (const double level : {1, 2, 3}) {
        cache.add(object, {}, {{level}}, resultOfSize(1000));
        cache.find(object, {}, {{1}});
    }
    EXPECT_LE(cache.bytes(), 3500 * sizeof(CriticalSection));
    cache.add(object, {}, {{4}}, resultOfSize(1000));
    EXPECT_NE(cache.find(object, {}, {{1}}), nullptr);
    EXPECT_EQ(cache.find(object, {}, {{2}}), nullptr);
    cache.add(object, {}, {{5}}, resultOfSize(4000));
    EXPECT_EQ(cache.find(object, {}, {{5}}), nullptr) << "larger than the limit";
    EXPECT_NE(cache.find(object, {}, {{4}}), nullptr);
    EXPECT_LE(cache.bytes(), 3500 * sizeof(CriticalSection));
}

}  // namespace
}  // namespace oval4d::slicing
