// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/stated_poses_file.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"
#include "tests/io/io_test_support.h"

namespace scan {
namespace {

const std::string matrix =
    "[[1,0,0,0,0,2],[0,1,0,0,0,0],[0,0,1,0,0,0],[0,0,0,1,0,0],[0,0,0,0,1,0],[3,0,0,0,0,1]]";

StatedPoses read_couple(const std::string& scans) {
  const TemporaryFolder folder;
  const std::string known =
      R"({"covariance": )" + matrix + R"(, "covariance_centre_m": [1, 2, 3]})";
  write_file(folder / "a.json", R"({"scans": [)" + known + R"(, {"covariance": null}],
      "covariances_between": [{"scans": )" +
                                    scans + R"(, "covariance": )" + matrix + "}]}");
  return read_stated_poses(folder / "a.json");
}

TEST(StatedPosesFile, IsReadRowByRow) {
  const StatedPoses stated = read_couple("[0, 1]");
  ASSERT_EQ(stated.scans.size(), 2u);
  ASSERT_TRUE(stated.scans[0]);
  EXPECT_FALSE(stated.scans[1]);
  EXPECT_EQ(stated.scans[0]->covariance(0, 5), 2);
  EXPECT_EQ(stated.scans[0]->covariance(5, 0), 3);
  EXPECT_EQ(stated.scans[0]->centre, Eigen::Vector3d(1, 2, 3));
  ASSERT_EQ(stated.between.size(), 1u);
  EXPECT_EQ(stated.between[0].first, 0u);
  EXPECT_EQ(stated.between[0].second, 1u);
  EXPECT_EQ(stated.between[0].covariance(0, 5), 2);
}

TEST(StatedPosesFile, NamesCouplesOfScansThatAreNotThere) {
  for (const char* scans : {"[0, 2]", "[-1, 1]", "[1, 0]", "[1, 1]"}) try {
      read_couple(scans);
      ADD_FAILURE() << scans;
    } catch (const Error& error) {
      EXPECT_EQ(error.trouble(), Trouble::input);
      const std::string message = error.what();
      EXPECT_NE(message.find("a.json: covariances_between: "), std::string::npos) << message;
    }
}

}  // namespace
}  // namespace scan
