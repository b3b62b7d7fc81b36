// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The tables of FLEET/fleet.sqlite. docs/fleet-report.md describes them for people who query them.
#include <cstdint>

namespace fidservo::fleet {

/// In the file's header: tells a fleet's database from other SQLite files.
inline constexpr std::int64_t fleet_application_id = 0x66697366;  // "fisf"
/// Of the tables below. A database of another version is made anew from the results.
inline constexpr std::int64_t fleet_schema_version = 2;

inline constexpr const char* fleet_schema = R"sql(
CREATE TABLE results (
  file TEXT PRIMARY KEY, sha256 TEXT NOT NULL, campaign TEXT NOT NULL, campaign_sha256 TEXT NOT NULL,
  unit TEXT, recorded_at_s INTEGER, rig TEXT NOT NULL, rig_sha256 TEXT NOT NULL, program TEXT NOT NULL,
  effort REAL, status TEXT NOT NULL, reason TEXT, verdict TEXT, ended TEXT,
  gap_before REAL, gap_after REAL, unexplained_block TEXT) WITHOUT ROWID;
CREATE TABLE labels (
  file TEXT NOT NULL REFERENCES results, label TEXT NOT NULL, value TEXT NOT NULL,
  PRIMARY KEY (file, label)) WITHOUT ROWID;
CREATE TABLE signals (
  file TEXT NOT NULL REFERENCES results, signal TEXT NOT NULL, unit TEXT NOT NULL,
  gap_before REAL, gap_after REAL, floor REAL, PRIMARY KEY (file, signal)) WITHOUT ROWID;
CREATE TABLE blocks (
  file TEXT NOT NULL REFERENCES results, block TEXT NOT NULL, probability REAL,
  PRIMARY KEY (file, block)) WITHOUT ROWID;
CREATE TABLE effects (
  file TEXT NOT NULL REFERENCES results, place INTEGER NOT NULL, effect TEXT NOT NULL, block TEXT NOT NULL,
  probability REAL, gap_removed REAL, gap_alone REAL, PRIMARY KEY (file, place)) WITHOUT ROWID;
CREATE TABLE parameters (
  file TEXT NOT NULL REFERENCES results, place INTEGER NOT NULL, number INTEGER NOT NULL, effect TEXT NOT NULL,
  parameter TEXT NOT NULL, unit TEXT NOT NULL, value REAL, std REAL, PRIMARY KEY (file, place, number)) WITHOUT ROWID;
CREATE TABLE ties (
  file TEXT NOT NULL REFERENCES results, place INTEGER NOT NULL, effect TEXT NOT NULL,
  PRIMARY KEY (file, place, effect)) WITHOUT ROWID;
CREATE TABLE tried (
  file TEXT NOT NULL REFERENCES results, effect TEXT NOT NULL, probability REAL, gap_removed REAL, would_show INTEGER,
  PRIMARY KEY (file, effect)) WITHOUT ROWID;
CREATE INDEX results_by_unit ON results (unit, recorded_at_s);
CREATE VIEW series AS
  SELECT p.effect, p.parameter, p.unit AS parameter_unit, r.unit, datetime(r.recorded_at_s, 'unixepoch') AS recorded_at,
         p.value, p.std, e.probability, r.gap_before, r.gap_after, r.rig, r.file
  FROM parameters p JOIN effects e USING (file, place) JOIN results r USING (file);
)sql";

}  // namespace fidservo::fleet
