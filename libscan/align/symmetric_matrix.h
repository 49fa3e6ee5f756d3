// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Eigenvalues and single eigenvectors of symmetric 3 x 3 matrices in closed form, for many of them.
#pragma once

#include <Eigen/Core>

namespace scan {

// Ascending (Smith, CACM 4, 1961). Off by some roundings of the largest one, but of two that nearly
// coincide each by up to 1e-8 of it.
Eigen::Vector3d eigenvalues_of(const Eigen::Matrix3d& matrix);

// Unit eigenvector of an eigenvalue that is apart from the others; one of many if it is not.
Eigen::Vector3d eigenvector_of(const Eigen::Matrix3d& matrix, double eigenvalue);

// The sum of v v^T, each of the six different entries once.
class SymmetricSum {
 public:
  void add(const Eigen::Vector3d& v) {
    xx_ += v.x() * v.x(), xy_ += v.x() * v.y(), xz_ += v.x() * v.z();
    yy_ += v.y() * v.y(), yz_ += v.y() * v.z(), zz_ += v.z() * v.z();
  }
  Eigen::Matrix3d matrix() const {
    Eigen::Matrix3d m;
    m << xx_, xy_, xz_, xy_, yy_, yz_, xz_, yz_, zz_;
    return m;
  }

 private:
  double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0;
};

}  // namespace scan
