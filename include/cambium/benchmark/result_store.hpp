#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "cambium/benchmark/run_result.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/version.hpp"

struct sqlite3;
struct sqlite3_stmt;

/// Results of benchmarks in one SQLite file.
///
///   runs       one row a call of the runner: run, started, command
///   sets       one row a scenario set: set_hash, title, scenarios, source (what names it on the command line)
///   behaviors  one row a behaviour with its parameters: behavior, parameters_hash, parameters, command (what runs
///              it, without the set)
///   results    one row a scenario and behaviour: the key (set_hash, scenario, behavior, parameters_hash, version), the
///              scenario's seed and population, the fields of `RunResult`, and the run that brought it
///   times      the same key, and the fields of `RunTimes`
///
/// Hashes are texts of 16 hexadecimal digits. Everything in `results` but `run` is the same however often, in whatever
/// order and on how many threads the scenarios are run.
namespace cambium::inline v0_1 {

/// Identifies a result.
struct ResultKey {
  std::uint64_t set_hash = 0;
  std::int64_t scenario = 0;  ///< number in the set, from 0
  std::string behavior;
  std::uint64_t parameters_hash = 0;
  std::string version = library_version;

  friend bool operator==(ResultKey const&, ResultKey const&) = default;
  friend auto operator<=>(ResultKey const&, ResultKey const&) = default;
};

/// A row of the database.
struct ResultRow {
  ResultKey key;
  std::uint64_t seed = 0;
  RunResult result;
  RunTimes times{};
  std::int64_t run = 0;      ///< the call of the runner that brought it; `ResultStore::add` sets the current one
  std::string population{};  ///< of the scenario, see `TrafficPopulation`
};

/// A database cannot be opened, read or written, or has tables of another program.
struct StoreError : Error {
  using Error::Error;
};

/// An open database of results. One object serves one thread; several processes may write to one file. Rows that were
/// added are in the file after `commit`, and at the latest when the store is closed: a process that is killed loses
/// only what came after the last `commit`; a power failure may cost more.
class ResultStore {
 public:
  /// Opens or creates the file. Throws `StoreError` if that is impossible, or if the file has tables of another
  /// program; then it stays as it is.
  explicit ResultStore(std::filesystem::path const& file) : ResultStore(file, nullptr) {}

  /// A copy in memory of an existing database. The file stays as it is; rows added to the copy are lost. Throws
  /// `StoreError` if the file is missing or no database of results. O(size of the file).
  [[nodiscard]] static ResultStore existing(std::filesystem::path const& file);
  ResultStore(ResultStore&&) = default;
  ResultStore& operator=(ResultStore&&) = delete;
  ~ResultStore();

  [[nodiscard]] std::string const& file() const { return file_; }

  /// Records a call of the runner; rows added from now on belong to it. `started`: a text, as "2026-11-24 17:00".
  void begin_run(std::string const& started, std::string const& command);
  /// `source`: what names the set on the command line, "--set merging --seed 3"; empty: keeps the known one.
  void add_set(std::uint64_t hash, std::string const& title, std::size_t scenarios, std::string const& source = {});
  /// `command`: what runs it, without the set, "examples/run benchmark --parameters FILE"; empty: keeps the known one.
  void add_behavior(std::string const& name, std::uint64_t hash, std::string const& parameters,
                    std::string const& command = {});

  /// Whether there is a result of that key. An error for which the machine may be to blame (`RunErrorKind`) does not
  /// count. Throws `StoreError` if the file cannot be read.
  [[nodiscard]] bool has(ResultKey const& key);

  /// Adds a row, in place of an earlier one of that key. Throws `StoreError`, for example if the disk is full.
  void add(ResultRow const& row);

  /// Writes all rows added so far to the file.
  void commit();

  /// Calls `f(ResultRow)` for each result, by set, behaviour, parameters, version and scenario.
  void for_each(std::function<void(ResultRow const&)> const& f);

  /// The parameters of a behaviour as text; empty if they are unknown.
  [[nodiscard]] std::string parameters_of(std::string const& name, std::uint64_t hash);
  /// What runs it on the command line, without the set; empty if that is unknown.
  [[nodiscard]] std::string command_of(std::string const& name, std::uint64_t hash);
  /// The title of a set; its hash if it has none.
  [[nodiscard]] std::string title_of(std::uint64_t set_hash);
  /// What names a set on the command line; empty if that is unknown.
  [[nodiscard]] std::string source_of(std::uint64_t set_hash);

  /// Adds all rows of another database, or none if that fails, as after runs with `--shard`. Rows of one key are taken
  /// from `other`, unless only that one has an error for which its machine may be to blame (see `has`). Throws
  /// `StoreError`.
  void merge(ResultStore& other);

 private:
  struct Close {
    void operator()(sqlite3* db) const;
  };
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  using Database = std::unique_ptr<sqlite3, Close>;
  using Statement = std::unique_ptr<sqlite3_stmt, Finalize>;

  /// `db`: the database, null for that in the file.
  ResultStore(std::filesystem::path const& file, Database db);

  [[nodiscard]] static Database open(std::string const& name, int flags);

  [[noreturn]] void fail(std::string const& what, std::string const& remedy) const;
  void execute(std::string const& sql);
  /// A statement with these values for its marks.
  template <class... Values>
  [[nodiscard]] Statement prepare(std::string const& sql, Values const&... values);
  /// Advances a query to its next row; whether there is one.
  [[nodiscard]] bool has_row(sqlite3_stmt* query);
  /// The text in a query's first row; empty without one.
  template <class... Values>
  [[nodiscard]] std::string find_text(std::string const& sql, Values const&... values);
  /// Adds the column if the database lacks it; whether it did.
  bool add_missing_column(std::string const& table, std::string const& column);
  /// Adds all columns that a database of an older version lacks.
  void add_missing_columns();
  void step(sqlite3_stmt* statement);

  std::string file_;
  Database db_;
  Statement add_result_, add_times_, has_;
  std::int64_t run_ = 0;
  bool in_transaction_ = false;
};

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/benchmark/result_store_impl.hpp"
#endif
