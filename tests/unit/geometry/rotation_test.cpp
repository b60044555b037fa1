#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "geometry/rotation.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::geometry;
using std::numbers::pi;

double difference(const glm::dmat4& a, const glm::dmat4& b) {
    double worst = 0;
    for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 4; ++r) worst = std::max(worst, std::abs(a[c][r] - b[c][r]));
    }
    return worst;
}

// Returns the matrix of R_ab(θ) by its definition: a' = a cos θ − b sin θ, b' = a sin θ + b cos θ.
glm::dmat4 byDefinition(Plane plane, double angle) {
    const auto axis = [](char letter) { return letter == 'w' ? 3 : letter - 'x'; };
    const int a = axis(planeName(plane)[0]);
    const int b = axis(planeName(plane)[1]);
    glm::dmat4 m(1);
    m[a][a] = m[b][b] = std::cos(angle);
    m[b][a] = -std::sin(angle);
    m[a][b] = std::sin(angle);
    return m;
}

RotationAngles randomTurn(std::mt19937& random, bool doubled) {
    std::uniform_real_distribution<double> angle(-2 * pi, 2 * pi);
    const Plane plane = kPlanes.at(random() % 6);
    const double alpha = angle(random);
    return {plane, alpha, doubled ? std::optional(angle(random)) : std::nullopt};
}

// Returns a turn in all planes whose sum of squared angles is at most `size`².
RotationAngles randomTurnInAllPlanes(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> angle(-1, 1);
    RotationAngles turn;
    for (const Plane plane : kPlanes) turn[plane] = angle(random) * size / std::sqrt(double(kPlanes.size()));
    return turn;
}

TEST(Rotation, turnsTheFirstAxisTowardTheSecond) {
    for (const Plane plane : kPlanes) {
        for (const double angle : {0.3, pi / 2, -1.7}) {
            EXPECT_LT(difference(Rotation(RotationAngles{plane, angle, {}}).matrix(), byDefinition(plane, angle)),
                      1e-15)
                << planeName(plane);
        }
    }
}

TEST(Rotation, doubleRotationIsTheCommutingProductOfItsSimpleRotations) {
    std::mt19937 random(1);
    for (int i = 0; i < 200; ++i) {
        const RotationAngles turn = randomTurn(random, true);
        const Plane plane = turn.planes()[0];
        const Rotation first(RotationAngles{plane, *turn[plane], {}});
        const Rotation second(RotationAngles{orthogonalComplement(plane), *turn[orthogonalComplement(plane)], {}});
        EXPECT_LT(difference(Rotation(turn).matrix(), (first * second).matrix()), 1e-14);
        EXPECT_LT(difference(Rotation(turn).matrix(), (second * first).matrix()), 1e-14);
    }
}

// A rotation in all planes is exp(A), the limit of (1 + A / n)^n: n steps, each a small rotation in one plane after
// the other.
TEST(Rotation, turnsInAllPlanesAtTheSameTime) {
    std::mt19937 random(21);
    for (int i = 0; i < 20; ++i) {
        const RotationAngles turn = randomTurnInAllPlanes(random, 2);
        const int steps = 20'000;
        Rotation product;
        for (int k = 0; k < steps; ++k) {
            for (const Plane plane : kPlanes) product = Rotation(RotationAngles(plane, *turn[plane] / steps)) * product;
        }
        EXPECT_LT(difference(Rotation(turn).matrix(), product.matrix()), 1e-3);
        EXPECT_LT(difference((Rotation(turn) * Rotation(turn)).matrix(), Rotation(turn.scaled(2)).matrix()), 1e-13);
        EXPECT_LT(difference((Rotation(turn) * Rotation(turn.inverse())).matrix(), glm::dmat4(1)), 1e-13);
    }
}

