#include "geometry/reference_frame.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

namespace oval4d::geometry {
namespace {

constexpr int kFrames = 200;

glm::dvec3 randomVelocity(std::mt19937& random, double most) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> speed(0, most);
    return speed(random) * glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

ReferenceFrame randomFrame(std::mt19937& random) {
    std::uniform_real_distribution<double> exponent(-1, 1);
    return {std::pow(10, exponent(random)), randomVelocity(random, 3), randomVelocity(random, 0.95)};
}

void expectSame(const glm::dmat4& a, const glm::dmat4& b, double tolerance) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) EXPECT_NEAR(a[column][row], b[column][row], tolerance);
    }
}

/// Returns the squared spacetime interval w² − x² − y² − z² between the origin and an event.
double interval(const glm::dvec4& event) { return event.w * event.w - glm::dot(glm::dvec3(event), glm::dvec3(event)); }

TEST(ReferenceFrame, TheDefaultIsTheIdentity) {
    EXPECT_EQ(ReferenceFrame{}.matrix(), glm::dmat4(1));
    EXPECT_EQ(ReferenceFrame{}.inverse(), glm::dmat4(1));
    EXPECT_EQ(lorentzBoost(glm::dvec3(0)), glm::dmat4(1));
}

TEST(ReferenceFrame, TheBoostAlongOneAxisIsThatOfTextbooks) {
    const glm::dmat4 boost = lorentzBoost({0.6, 0, 0});  // γ = 1.25
    const glm::dvec4 image = boost * glm::dvec4(2, 3, 4, 5);
    EXPECT_NEAR(image.x, 1.25 * (2 - 0.6 * 5), 1e-14);
    EXPECT_NEAR(image.y, 3, 1e-14);
    EXPECT_NEAR(image.z, 4, 1e-14);
    EXPECT_NEAR(image.w, 1.25 * (5 - 0.6 * 2), 1e-14);
}

TEST(ReferenceFrame, BoostsPreserveIntervalsAndVolumes) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (int i = 0; i < kFrames; ++i) {
        const glm::dvec3 velocity = randomVelocity(random, 0.999);
        const glm::dmat4 boost = lorentzBoost(velocity);
        const glm::dvec4 event(normal(random), normal(random), normal(random), normal(random));
        const double scale = glm::dot(boost * event, boost * event) + 1;
        EXPECT_NEAR(interval(boost * event), interval(event), 1e-12 * scale);
        EXPECT_NEAR(glm::determinant(boost), 1, 1e-9);
        // In the frame of a moving observer, the observer is at rest, and light still has the speed 1.
        const glm::dvec4 observer = boost * glm::dvec4(velocity, 1);
        EXPECT_LT(glm::length(glm::dvec3(observer)), 1e-12);
        const glm::dvec3 ray = randomVelocity(random, 1);
        const glm::dvec4 light = boost * glm::dvec4(glm::normalize(ray), 1);
        EXPECT_NEAR(glm::length(glm::dvec3(light)) / light.w, 1, 1e-11);
    }
}

TEST(ReferenceFrame, ABoostAndItsInverseAreTheIdentity) {
    std::mt19937 random(2);
    for (int i = 0; i < kFrames; ++i) {
        const glm::dvec3 velocity = randomVelocity(random, 0.9);
        expectSame(lorentzBoost(-velocity) * lorentzBoost(velocity), glm::dmat4(1), 1e-12);
    }
}

TEST(ReferenceFrame, BoostsAlongOneAxisAddTheirRapidities) {
    for (const double a : {-0.7, 0.2, 0.5}) {
        for (const double b : {-0.4, 0.3, 0.8}) {
            const glm::dmat4 both = lorentzBoost({0, std::tanh(a), 0}) * lorentzBoost({0, std::tanh(b), 0});
            expectSame(both, lorentzBoost({0, std::tanh(a + b), 0}), 1e-12);
        }
    }
}

TEST(ReferenceFrame, WhatIsFollowedStandsStillAtEveryPace) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int i = 0; i < kFrames; ++i) {
        ReferenceFrame frame = randomFrame(random);
        frame.boost = glm::dvec3(0);
        const glm::dvec3 start(normal(random), normal(random), normal(random));
        for (const double time : {-2.0, 0.5, 3.0}) {
            const glm::dvec4 image = frame.matrix() * glm::dvec4(start + time * frame.follow, time);
            EXPECT_LT(glm::distance(glm::dvec3(image), start), 1e-12);
            EXPECT_NEAR(image.w, frame.pace * time, 1e-12);
        }
    }
}

TEST(ReferenceFrame, MatrixAndInverseAreInverse) {
    std::mt19937 random(4);
    for (int i = 0; i < kFrames; ++i) {
        const ReferenceFrame frame = randomFrame(random);
        expectSame(frame.matrix() * frame.inverse(), glm::dmat4(1), 1e-10);
        expectSame(frame.inverse() * frame.matrix(), glm::dmat4(1), 1e-10);
        EXPECT_NEAR(glm::determinant(frame.matrix()) / frame.pace, 1, 1e-11);
    }
}

TEST(ReferenceFrame, PointsAreMappedAndMeasured) {
    const ReferenceFrame frame{2, {1, 0, 0}, {}};
    std::vector<glm::dvec4> points{{1, 0, 0, 1}, {0, 3, 0, -2}};
    const double radius = mapPoints(frame.matrix(), points);
    EXPECT_EQ(points, (std::vector<glm::dvec4>{{0, 0, 0, 2}, {2, 3, 0, -4}}));
    EXPECT_DOUBLE_EQ(radius, std::sqrt(29.0));
}

}  // namespace
}  // namespace oval4d::geometry
