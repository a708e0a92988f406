#pragma once

#include <stdlib.h>  // mkdtemp, not in <cstdlib>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <unistd.h>

#include "../support/skipped.hpp"
#include "../support/text.hpp"

/// Looks at HTML files through a headless Chromium, for tests.
namespace browser {

/// A Chromium of this machine; without one nothing, and the test counts as skipped.
inline std::optional<std::filesystem::path> find() {
  char const* path = std::getenv("PATH");
  for (auto const& folder : support::split(path == nullptr ? "" : path, ':'))
    for (char const* name : {"chromium", "chromium-browser", "google-chrome"})
      if (std::filesystem::path const file = std::filesystem::path(folder) / name; ::access(file.c_str(), X_OK) == 0)
        return file;
  support::skip("no browser: install chromium");
  return std::nullopt;
}

/// A folder that is removed with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "cambium-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder " + name);
    path_ = name;
  }
  TemporaryFolder(TemporaryFolder const&) = delete;
  TemporaryFolder& operator=(TemporaryFolder const&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  [[nodiscard]] std::filesystem::path const& path() const { return path_; }
  [[nodiscard]] std::string file(std::string const& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

inline std::string quoted(std::string const& text) {
  std::string out = "'";
  for (char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// `file://` address of a file, with what an address cannot hold encoded.
inline std::string address_of(std::filesystem::path const& file, std::string const& hash) {
  std::string out = "file://";
  for (char c : std::filesystem::absolute(file).string()) {
    char code[4] = {c, 0, 0, 0};
    if (std::string_view(" %#?&'\"").find(c) != std::string_view::npos)
      std::snprintf(code, sizeof code, "%%%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
    out += code;
  }
  return hash.empty() ? out : out + '#' + hash;
}

/// The flag with which pages see that their reader prefers dark colours; without it, light ones.
inline constexpr char const* dark = "--blink-settings=preferredColorScheme=0";

/// The page with what its reader does: `script` runs after the page's own. It has `point`, `wheel` and `key` to
/// act on the element `target`, and `say(name, values...)` to leave words in the body's attribute data-name;
/// data-failure says what it threw.
inline std::string with_actions(std::string const& page, std::string const& target, std::string const& script) {
  return page + "<script>(() => {\nconst target = document.getElementById('" + target + R"js(');
Element.prototype.setPointerCapture = () => {};   // no real pointer is down
const say = (name, ...values) => { document.body.dataset[name] = values.join(' '); };
const point = (type, pointerId, clientX, clientY) => target.dispatchEvent(new PointerEvent('pointer' + type,
    {pointerId, clientX, clientY, pointerType: 'touch', bubbles: true, button: type === 'move' ? -1 : 0}));
const wheel = (deltaY, clientX, clientY) =>
    target.dispatchEvent(new WheelEvent('wheel', {deltaY, clientX, clientY, bubbles: true, cancelable: true}));
const key = (key, at = document.body) =>
    at.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true, cancelable: true}));
try {
)js" + script +
         "\n} catch (error) { say('failure', error.message); }\n})();</script>\n";
}

/// The page's document, as markup, `milliseconds` of the page's own time after it was opened. Empty when the browser
/// did not answer within a minute. `flags` are further ones of the browser, such as `dark` or another window size.
inline std::string document(std::filesystem::path const& chromium, std::filesystem::path const& file,
                            std::string const& hash = {}, int milliseconds = 1000, std::string const& flags = {}) {
  TemporaryFolder const profile;
  std::string const command =
      "timeout 60 " + quoted(chromium.string()) +
      " --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking"
      " --disable-component-update --disable-sync --window-size=1200,800 --user-data-dir=" +
      quoted(profile.path().string()) + " --virtual-time-budget=" + std::to_string(milliseconds) + " --dump-dom " +
      flags + ' ' + quoted(address_of(file, hash)) + " 2>/dev/null";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return {};
  std::string text;
  char buffer[4096];
  for (std::size_t read = 0; (read = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, read);
  ::pclose(pipe);
  return text;
}

/// Value of an attribute within the first tag that starts with `tag` ("<body"); empty where there is none.
inline std::string attribute(std::string const& document, std::string const& tag, std::string const& name) {
  std::size_t const start = document.find(tag), end = document.find('>', start);
  if (start == std::string::npos || end == std::string::npos) return {};
  std::string const text = document.substr(start, end - start), key = ' ' + name + "=\"";
  std::size_t const at = text.find(key);
  if (at == std::string::npos) return {};
  return text.substr(at + key.size(), text.find('"', at + key.size()) - at - key.size());
}

/// The colours that a replay shows, as "r,g,b", where its address asks: `#probe=x,y;x,y`.
inline std::vector<std::string> pixels(std::filesystem::path const& chromium, std::filesystem::path const& file,
                                       std::string const& hash, std::string const& flags = {}) {
  return support::split(attribute(document(chromium, file, hash, 1000, flags), "<body", "data-pixel"), ';');
}

}  // namespace browser
