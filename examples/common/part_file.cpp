#include "part_file.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <iostream>
#include <system_error>
#include <utility>

#include "cambium/core/error.hpp"
#include "cambium/core/write_file.hpp"

namespace examples {
namespace {

/// A part file for the signal handler, which may only touch memory that was prepared before.
struct Pending {
  std::atomic<bool> is_used{false}, is_kept{false};
  char path[4096] = "", message[8400] = "";
};

std::array<Pending, 4> pending;

extern "C" void on_interruption(int signal) {
  for (auto& file : pending) {
    if (!file.is_used) continue;
    if (file.is_kept)
      static_cast<void>(!write(STDERR_FILENO, file.message, std::strlen(file.message)));
    else
      unlink(file.path);
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

std::string kept_message(std::filesystem::path const& path, std::filesystem::path const& part) {
  return "what was done is in " + part.string() + "; " + path.string() + " is unchanged\n";
}

std::size_t look_after(std::filesystem::path const& path, std::filesystem::path const& part) {
  std::size_t place = 0;
  while (place < pending.size() && pending[place].is_used) ++place;
  auto const message = "\n" + kept_message(path, part);
  if (place == pending.size() || part.string().size() >= sizeof pending[place].path ||
      message.size() >= sizeof pending[place].message)
    return pending.size();
  auto& file = pending[place];
  std::strcpy(file.path, part.c_str());
  std::strcpy(file.message, message.c_str());
  file.is_kept = false;
  file.is_used = true;
  for (int const signal : {SIGINT, SIGTERM, SIGHUP})
    if (std::signal(signal, on_interruption) == SIG_IGN) std::signal(signal, SIG_IGN);  // as under nohup
  return place;
}

}  // namespace

void prepare_folder(std::filesystem::path const& folder) {
  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  if (problem)
    throw cambium::Error(folder.string(), "this folder cannot be created (" + problem.message() + ")",
                         "choose another --out");
  auto const probe = folder / ".probe";
  try {
    cambium::write_file(probe, "a file");
  } catch (cambium::Error const&) {
    throw cambium::Error(folder.string(),
                         "nothing can be written into this folder (" + std::string(std::strerror(errno)) + ")",
                         "choose another --out");
  }
  std::filesystem::remove(probe, problem);
}

PartFile::PartFile(std::filesystem::path path, Unfinished fate)
    : path_(std::move(path)), fate_(fate), place_(pending.size()) {
  namespace fs = std::filesystem;
  std::error_code none;
  if (fs::is_directory(path_, none)) fail(EISDIR);
  is_special_ = fs::exists(path_, none) && !fs::is_regular_file(path_, none);  // such as /dev/stdout or a pipe
  auto const target = !is_special_ && fs::is_symlink(path_, none) ? fs::weakly_canonical(path_, none) : path_;
  if (is_special_) {
    part_ = target;
    file_ = std::fopen(part_.c_str(), "wb");
  }
  for (int i = 0; !is_special_ && file_ == nullptr; ++i) {
    part_ = target;
    part_ += ".part" + (i == 0 ? std::string() : std::to_string(i));
    file_ = std::fopen(part_.c_str(), "wbx");
    if (file_ == nullptr && errno != EEXIST) break;
  }
  if (file_ == nullptr) fail(errno);
  if (is_special_) return;
  path_ = target;
  place_ = look_after(path_, part_);
}

PartFile::~PartFile() {
  if (file_ == nullptr) return;
  std::fclose(file_);
  if (place_ < pending.size()) pending[place_].is_used = false;
  if (is_special_) return;
  if (is_kept())
    std::cerr << kept_message(path_, part_);
  else
    unlink(part_.c_str());
}

void PartFile::append(std::string_view text, std::string_view closing) {
  if (!is_special_ && !closing_.empty() && std::fseek(file_, -static_cast<long>(closing_.size()), SEEK_CUR) != 0)
    fail(errno);
  write(text);
  closing_ = closing;
  if (closing.empty()) return;
  if (!is_special_) write(closing);
  if (std::fflush(file_) != 0) fail(errno);  // so that the rows survive however the program ends
  if (place_ < pending.size()) pending[place_].is_kept = is_kept();
}

bool PartFile::is_kept() const { return fate_ == Unfinished::kept && !closing_.empty(); }

void PartFile::finish() {
  if (is_special_) write(closing_);
  bool const is_closed = std::fclose(std::exchange(file_, nullptr)) == 0;
  if (!is_closed || (!is_special_ && std::rename(part_.c_str(), path_.c_str()) != 0)) {
    int const reason = errno;
    if (is_kept() && !is_special_)
      std::cerr << kept_message(path_, part_);
    else if (!is_special_)
      unlink(part_.c_str());
    if (place_ < pending.size()) pending[place_].is_used = false;
    fail(reason);
  }
  if (place_ < pending.size()) pending[place_].is_used = false;
}

void PartFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail(errno);
}

void PartFile::fail(int reason) const {
  bool const is_full = reason == ENOSPC || reason == EFBIG;
  throw cambium::Error(path_.string(),
                       "cannot be written (" + std::error_code(reason, std::generic_category()).message() + ")",
                       is_full            ? "make room there, or write elsewhere"
                       : reason == EISDIR ? "name a file, not a folder"
                                          : "name a file in a folder that exists and that you may write to");
}

}  // namespace examples
