#include "rig/sqlite_database.h"

#include <sqlite3.h>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr int kBusyTimeout_ms = 5000;  // a reader may hold the journal for a moment; nobody waits for ever

[[noreturn]] void fail(int code, const std::string& file, const std::string& message) {
  const std::string text = file + ": " + message;
  switch (code & 0xff) {  // the primary code; the upper bits tell details
    case SQLITE_FULL: throw StorageFull(text);
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB: throw Corrupt(text);
    default: throw Error(text);
  }
}

int open_flags(DatabaseMode mode) {
  switch (mode) {
    case DatabaseMode::ReadOnly: return SQLITE_OPEN_READONLY;
    case DatabaseMode::ReadWrite: return SQLITE_OPEN_READWRITE;
    case DatabaseMode::Create: break;
  }
  return SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
}

}  // namespace

void SqliteStatement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
void SqliteDatabase::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

SqliteStatement::SqliteStatement(sqlite3* database, const std::string& file, std::string_view sql)
    : database_(database), file_(file) {
  sqlite3_stmt* raw = nullptr;
  check(sqlite3_prepare_v2(database, sql.data(), static_cast<int>(sql.size()), &raw, nullptr));
  statement_.reset(raw);
}

void SqliteStatement::check(int code) const {
  if (code != SQLITE_OK) fail(code, file_, sqlite3_errmsg(database_));
}

SqliteStatement& SqliteStatement::with(std::int64_t value) {
  check(sqlite3_bind_int64(statement_.get(), ++bound_, value));
  return *this;
}

SqliteStatement& SqliteStatement::with(double value) {
  check(sqlite3_bind_double(statement_.get(), ++bound_, value));
  return *this;
}

SqliteStatement& SqliteStatement::with(std::string_view text) {
  check(sqlite3_bind_text64(statement_.get(), ++bound_, text.data() == nullptr ? "" : text.data(), text.size(),
                            SQLITE_TRANSIENT, SQLITE_UTF8));
  return *this;
}

SqliteStatement& SqliteStatement::with_blob(std::string_view bytes) {
  check(sqlite3_bind_blob64(statement_.get(), ++bound_, bytes.data() == nullptr ? "" : bytes.data(), bytes.size(),
                            SQLITE_TRANSIENT));
  return *this;
}

SqliteStatement& SqliteStatement::with_null() {
  check(sqlite3_bind_null(statement_.get(), ++bound_));
  return *this;
}

bool SqliteStatement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) fail(code, file_, sqlite3_errmsg(database_));
  return false;
}

void SqliteStatement::reset() {
  sqlite3_reset(statement_.get());
  bound_ = 0;
}

bool SqliteStatement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}
std::int64_t SqliteStatement::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
double SqliteStatement::number(int column) const { return sqlite3_column_double(statement_.get(), column); }

std::string SqliteStatement::bytes(int column) const {
  const auto* data = static_cast<const char*>(sqlite3_column_blob(statement_.get(), column));
  return data == nullptr ? std::string() : std::string(data, sqlite3_column_bytes(statement_.get(), column));
}

SqliteDatabase::SqliteDatabase(const std::filesystem::path& file, DatabaseMode mode) : file_(file.string()) {
  sqlite3* raw = nullptr;
  const int code = sqlite3_open_v2(file_.c_str(), &raw, open_flags(mode), nullptr);
  database_.reset(raw);
  if (code != SQLITE_OK) fail(code, file_, raw != nullptr ? sqlite3_errmsg(raw) : "out of memory");
  sqlite3_extended_result_codes(raw, 1);
  sqlite3_busy_timeout(raw, kBusyTimeout_ms);
  run("PRAGMA foreign_keys = ON");
  if (mode != DatabaseMode::ReadOnly) run("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL");
}

void SqliteDatabase::run(const std::string& sql) {
  const int code = sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(code, file_, sqlite3_errmsg(database_.get()));
}

SqliteStatement SqliteDatabase::prepare(std::string_view sql) { return SqliteStatement(database_.get(), file_, sql); }

std::int64_t SqliteDatabase::last_row_id() const { return sqlite3_last_insert_rowid(database_.get()); }

SqliteTransaction::SqliteTransaction(SqliteDatabase& database) : database_(database) { database_.run("BEGIN IMMEDIATE"); }

SqliteTransaction::~SqliteTransaction() {
  if (!open_) return;
  try {
    database_.run("ROLLBACK");
  } catch (const Error&) {
    // SQLite has rolled back already, as it does by itself on a full disk.
  }
}

void SqliteTransaction::commit() {
  database_.run("COMMIT");
  open_ = false;
}

}  // namespace lumitexel