TEST(Rotation, isTheRotationOfItsTurn) {
    std::mt19937 random(22);
    for (int i = 0; i < 200; ++i) {
        // all angles are below π, so no other turn with smaller angles gives the same rotation
        const RotationAngles small = randomTurnInAllPlanes(random, 3);
        const RotationAngles again = Rotation(small).smallestAngles();
        for (const Plane plane : kPlanes) EXPECT_NEAR(again[plane].value_or(0), *small[plane], 1e-12);
        const Rotation any = Rotation(randomTurn(random, true)) * Rotation(randomTurn(random, true));
        EXPECT_LT(difference(Rotation(any.smallestAngles()).matrix(), any.matrix()), 1e-12);
    }
    EXPECT_TRUE(Rotation().smallestAngles().planes().empty());
    EXPECT_EQ(Rotation(RotationAngles(Plane::yw, 0.3)).smallestAngles().planes(), std::vector{Plane::yw});
    const Rotation central(glm::dquat(-1, 0, 0, 0), glm::dquat(1, 0, 0, 0));
    EXPECT_LT(difference(Rotation(central.smallestAngles()).matrix(), central.matrix()), 1e-12);
    const RotationAngles sum =
        RotationAngles(Plane::xy, 5) + RotationAngles(Plane::xy, 4) + RotationAngles(Plane::xw, 1);
    EXPECT_EQ(sum[Plane::xy], 9);
    EXPECT_EQ(sum.planes(), (std::vector{Plane::xy, Plane::xw}));
}

TEST(Rotation, perpendicularPlanesShareNoAxis) {
    for (const Plane plane : kPlanes) {
        EXPECT_EQ(orthogonalComplement(orthogonalComplement(plane)), plane);
        for (const char axis : planeName(plane))
            EXPECT_EQ(planeName(orthogonalComplement(plane)).find(axis), std::string_view::npos);
        EXPECT_EQ(planeNamed(planeName(plane)), plane);
    }
    EXPECT_EQ(planeNamed("yx"), std::nullopt);
}

TEST(Rotation, composesExtrinsically) {
    std::mt19937 random(2);
    for (int i = 0; i < 200; ++i) {
        const Rotation a(randomTurn(random, true));
        const Rotation b(randomTurn(random, false));
        EXPECT_LT(difference((b * a).matrix(), b.matrix() * a.matrix()), 1e-14);
    }
}

TEST(Rotation, isUndoneByItsInverse) {
    std::mt19937 random(3);
    Rotation start;
    for (int i = 0; i < 500; ++i) {
        const RotationAngles turn = randomTurn(random, i % 2 == 0);
        start = Rotation(turn) * start;
        const Rotation back = Rotation(turn.inverse()) * (Rotation(turn) * start);
        EXPECT_LT(difference(back.matrix(), start.matrix()), 1e-12);
        EXPECT_LT(difference((start.inverse() * start).matrix(), glm::dmat4(1)), 1e-14);
    }
}

TEST(Rotation, doesNotDriftOverAMillionSteps) {
    std::mt19937 random(4);
    std::vector<Rotation> steps;
    for (int i = 0; i < 64; ++i) steps.emplace_back(randomTurn(random, i % 3 == 0));
    Rotation orientation;
    std::vector<std::uint8_t> taken(1'000'000);
    for (auto& step : taken) {
        step = random() % steps.size();
        orientation = steps[step] * orientation;
    }
    const glm::dmat4 m = orientation.matrix();
    EXPECT_LT(difference(glm::transpose(m) * m, glm::dmat4(1)), 1e-12);
    EXPECT_NEAR(glm::determinant(m), 1, 1e-12);
}

TEST(Rotation, isRecoveredFromItsMatrix) {
    std::mt19937 random(5);
    for (int i = 0; i < 500; ++i) {
        const Rotation made = Rotation(randomTurn(random, true)) * Rotation(randomTurn(random, true));
        const auto found = Rotation::fromMatrix(made.matrix());
        ASSERT_TRUE(found);
        EXPECT_LT(difference(found->matrix(), made.matrix()), 1e-14);
    }
    EXPECT_LT(difference(Rotation::fromMatrix(glm::dmat4(-1))->matrix(), glm::dmat4(-1)), 1e-15);
}

