#include "geometry/reference_frame.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace oval4d::geometry {

namespace {

glm::dmat4 timeScalingMatrix(double factor) {
    glm::dmat4 matrix(1);
    matrix[3][3] = factor;
    return matrix;
}

}  // namespace

glm::dmat4 galileanTransformation(const glm::dvec3& velocity) {
    glm::dmat4 matrix(1);
    matrix[3] = glm::dvec4(-velocity, 1);
    return matrix;
}

glm::dmat4 lorentzBoost(const glm::dvec3& velocity) {
    const double gamma = 1 / std::sqrt(1 - glm::dot(velocity, velocity));
    const double along = gamma * gamma / (gamma + 1);  // equals (γ − 1) / v², which is 0 / 0 for v = 0
    glm::dmat4 matrix(1);
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) matrix[j][i] += along * velocity[i] * velocity[j];
        matrix[3][i] = matrix[i][3] = -gamma * velocity[i];
    }
    matrix[3][3] = gamma;
    return matrix;
}

glm::dmat4 ReferenceFrame::matrix() const {
    return lorentzBoost(boost) * timeScalingMatrix(pace) * galileanTransformation(follow);
}

glm::dmat4 ReferenceFrame::inverse() const {
    return galileanTransformation(-follow) * timeScalingMatrix(1 / pace) * lorentzBoost(-boost);
}

double mapPoints(const glm::dmat4& map, std::vector<glm::dvec4>& points) {
    double circumradius = 0;
    for (glm::dvec4& point : points) {
        point = map * point;
        circumradius = std::max(circumradius, glm::length(point));
    }
    return circumradius;
}

}  // namespace oval4d::geometry
