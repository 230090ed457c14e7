// Opens a page of `deflect … --report` in Chromium without a window, uses it (page_check.js) and says what happened.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "tests/support/paths.h"
#include "tests/support/program.h"

namespace deflect::test {

/// The data that stand in the page.
inline nlohmann::json page_data(const std::string& html) {
  const std::string mark = "id=\"data\">";
  const std::size_t from = html.find(mark) + mark.size();
  return nlohmann::json::parse(html.substr(from, html.find("</script>", from) - from));
}

inline std::string browser() {
  for (const char* name : {"chromium-headless-shell", "chromium", "google-chrome"})
    if (std::system(("command -v " + std::string(name) + " >/dev/null").c_str()) == 0) return name;
  return "";
}

inline std::string from_base64(const std::string& text) {
  std::string out;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    const std::size_t value =
        std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/").find(c);
    if (value == std::string_view::npos) break;
    bits = bits << 6 | static_cast<unsigned>(value);
    if ((count += 6) >= 8) out += static_cast<char>(bits >> (count -= 8) & 0xff);
  }
  return out;
}

/// What page_check.js writes down; empty where the browser said nothing. Without `webgl` it cannot draw in 3D.
inline std::optional<nlohmann::json> used_page(const std::filesystem::path& page, const Folder& folder,
                                               const std::string& window = "1200,900", bool dark = false,
                                               bool webgl = true) {
  std::string html = contents(page);
  html.insert(html.find("<title>"),
              "<script>" + contents(test::source_dir() + "/tests/support/page_check.js") + "</script>");
  std::ofstream(folder / "checked.html", std::ios::binary) << html;
  const std::string command =
      browser() + " --headless --no-sandbox" +
      (webgl ? " --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader"
             : " --disable-gpu --disable-3d-apis --disable-software-rasterizer") +
      " --disable-dev-shm-usage --user-data-dir='" + (folder / "browser").string() + "' --window-size=" + window +
      " --blink-settings=preferredColorScheme=" + (dark ? "0" : "1") +
      " --virtual-time-budget=60000 --dump-dom 'file://" + (folder / "checked.html").string() + "' 2>/dev/null";
  std::string out;
  FILE* pipe = ::popen(command.c_str(), "r");
  std::array<char, 4096> buffer;
  for (std::size_t n; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) out.append(buffer.data(), n);
  ::pclose(pipe);
  const std::size_t from = out.find("id=\"checked\">@@");
  if (from == out.npos) return std::nullopt;
  return nlohmann::json::parse(from_base64(out.substr(from + 15)));
}

}  // namespace deflect::test
