// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/html.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tools/report/embedded.h"

namespace scan {

// Assets of this test's own; their hashes are those of FIPS 180-2's examples.
const std::vector<EmbeddedFile>& report_assets() {
  static const std::vector<EmbeddedFile> files = {
      {"style.css", "abc", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"},
      {"viewer.js", "", "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"}};
  return files;
}

std::string version_text() {
  return "1.2.3";
}

namespace {

// RFC 4648, section 10.
TEST(Base64, OfTheStandardsExamples) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(Escaped, LeavesNothingThatHtmlReads) {
  EXPECT_EQ(escaped("<a href=\"x\" title='y'>&</a>"),
            "&lt;a href=&quot;x&quot; title=&#39;y&#39;&gt;&amp;&lt;/a&gt;");
}

TEST(DataScript, CannotBeEndedFromWithin) {
  const std::string html = data_script("id", {{"name", "</script><!-- <script>"}});
  EXPECT_EQ(html.find("</script"), html.rfind("</script"));
  EXPECT_EQ(html.find("<!--"), std::string::npos);
  const auto begin = html.find('>') + 1;
  const auto json = nlohmann::json::parse(html.substr(begin, html.rfind("</script") - begin));
  EXPECT_EQ(json.at("name"), "</script><!-- <script>");
}

TEST(Exact, KeepsEveryBitBesideTheReadableText) {
  const double value = 0.1 + 0.2;
  const std::string html = exact(value, "m");
  EXPECT_NE(html.find(">300 mm<"), std::string::npos);
  const auto begin = html.find('"') + 1;
  EXPECT_EQ(std::stod(html.substr(begin, html.find('"', begin) - begin)), value);
  EXPECT_EQ(exact(nullptr, "m"), "unknown");
}

// CSP Level 3, 2.3.1: base64 of the SHA-256.
TEST(PageHead, AllowsItsStyleAndScriptsByHashAndNothingElse) {
  const std::string html = page_head("t", {"viewer.js"});
  EXPECT_NE(html.find("content=\"default-src 'none'; base-uri 'none'; form-action 'none'; "
                      "img-src data:; style-src "
                      "'sha256-ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0='; script-src "
                      "'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU='\""),
            std::string::npos);
  EXPECT_EQ(page_head("t").find("script-src"), std::string::npos);
}

TEST(PageValue, ShowsSignsThatATerminalMayNot) {
  EXPECT_EQ(page_value(12.3e-6, "m"), "12.3 µm");
  EXPECT_EQ(page_value(0.5, "rad"), "28.6°");
  EXPECT_EQ(page_value(3, "count"), "3");
}

}  // namespace
}  // namespace scan
