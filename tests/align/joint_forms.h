// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Couples of scans for the joint step's tests: by chance, in a ring, in a row.
#pragma once

#include <vector>

#include "libscan/align/joint_refinement.h"
#include "libscan/core/random.h"

namespace scan::test {

inline Vector6 random_row(RandomStream& random) {
  Vector6 row;
  for (int i = 0; i < 6; ++i) row[i] = random.normal();
  return row;
}

inline JointForm random_form(std::size_t source, std::size_t target, RandomStream& random) {
  JointForm form{.source = source, .target = target, .pairs = 10};
  for (int k = 0; k < 10; ++k) {
    const Vector6 row = random_row(random);
    const double residual = random.normal();
    form.a += row * row.transpose();
    form.b -= row * residual;
  }
  form.apparent = form.a;
  return form;
}

inline JointFrame frame_of(std::size_t scans) {
  JointFrame frame{.centres = std::vector<Eigen::Vector3d>(scans, Eigen::Vector3d::Zero()),
                   .size_m = 1,
                   .free = std::vector<bool>(scans, true)};
  frame.free[0] = false;
  return frame;
}

struct Ring {
  std::vector<JointForm> forms;
  Eigen::MatrixXd a;  // dense normal equations of scans 1 to 3
  Eigen::VectorXd b;
};

inline Ring ring() {
  RandomStream random(1, 0, 0);
  Ring ring;
  for (std::size_t i = 0; i < 4; ++i) ring.forms.push_back(random_form(i, (i + 1) % 4, random));
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(24, 24);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(24);
  for (const JointForm& form : ring.forms) {
    Eigen::MatrixXd difference = Eigen::MatrixXd::Zero(6, 24);
    difference.middleCols<6>(6 * Eigen::Index(form.source)).setIdentity();
    difference.middleCols<6>(6 * Eigen::Index(form.target)) = -Matrix6::Identity();
    a += difference.transpose() * form.a * difference;
    b += difference.transpose() * form.b;
  }
  ring.a = a.bottomRightCorner<18, 18>();
  ring.b = b.tail<18>();
  return ring;
}

// A row of couples half way between scans one metre apart, each as well held as the others.
struct Row {
  std::vector<JointForm> forms;
  JointFrame frame;
};

inline Row row_of(std::size_t scans) {
  Row row{.forms = {}, .frame = frame_of(scans)};
  for (std::size_t i = 0; i < scans; ++i) row.frame.centres[i] = {double(i), 0, 0};
  for (std::size_t i = 1; i < scans; ++i) {
    JointForm form{.source = i, .target = i - 1, .pairs = 10};
    form.frame = {.centre = {double(i) - 0.5, 0, 0}, .size_m = 1};
    form.a = form.apparent = Matrix6::Identity();
    form.noise = 0.001 * Matrix6::Identity();  // of three planes, by chance up to 0.025
    row.forms.push_back(form);
  }
  return row;
}

}  // namespace scan::test
