#pragma once

#include <sqlite3.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "cambium/benchmark/result_store.hpp"
#include "cambium/benchmark/run_result.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/text.hpp"
#include "cambium/core/type_info.hpp"

namespace cambium::inline v0_1 {

/// Helpers around SQLite.
namespace detail::sql {

inline constexpr char const* key_columns = "set_hash, scenario, behavior, parameters_hash, version, ";

/// URI that opens the file as immutable, for read-only folders.
[[nodiscard]] inline std::string immutable(std::string const& file) {
  std::string uri = "file:";
  for (char const c : file)
    if (c == '?' || c == '#' || c == '%')
      uri += c == '?' ? "%3f" : c == '#' ? "%23" : "%25";
    else
      uri += c;
  return uri + "?immutable=1";
}

/// Whether the database has our tables.
[[nodiscard]] inline bool is_ours(sqlite3* db) {
  sqlite3_stmt* query = nullptr;
  bool const is_ours = sqlite3_prepare_v2(db, "SELECT 1 FROM runs, sets, behaviors, results, times LIMIT 0", -1, &query,
                                          nullptr) == SQLITE_OK;
  sqlite3_finalize(query);
  return is_ours;
}

inline void bind_value(sqlite3_stmt* s, int at, std::string const& value) {
  sqlite3_bind_text(s, at, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
}

inline void bind_value(sqlite3_stmt* s, int at, std::int64_t value) { sqlite3_bind_int64(s, at, value); }

/// Binds the values from place `at` on; returns the next place.
template <class... Values>
int bind_values([[maybe_unused]] sqlite3_stmt* s, int at, Values const&... values) {
  (bind_value(s, at++, values), ...);
  return at;
}

inline int bind_key(sqlite3_stmt* s, ResultKey const& key) {
  return bind_values(s, 1, hash_text(key.set_hash), key.scenario, key.behavior, hash_text(key.parameters_hash),
                     key.version);
}

[[nodiscard]] inline std::string text(sqlite3_stmt* s, int at) {
  auto const* const bytes = reinterpret_cast<char const*>(sqlite3_column_text(s, at));
  return bytes != nullptr ? bytes : "";
}

[[nodiscard]] inline std::uint64_t hash_of(std::string const& text) { return std::strtoull(text.c_str(), nullptr, 16); }

/// "?, ?, ?".
[[nodiscard]] inline std::string marks(std::size_t number) {
  std::string text;
  for (std::size_t i = 0; i < number; ++i) text += i == 0 ? "?" : ", ?";
  return text;
}

/// "least_gap REAL".
[[nodiscard]] inline std::string column_of(FieldInfo const& field) {
  auto const& held = field.type();
  return std::string(field.name) + (held.kind == TypeInfo::Kind::text ? " TEXT"
                                    : held.is_real()                  ? " REAL"
                                                                      : " INTEGER");
}

/// The columns of a struct, one a field.
[[nodiscard]] inline std::string columns(TypeInfo const& type, bool with_types) {
  std::string text;
  for (auto const& field : type.fields())
    text += (text.empty() ? "" : ", ") + (with_types ? column_of(field) : std::string(field.name));
  return text;
}

inline void bind_fields(sqlite3_stmt* s, int& at, TypeInfo const& type, void const* object) {
  for (auto const& field : type.fields()) {
    auto const& held = field.type();
    auto const* const place = field.in(object);
    if (held.kind == TypeInfo::Kind::text)
      bind_value(s, at, *static_cast<std::string const*>(place));
    else if (auto const value = PlainValue::at(place, held); held.is_real())
      sqlite3_bind_double(s, at, value.number);
    else if (value.is_id() && value.bits == PlainValue::highest(held).bits)
      sqlite3_bind_null(s, at);
    else
      bind_value(s, at, static_cast<std::int64_t>(value.bits));
    ++at;
  }
}

/// Reads a struct's fields. Where a row has no value, the field keeps its own.
inline void read_fields(sqlite3_stmt* s, int& at, TypeInfo const& type, void* object) {
  for (auto const& field : type.fields()) {
    int const column = at++;
    if (sqlite3_column_type(s, column) == SQLITE_NULL) continue;
    auto const& held = field.type();
    if (held.kind == TypeInfo::Kind::text) {
      *static_cast<std::string*>(field.in(object)) = text(s, column);
      continue;
    }
    auto value = PlainValue::highest(held);
    value.number = sqlite3_column_double(s, column);
    value.bits = static_cast<std::uint64_t>(sqlite3_column_int64(s, column));
    value.store(field.in(object), held);
  }
}

}  // namespace detail::sql

CAMBIUM_COLD void ResultStore::Close::operator()(sqlite3* db) const { sqlite3_close_v2(db); }
CAMBIUM_COLD void ResultStore::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

CAMBIUM_COLD ResultStore ResultStore::existing(std::filesystem::path const& file) {
  auto db = open(file.string(), SQLITE_OPEN_READONLY);
  bool const may_be_read = detail::sql::is_ours(db.get());
  int const code = sqlite3_errcode(db.get());
  std::error_code unreachable;  // then SQLite says so
  if (!may_be_read && (code == SQLITE_CANTOPEN || code == SQLITE_READONLY) &&
      !std::filesystem::exists(file.string() + "-wal", unreachable))
    db = open(detail::sql::immutable(file.string()),
              SQLITE_OPEN_READONLY | SQLITE_OPEN_URI);  // in a folder that may only be read
  if (!detail::sql::is_ours(db.get()))
    throw StoreError(file.string(), "is no database of results (" + std::string(sqlite3_errmsg(db.get())) + ")",
                     "name one that a benchmark has written");
  auto copy = open(":memory:", SQLITE_OPEN_READWRITE);
  auto* const backup = sqlite3_backup_init(copy.get(), "main", db.get(), "main");
  bool const is_whole = backup != nullptr && sqlite3_backup_step(backup, -1) == SQLITE_DONE;
  if (backup != nullptr) sqlite3_backup_finish(backup);
  if (!is_whole) throw StoreError(file.string(), "cannot be read", "it may be damaged or locked: try again");
  return ResultStore(file, std::move(copy));
}

CAMBIUM_COLD ResultStore::~ResultStore() {
  if (db_ && in_transaction_) sqlite3_exec(db_.get(), "COMMIT", nullptr, nullptr, nullptr);
}

CAMBIUM_COLD void ResultStore::begin_run(std::string const& started, std::string const& command) {
  step(prepare("INSERT INTO runs(started, command) VALUES(?, ?)", started, command).get());
  run_ = sqlite3_last_insert_rowid(db_.get());
}

CAMBIUM_COLD void ResultStore::add_set(std::uint64_t hash, std::string const& title, std::size_t scenarios,
                                       std::string const& source) {
  step(prepare("INSERT OR REPLACE INTO sets(set_hash, title, scenarios, source) VALUES(?, ?, ?, ?)", hash_text(hash),
               title, static_cast<std::int64_t>(scenarios), source.empty() ? source_of(hash) : source)
           .get());
}

CAMBIUM_COLD void ResultStore::add_behavior(std::string const& name, std::uint64_t hash, std::string const& parameters,
                                            std::string const& command) {
  step(prepare("INSERT OR REPLACE INTO behaviors(behavior, parameters_hash, parameters, command) VALUES(?, ?, ?, ?)",
               name, hash_text(hash), parameters, command.empty() ? command_of(name, hash) : command)
           .get());
}

CAMBIUM_COLD bool ResultStore::has(ResultKey const& key) {
  detail::sql::bind_key(has_.get(), key);
  bool const found = has_row(has_.get()) && sqlite3_column_int(has_.get(), 0) == static_cast<int>(RunErrorKind::run);
  sqlite3_reset(has_.get());
  return found;
}

CAMBIUM_COLD void ResultStore::add(ResultRow const& row) {
  if (!in_transaction_) execute("BEGIN");
  in_transaction_ = true;
  int at = detail::sql::bind_key(add_result_.get(), row.key);
  at = detail::sql::bind_values(add_result_.get(), at, std::to_string(row.seed), run_, row.population);
  detail::sql::bind_fields(add_result_.get(), at, type_info<RunResult>(), &row.result);
  step(add_result_.get());
  at = detail::sql::bind_key(add_times_.get(), row.key);
  detail::sql::bind_fields(add_times_.get(), at, type_info<RunTimes>(), &row.times);
  step(add_times_.get());
}

CAMBIUM_COLD void ResultStore::commit() {
  if (in_transaction_) execute("COMMIT");
  in_transaction_ = false;
}

CAMBIUM_COLD void ResultStore::for_each(std::function<void(ResultRow const&)> const& f) {
  auto statement = prepare(
      "SELECT " + std::string(detail::sql::key_columns) + "seed, run, population, " +
      detail::sql::columns(type_info<RunResult>(), false) + ", " + detail::sql::columns(type_info<RunTimes>(), false) +
      " FROM results LEFT JOIN times USING(set_hash, scenario, behavior, parameters_hash, version) ORDER BY "
      "set_hash, behavior, parameters_hash, version, scenario");
  while (has_row(statement.get())) {
    ResultRow row;
    row.key = {detail::sql::hash_of(detail::sql::text(statement.get(), 0)), sqlite3_column_int64(statement.get(), 1),
               detail::sql::text(statement.get(), 2), detail::sql::hash_of(detail::sql::text(statement.get(), 3)),
               detail::sql::text(statement.get(), 4)};
    row.seed = std::strtoull(detail::sql::text(statement.get(), 5).c_str(), nullptr, 10);
    row.run = sqlite3_column_int64(statement.get(), 6);
    row.population = detail::sql::text(statement.get(), 7);
    int at = 8;
    detail::sql::read_fields(statement.get(), at, type_info<RunResult>(), &row.result);
    detail::sql::read_fields(statement.get(), at, type_info<RunTimes>(), &row.times);
    f(row);
  }
}

CAMBIUM_COLD std::string ResultStore::parameters_of(std::string const& name, std::uint64_t hash) {
  return find_text("SELECT parameters FROM behaviors WHERE behavior=? AND parameters_hash=?", name, hash_text(hash));
}

CAMBIUM_COLD std::string ResultStore::command_of(std::string const& name, std::uint64_t hash) {
  return find_text("SELECT command FROM behaviors WHERE behavior=? AND parameters_hash=?", name, hash_text(hash));
}

CAMBIUM_COLD std::string ResultStore::title_of(std::uint64_t set_hash) {
  auto const title = find_text("SELECT title FROM sets WHERE set_hash=?", hash_text(set_hash));
  return title.empty() ? hash_text(set_hash) : title;
}

CAMBIUM_COLD std::string ResultStore::source_of(std::uint64_t set_hash) {
  return find_text("SELECT source FROM sets WHERE set_hash=?", hash_text(set_hash));
}

CAMBIUM_COLD void ResultStore::merge(ResultStore& other) {
  commit();
  execute("BEGIN IMMEDIATE");
  auto const own_run = run_;
  try {
    auto last_run = prepare("SELECT COALESCE(MAX(run), 0) FROM runs");
    auto const offset = has_row(last_run.get()) ? sqlite3_column_int64(last_run.get(), 0) : 0;
    auto runs = other.prepare("SELECT run, started, command FROM runs");
    while (other.has_row(runs.get()))
      step(prepare("INSERT INTO runs(run, started, command) VALUES(?, ?, ?)",
                   std::int64_t{offset + sqlite3_column_int64(runs.get(), 0)}, detail::sql::text(runs.get(), 1),
                   detail::sql::text(runs.get(), 2))
               .get());
    auto sets = other.prepare("SELECT set_hash, title, scenarios, source FROM sets");
    while (other.has_row(sets.get()))
      add_set(detail::sql::hash_of(detail::sql::text(sets.get(), 0)), detail::sql::text(sets.get(), 1),
              static_cast<std::size_t>(sqlite3_column_int64(sets.get(), 2)), detail::sql::text(sets.get(), 3));
    auto behaviors = other.prepare("SELECT behavior, parameters_hash, parameters, command FROM behaviors");
    while (other.has_row(behaviors.get()))
      add_behavior(detail::sql::text(behaviors.get(), 0), detail::sql::hash_of(detail::sql::text(behaviors.get(), 1)),
                   detail::sql::text(behaviors.get(), 2), detail::sql::text(behaviors.get(), 3));
    in_transaction_ = true;  // `add` begins none
    other.for_each([&](ResultRow const& row) {
      if (row.result.error_kind != RunErrorKind::run && has(row.key)) return;
      run_ = row.run > 0 ? offset + row.run : 0;
      add(row);
    });
    run_ = own_run;
    commit();
  } catch (...) {
    run_ = own_run;
    in_transaction_ = false;
    sqlite3_exec(db_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
    throw;
  }
}

CAMBIUM_COLD ResultStore::ResultStore(std::filesystem::path const& file, Database db)
    : file_(file.string()), db_(std::move(db)) {
  if (!db_) db_ = open(file_, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  if (sqlite3_errcode(db_.get()) != SQLITE_OK)
    fail("cannot be opened", "name a file in a folder that exists and that you may write to");
  if (sqlite3_db_readonly(db_.get(), "main") == 1) throw StoreError(file_, "may not be written", "name another file");
  if (has_row(prepare("SELECT 1 FROM sqlite_master WHERE type = 'table'").get()) && !detail::sql::is_ours(db_.get()))
    throw StoreError(file_, "holds tables of another program", "name another file");
  execute("PRAGMA journal_mode=WAL");
  execute("PRAGMA synchronous=NORMAL");
  execute("BEGIN IMMEDIATE");
  execute("CREATE TABLE IF NOT EXISTS runs(run INTEGER PRIMARY KEY, started TEXT, command TEXT)");
  execute("CREATE TABLE IF NOT EXISTS sets(set_hash TEXT PRIMARY KEY, title TEXT, scenarios INTEGER, source TEXT)");
  execute(
      "CREATE TABLE IF NOT EXISTS behaviors(behavior TEXT, parameters_hash TEXT, parameters TEXT, command TEXT, "
      "PRIMARY KEY(behavior, parameters_hash))");
  std::string const key =
      "set_hash TEXT NOT NULL, scenario INTEGER NOT NULL, behavior TEXT NOT NULL, parameters_hash TEXT NOT NULL, "
      "version TEXT NOT NULL, ";
  std::string const primary = ", PRIMARY KEY(set_hash, behavior, parameters_hash, version, scenario)) WITHOUT ROWID";
  execute("CREATE TABLE IF NOT EXISTS results(" + key + "seed TEXT, run INTEGER, population TEXT, " +
          detail::sql::columns(type_info<RunResult>(), true) + primary);
  execute("CREATE TABLE IF NOT EXISTS times(" + key + detail::sql::columns(type_info<RunTimes>(), true) + primary);
  add_missing_columns();
  execute("COMMIT");
  add_result_ = prepare("INSERT OR REPLACE INTO results(" + std::string(detail::sql::key_columns) +
                        "seed, run, population, " + detail::sql::columns(type_info<RunResult>(), false) + ") VALUES(" +
                        detail::sql::marks(8 + type_info<RunResult>().fields().size()) + ")");
  add_times_ = prepare("INSERT OR REPLACE INTO times(" + std::string(detail::sql::key_columns) +
                       detail::sql::columns(type_info<RunTimes>(), false) + ") VALUES(" +
                       detail::sql::marks(5 + type_info<RunTimes>().fields().size()) + ")");
  has_ = prepare(
      "SELECT error_kind FROM results WHERE set_hash=? AND scenario=? AND behavior=? AND parameters_hash=? AND "
      "version=?");
}

CAMBIUM_COLD ResultStore::Database ResultStore::open(std::string const& name, int flags) {
  sqlite3* db = nullptr;
  sqlite3_open_v2(name.c_str(), &db, flags, nullptr);
  if (db != nullptr) sqlite3_busy_timeout(db, 60'000);
  return Database(db);
}

CAMBIUM_COLD void ResultStore::fail(std::string const& what, std::string const& remedy) const {
  throw StoreError(file_, what + " (" + sqlite3_errmsg(db_.get()) + ")", remedy);
}

CAMBIUM_COLD void ResultStore::execute(std::string const& sql) {
  if (sqlite3_exec(db_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    fail("cannot be written", "make room on the disk, or name another file");
}

template <class... Values>
ResultStore::Statement ResultStore::prepare(std::string const& sql, Values const&... values) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(db_.get(), sql.c_str(), -1, &statement, nullptr) != SQLITE_OK)
    fail("has other tables than this version of cambium", "name another file");
  detail::sql::bind_values(statement, 1, values...);
  return Statement(statement);
}

CAMBIUM_COLD bool ResultStore::has_row(sqlite3_stmt* query) {
  auto const code = sqlite3_step(query);
  if (code != SQLITE_ROW && code != SQLITE_DONE) {
    sqlite3_reset(query);
    fail("cannot be read", "it may be damaged or locked: try again, or run the benchmark into another file");
  }
  return code == SQLITE_ROW;
}

template <class... Values>
std::string ResultStore::find_text(std::string const& sql, Values const&... values) {
  auto const query = prepare(sql, values...);
  return has_row(query.get()) ? detail::sql::text(query.get(), 0) : std::string();
}

CAMBIUM_COLD bool ResultStore::add_missing_column(std::string const& table, std::string const& column) {
  auto const name = column.substr(0, column.find(' '));
  if (has_row(prepare("SELECT 1 FROM pragma_table_info(?) WHERE name=?", table, name).get())) return false;
  execute("ALTER TABLE " + table + " ADD COLUMN " + column);
  return true;
}

CAMBIUM_COLD void ResultStore::add_missing_columns() {
  add_missing_column("sets", "source TEXT");
  add_missing_column("behaviors", "command TEXT");
  add_missing_column("results", "population TEXT");
  for (auto const& field : type_info<RunTimes>().fields()) add_missing_column("times", detail::sql::column_of(field));
  for (auto const& field : type_info<RunResult>().fields())
    if (add_missing_column("results", detail::sql::column_of(field)) && field.name == std::string_view("error_kind"))
      execute(
          "UPDATE results SET error_kind = CASE WHEN error LIKE 'its plans took longer than %' THEN 1 WHEN error LIKE "
          "'the process that ran it died%' THEN 2 ELSE 0 END");
}

CAMBIUM_COLD void ResultStore::step(sqlite3_stmt* statement) {
  auto const code = sqlite3_step(statement);
  if (code != SQLITE_DONE && code != SQLITE_ROW)
    fail("cannot be written", "make room on the disk, or name another file");
  sqlite3_reset(statement);
}

}  // namespace cambium::inline v0_1
