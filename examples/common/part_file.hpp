#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace examples {

/// Creates the folder and checks that files can be written there, before the work starts. Earlier results stay until
/// new ones replace them.
void prepare_folder(std::filesystem::path const& folder);

/// A file written piece by piece under a temporary name next to `path`. `finish` moves it to `path`; until then an
/// earlier file there stays unchanged. If `path` exists and is no regular file (a pipe, /dev/stdout), it is written
/// directly. If the program is interrupted (SIGINT, SIGTERM, SIGHUP), the part is removed; with `Unfinished::kept` it
/// stays once it has content, and a message says where it is. All functions throw `cambium::Error`.
class PartFile {
 public:
  enum class Unfinished { removed, kept };

  explicit PartFile(std::filesystem::path path, Unfinished fate = Unfinished::removed);
  ~PartFile();
  PartFile(PartFile const&) = delete;
  PartFile& operator=(PartFile const&) = delete;

  /// Adds `text`, then `closing`, such as a bracket that makes the file valid so far. The next call overwrites
  /// `closing`.
  void append(std::string_view text, std::string_view closing = {});

  /// Moves the file to its place.
  void finish();

 private:
  [[noreturn]] void fail(int reason) const;
  void write(std::string_view text);
  [[nodiscard]] bool is_kept() const;

  std::filesystem::path path_, part_;
  std::FILE* file_ = nullptr;
  std::string closing_;
  Unfinished fate_;
  bool is_special_ = false;
  std::size_t place_;  ///< index among the files known to the signal handler
};

}  // namespace examples
