#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace examples {

/// Makes the folder and finds out now, not after the work, whether it takes files. Older results stay until there are
/// new ones.
void prepare_folder(std::filesystem::path const& folder);

/// A file that grows while a program works, beside `path`, whose place it takes once it is whole: until then an earlier
/// file stays as it is. Straight into what is no regular file. Whoever interrupts the program (SIGINT, SIGTERM, SIGHUP)
/// loses the part, unless it is to be kept and has something in it: then a message says where it is. All throw
/// `cambium::Error`.
class PartFile {
 public:
  enum class Unfinished { removed, kept };

  explicit PartFile(std::filesystem::path path, Unfinished fate = Unfinished::removed);
  ~PartFile();
  PartFile(PartFile const&) = delete;
  PartFile& operator=(PartFile const&) = delete;

  /// Adds `text`. `closing` ends the file for now, as a bracket does: what is added next replaces it.
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
  std::size_t place_;  ///< among those that an interruption looks after
};

}  // namespace examples