TEST(Rotation, betweenTwoDirectionsIsTheShortestOne) {
    std::mt19937 random(31);
    std::normal_distribution<double> normal;
    const auto vector = [&] { return glm::dvec4(normal(random), normal(random), normal(random), normal(random)); };
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec4 from = vector();
        const glm::dvec4 to = i % 10 == 0 ? -2.0 * from : i % 10 == 1 ? from + 1e-9 * vector() : vector();
        const Rotation rotation = Rotation::between(from, to);
        EXPECT_LT(glm::distance(rotation(glm::normalize(from)), glm::normalize(to)), 1e-7);
        const double angle = std::acos(std::clamp(glm::dot(glm::normalize(from), glm::normalize(to)), -1.0, 1.0));
        EXPECT_NEAR(rotation.largerAngle(), angle, 1e-7);
        if (i % 10 <= 1) continue;  // opposite or nearly equal directions do not determine the plane of the rotation
        // The rotation leaves a vector that is perpendicular to both directions unchanged.
        const glm::dvec4 a = glm::normalize(from);
        const glm::dvec4 b = glm::normalize(glm::normalize(to) - glm::dot(a, glm::normalize(to)) * a);
        const glm::dvec4 v = vector();
        const glm::dvec4 rest = v - glm::dot(v, a) * a - glm::dot(v, b) * b;
        EXPECT_LT(glm::distance(rotation(rest), rest), 1e-7);
    }
}

TEST(Rotation, hasPowersThatAddUp) {
    std::mt19937 random(32);
    std::uniform_real_distribution<double> fraction(0, 1);
    for (int i = 0; i < 200; ++i) {
        const Rotation rotation(randomTurn(random, i % 2 == 0));
        const double f = fraction(random);
        EXPECT_LT(difference(rotation.power(0).matrix(), glm::dmat4(1)), 1e-12);
        EXPECT_LT(difference(rotation.power(1).matrix(), rotation.matrix()), 1e-12);
        EXPECT_LT(difference((rotation.power(f) * rotation.power(1 - f)).matrix(), rotation.matrix()), 1e-9);
        EXPECT_NEAR(rotation.power(f).largerAngle(), f * rotation.largerAngle(), 1e-9);
    }
    for (const double angle : {0.1, 1.0, 3.0}) {
        for (const double f : {0.25, 0.5, 0.75}) {
            EXPECT_LT(difference(Rotation(RotationAngles{Plane::xw, angle, {}}).power(f).matrix(),
                                 Rotation(RotationAngles{Plane::xw, f * angle, {}}).matrix()),
                      1e-12);
        }
    }
}

TEST(Rotation, isRestoredFromItsQuaternionsBitByBit) {
    std::mt19937 random(29);
    for (int i = 0; i < 100; ++i) {
        const Rotation rotation(randomTurn(random, true));
        EXPECT_EQ(Rotation::fromQuaternions(rotation.leftQuaternion(), rotation.rightQuaternion()), rotation);
    }
}

TEST(Rotation, isRestoredOnlyIfItIsOrthogonal) {
    std::mt19937 random(30);
    int restored = 0;
    int refused = 0;
    for (double excess = 1e-12; excess < 1e-6; excess *= 1.5) {
        for (const double sign : {-1.0, 1.0}) {
            const Rotation rotation(randomTurn(random, true));
            const double factor = 1 + sign * excess;
            const auto found =
                Rotation::fromQuaternions(rotation.leftQuaternion() * factor, rotation.rightQuaternion() * factor);
            ++(found ? restored : refused);
            if (!found) continue;
            const glm::dmat4 m = found->matrix();
            EXPECT_LT(difference(glm::transpose(m) * m, glm::dmat4(1)), 1e-9) << "for an excess of " << excess;
        }
    }
    EXPECT_GT(restored, 0);
    EXPECT_GT(refused, 0);
}

TEST(Rotation, isNotRecoveredFromOtherMatrices) {
    glm::dmat4 reflection(1);
    reflection[0][0] = -1;
    glm::dmat4 skewed(1);
    skewed[1][0] = 0.01;
    glm::dmat4 broken(1);
    broken[2][2] = std::nan("");
    for (const auto& m : {reflection, skewed, broken, glm::dmat4(0), glm::dmat4(2)}) {
        EXPECT_FALSE(Rotation::fromMatrix(m));
    }
}

}  // namespace
