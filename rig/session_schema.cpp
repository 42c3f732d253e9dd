#include "rig/session_schema.h"

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr std::int64_t kApplicationId = 0x4c4d5458;  // "LMTX"; `file` and SQLite itself read it
constexpr std::int64_t kVersion = 2, kOldestVersion = 1;

constexpr const char* kTables = R"sql(
CREATE TABLE session (kind TEXT NOT NULL) STRICT;
CREATE TABLE documents (
  name TEXT PRIMARY KEY, sha256 TEXT NOT NULL, bytes BLOB NOT NULL) STRICT;
CREATE TABLE shots (
  id INTEGER PRIMARY KEY CHECK (id > 0), kind TEXT NOT NULL, view TEXT NOT NULL, place INTEGER NOT NULL,
  exposure_s REAL NOT NULL, gain_db REAL NOT NULL,
  turntable_deg REAL NOT NULL, light_azimuth_deg REAL NOT NULL, light_elevation_deg REAL NOT NULL) STRICT;
CREATE TABLE frames (
  id INTEGER PRIMARY KEY AUTOINCREMENT, shot_id INTEGER UNIQUE REFERENCES shots (id), name TEXT NOT NULL UNIQUE,
  role TEXT NOT NULL, sha256 TEXT NOT NULL, bytes INTEGER NOT NULL,
  requested_exposure_s REAL NOT NULL, requested_gain_db REAL NOT NULL,
  applied_exposure_s REAL NOT NULL, applied_gain_db REAL NOT NULL,
  reported_exposure_s REAL NOT NULL, reported_gain_db REAL NOT NULL,
  utc_ns INTEGER NOT NULL, device_time_s REAL NOT NULL, sensor_temperature_c REAL NOT NULL,
  turntable_deg REAL NOT NULL, light_azimuth_deg REAL NOT NULL, light_elevation_deg REAL NOT NULL) STRICT;
CREATE TABLE events (
  id INTEGER PRIMARY KEY AUTOINCREMENT, utc_ns INTEGER NOT NULL, level TEXT NOT NULL, text TEXT NOT NULL) STRICT;
)sql";

constexpr const char* kTablesOfVersion2 = R"sql(
CREATE TABLE discards (
  id INTEGER PRIMARY KEY AUTOINCREMENT, shot_id INTEGER NOT NULL REFERENCES shots (id), attempt INTEGER NOT NULL,
  asked_exposure_s REAL NOT NULL, asked_gain_db REAL NOT NULL, reported_exposure_s REAL, reported_gain_db REAL,
  cause TEXT NOT NULL, utc_ns INTEGER NOT NULL) STRICT;
CREATE TABLE replayed_from (session TEXT NOT NULL, content_sha256 TEXT NOT NULL) STRICT;
)sql";

std::int64_t pragma(SqliteDatabase& database, const std::string& name) {
  SqliteStatement statement = database.prepare("PRAGMA " + name);
  return statement.step() ? statement.integer(0) : 0;
}

}  // namespace

void create_session_schema(SqliteDatabase& database, const std::string& kind) {
  SqliteTransaction transaction(database);
  database.run(kTables);
  database.run(kTablesOfVersion2);
  database.prepare("INSERT INTO session (kind) VALUES (?)").with(kind).step();
  database.run("PRAGMA application_id = " + std::to_string(kApplicationId));
  database.run("PRAGMA user_version = " + std::to_string(kVersion));
  transaction.commit();
}

void check_session_schema(SqliteDatabase& database, const std::string& file) {
  if (pragma(database, "application_id") != kApplicationId) throw Corrupt(file + ": is not a session's journal");
  const std::int64_t version = pragma(database, "user_version");
  if (version < kOldestVersion || version > kVersion) {
    throw Corrupt(file + ": has version " + std::to_string(version) + "; this program reads versions " +
                  std::to_string(kOldestVersion) + " to " + std::to_string(kVersion));
  }
}

void upgrade_session_schema(SqliteDatabase& database) {
  if (has_discard_tables(database)) return;
  SqliteTransaction transaction(database);
  database.run(kTablesOfVersion2);
  database.run("PRAGMA user_version = " + std::to_string(kVersion));
  transaction.commit();
}

bool has_discard_tables(SqliteDatabase& database) { return pragma(database, "user_version") >= 2; }

}  // namespace lumitexel
