// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/html.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "tools/console.h"
#include "tools/report/embedded.h"
#include "tools/version.h"

namespace scan {
namespace {

constexpr std::string_view style_name = "style.css";

const EmbeddedFile& asset_file(std::string_view name) {
  const auto& files = report_assets();
  const auto file = std::find_if(files.begin(), files.end(),
                                 [&](const EmbeddedFile& one) { return one.name == name; });
  if (file == files.end())
    throw Error(Trouble::computation, "report: " + std::string(name) + " is not built in");
  return *file;
}

// As policies name it (CSP Level 3, 2.3.1).
std::string hash_source(std::string_view name) {
  const std::string_view digits = asset_file(name).sha256;
  std::string bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
    bytes += static_cast<char>(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16));
  return "'sha256-" + base64(bytes) + "'";
}

std::string policy(const std::vector<std::string_view>& scripts) {
  std::string text =
      "default-src 'none'; base-uri 'none'; form-action 'none'; img-src data:; "
      "style-src " +
      hash_source(style_name);
  if (!scripts.empty()) text += "; script-src";
  for (const std::string_view script : scripts) text += " " + hash_source(script);
  return text;
}

}  // namespace

std::string page_head(const std::string& title, const std::vector<std::string_view>& scripts) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"" +
         policy(scripts) +
         "\"><meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
         "<meta name=\"color-scheme\" content=\"light dark\">"
         "<meta name=\"generator\" content=\"libscan " +
         version_text() + "\"><title>" + escaped(title) + "</title><style>" +
         std::string(asset(style_name)) + "</style></head><body>\n";
}

std::string_view asset(std::string_view name) {
  return asset_file(name).text;
}

std::string inline_script(std::string_view name) {
  return "<script>" + std::string(asset(name)) + "</script>\n";
}

std::string data_script(const std::string& id, const nlohmann::ordered_json& json) {
  std::string safe;  // "</script" and "<!--" would end or change the element
  for (const char c : json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace))
    safe += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return "<script type=\"application/json\" id=\"" + id + "\">" + safe + "</script>\n";
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '&')
      safe += "&amp;";
    else if (c == '"')
      safe += "&quot;";
    else if (c == '\'')
      safe += "&#39;";
    else
      safe += c;
  }
  return safe;
}

std::string base64(std::string_view bytes) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() / 3 * 4 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      return i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u;
    };
    const unsigned word = at(0) << 16 | at(1) << 8 | at(2);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string cell(const std::string& text, bool number) {
  return std::string(number ? "<td class=\"number\">" : "<td>") + escaped(text) + "</td>";
}

std::string page_value(double value, const std::string& unit) {
  std::string text = readable_value(value, unit);
  if (text.ends_with(" um")) text.replace(text.size() - 2, 2, "µm");
  if (text.ends_with(" deg")) text.replace(text.size() - 4, 4, "°");
  return text;
}

std::string exact(const nlohmann::ordered_json& value, const std::string& unit) {
  if (!value.is_number()) return "unknown";
  return "<data value=\"" + value.dump() + "\">" + escaped(page_value(value.get<double>(), unit)) +
         "</data>";
}

std::string signed_exact(const nlohmann::ordered_json& value, const std::string& unit) {
  return (value.is_number() && value.get<double>() > 0 ? "+" : "") + exact(value, unit);
}

std::string exact_cell(const nlohmann::ordered_json& value, const std::string& unit) {
  return "<td class=\"number\">" + exact(value, unit) + "</td>";
}

std::string raw_cell(const std::string& html, bool number) {
  return std::string(number ? "<td class=\"number\">" : "<td>") + html + "</td>";
}

std::string warning_tag(const std::string& words) {
  return "<span class=\"tag warn\">" + escaped(words) + "</span>";
}

std::string section(const std::string& id, const std::string& title, const std::string& content) {
  return "<section id=\"" + id + "\" aria-labelledby=\"" + id + "-title\"><h2 id=\"" + id +
         "-title\">" + escaped(title) + "</h2>\n" + content + "</section>\n";
}

std::string table(const std::string& caption, const std::vector<std::string>& headings,
                  const std::string& rows) {
  std::string head;
  for (const std::string& heading : headings) {
    const bool number = heading.starts_with('#');
    head += std::string("<th scope=\"col\"") + (number ? " class=\"number\">" : ">") +
            escaped(heading.substr(number ? 1 : 0)) + "</th>";
  }
  return "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"" + escaped(caption) +
         "\"><table><caption><span>" + escaped(caption) + "</span></caption><thead><tr>" + head +
         "</tr></thead><tbody>\n" + rows + "</tbody></table></div>\n";
}

std::string details(const std::string& title, const nlohmann::ordered_json& json) {
  return "<details><summary>" + escaped(title) + "</summary><pre>" +
         escaped(json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)) +
         "</pre></details>\n";
}

}  // namespace scan
