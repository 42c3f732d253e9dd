// The tables of session.db, and how a session is told from any other SQLite file.
#pragma once

#include "rig/sqlite_database.h"

namespace lumitexel {

// Creates the tables in one transaction and marks the file as a session of this version.
void create_session_schema(SqliteDatabase& database, const std::string& kind);

// Throws Corrupt if the file is not a session or one of a newer version.
void check_session_schema(SqliteDatabase& database, const std::string& file);

}  // namespace lumitexel
