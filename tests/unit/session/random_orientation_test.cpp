// Tests of random orientations.

#include <cstdint>

#include <gtest/gtest.h>
#include <glm/matrix.hpp>

#include "unit/session/support.hpp"

namespace oval4d::session {
namespace {

TEST(TurnAtRandom, DependsOnlyOnTheSeed) {
    Session one, two;
    press(two, "ryt");
    const geometry::Rotation before = two.current.orientation;
    must(one, TurnAtRandom{2017});
    must(two, TurnAtRandom{2017});
    EXPECT_EQ(one.current.orientation, two.current.orientation);
    must(one, TurnAtRandom{2018});
    EXPECT_NE(one.current.orientation, two.current.orientation);
    must(two, Undo{});
    EXPECT_EQ(two.current.orientation, before);
    must(one, TurnAtRandom{});
    must(two, TurnAtRandom{});
    EXPECT_NE(one.current.orientation, two.current.orientation) << "without a seed, orientations differ";
}

// All rotations are equally probable. Each row and column of the matrix is then a random direction, so each entry has
// the mean 0 and the variance 1/4. Over 2,000 matrices, the mean of an entry has the standard deviation 0.011, and the
// mean of its square 0.004.
TEST(TurnAtRandom, MakesAllRotationsEquallyProbable) {
    constexpr int kCount = 2000;
    glm::dmat4 sum(0), squares(0);
    Session session;
    for (int seed = 0; seed < kCount; ++seed) {
        must(session, TurnAtRandom{static_cast<std::uint64_t>(seed)});
        const glm::dmat4 matrix = session.current.orientation.matrix();
        sum += matrix;
        squares += glm::matrixCompMult(matrix, matrix);
    }
    for (int i = 0; i < 4; ++i) {
        for (int k = 0; k < 4; ++k) {
            EXPECT_NEAR(sum[i][k] / kCount, 0, 0.06);
            EXPECT_NEAR(squares[i][k] / kCount, 0.25, 0.025);
        }
    }
}

}  // namespace
}  // namespace oval4d::session
