// The tables of session.db, and how a session is told from any other SQLite file.
#pragma once

#include "rig/sqlite_database.h"

namespace lumitexel {

// Creates the tables in one transaction and marks the file as a session of this version.
void create_session_schema(SqliteDatabase& database, const std::string& kind);

// Throws Corrupt if the file is not a session or one of a newer version.
void check_session_schema(SqliteDatabase& database, const std::string& file);

// Gives a session of an earlier version the tables that it lacks; nothing that it holds changes.
//   1  documents, shots, frames, events
//   2  discards: attempts that gave no frame; replayed_from: the session that this one is a replay of
void upgrade_session_schema(SqliteDatabase& database);

// Whether the tables of version 2 are there; a session of version 1 that is only read does without them.
bool has_discard_tables(SqliteDatabase& database);

}  // namespace lumitexel
