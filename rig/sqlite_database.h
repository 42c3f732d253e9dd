// One SQLite connection and its statements, with errors by cause: StorageFull when the disk or quota is full, Corrupt
// when the file is no database or a damaged one, Error otherwise; each names the file and what SQLite said.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace lumitexel {

enum class DatabaseMode { ReadOnly, ReadWrite, Create };

// One prepared statement. Parameters are bound in the order of the with() calls, columns count from 0.
class SqliteStatement {
 public:
  SqliteStatement& with(std::int64_t value);
  SqliteStatement& with(double value);  // NaN becomes NULL, which NOT NULL columns refuse
  SqliteStatement& with(std::string_view text);
  SqliteStatement& with_blob(std::string_view bytes);
  SqliteStatement& with_null();

  bool step();  // true: there is a row; false: done
  void reset();  // ready to be bound and stepped again

  bool is_null(int column) const;
  std::int64_t integer(int column) const;
  double number(int column) const;
  std::string bytes(int column) const;  // of text or blob

 private:
  friend class SqliteDatabase;
  SqliteStatement(sqlite3* database, const std::string& file, std::string_view sql);
  void check(int code) const;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  sqlite3* database_;
  std::string file_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  int bound_ = 0;
};

class SqliteDatabase {
 public:
  // Writers use a write-ahead log and sync it at every commit, so that what is committed survives a power cut.
  SqliteDatabase(const std::filesystem::path& file, DatabaseMode mode);

  void run(const std::string& sql);  // one or several statements without parameters
  SqliteStatement prepare(std::string_view sql);
  std::int64_t last_row_id() const;

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::string file_;
  std::unique_ptr<sqlite3, Close> database_;
};

// All or nothing: rolls back on destruction unless committed.
class SqliteTransaction {
 public:
  explicit SqliteTransaction(SqliteDatabase& database);
  ~SqliteTransaction();
  SqliteTransaction(const SqliteTransaction&) = delete;
  SqliteTransaction& operator=(const SqliteTransaction&) = delete;
  void commit();

 private:
  SqliteDatabase& database_;
  bool open_ = true;
};

}  // namespace lumitexel
