//! The file: tables of SQLite, and how they are opened, read and written.
//!
//! *Idea.* SQLite's rollback journal makes each change whole or not at all, also where the process or the machine stops. The lock is held
//! as long as the store is open. Deleted bytes are overwritten with zeros, and the journal is cut to nothing after each change.
//! *Trap.* The file may have been made by somebody else: SQLite gets no schema that is not ours, and records are believed only after the
//! manifest was checked.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

use rusqlite::config::DbConfig;
use rusqlite::{Connection, ErrorCode, OpenFlags, TransactionBehavior, params};

use super::record::Row;
use super::seal::Secrets;
use super::{Manifest, StoreError};

/// The version of the tables.
const VERSION: u32 = 1;
/// How long an opening waits for another process to end.
const LOCK_WAIT: Duration = Duration::from_secs(5);
/// The tables, by name.
const TABLES: [(&str, &str); 3] = [
    (
        "header",
        "CREATE TABLE header (id INTEGER PRIMARY KEY NOT NULL, version INTEGER NOT NULL, store BLOB NOT NULL, \
         salt BLOB NOT NULL, key_check BLOB NOT NULL, settings BLOB NOT NULL) STRICT",
    ),
    (
        "manifest",
        "CREATE TABLE manifest (id INTEGER PRIMARY KEY NOT NULL, counter INTEGER NOT NULL, mac BLOB NOT NULL) STRICT",
    ),
    (
        "person",
        "CREATE TABLE person (id INTEGER PRIMARY KEY NOT NULL, lookup BLOB NOT NULL UNIQUE, name BLOB NOT NULL, \
         template BLOB NOT NULL, attempts BLOB NOT NULL) STRICT",
    ),
];

/// What a store begins with.
pub(super) struct Header {
    pub(super) store: [u8; 16],
    pub(super) salt: [u8; 32],
    pub(super) check: [u8; 32],
    /// Encrypted.
    pub(super) settings: Vec<u8>,
}

/// Opens an existing file and locks it.
pub(super) fn connect(path: &Path) -> Result<Connection, StoreError> {
    let explained = |error| explain(path, error);
    let flags = OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    // With a folder before it no name is a URI, nor that of a store in memory.
    let place = Path::new(".").join(path);
    let connection = Connection::open_with_flags(place, flags).map_err(explained)?;
    connection.busy_timeout(LOCK_WAIT).map_err(explained)?;
    connection.set_db_config(DbConfig::SQLITE_DBCONFIG_DEFENSIVE, true).map_err(explained)?;
    let set = |name: &str, value: &str| {
        // Some of them answer with their new value.
        connection.pragma_update_and_check(None, name, value, |_| Ok(())).or_else(|error| {
            match error {
                rusqlite::Error::QueryReturnedNoRows => Ok(()),
                error => Err(explain(path, error)),
            }
        })
    };
    for (name, value) in [
        ("trusted_schema", "OFF"),
        ("cell_size_check", "ON"),
        ("temp_store", "MEMORY"),
        ("mmap_size", "0"),
        ("locking_mode", "EXCLUSIVE"),
        ("secure_delete", "ON"),
        ("synchronous", "FULL"),
    ] {
        set(name, value)?;
    }
    // Takes the lock, which stays.
    connection.execute_batch("BEGIN EXCLUSIVE; COMMIT").map_err(explained)?;
    Ok(connection)
}

/// Sets the kind of the journal, which changes the file: once it is known to be a store.
pub(super) fn set_journal(connection: &Connection, path: &Path) -> Result<(), StoreError> {
    let set = connection.pragma_update_and_check(None, "journal_mode", "TRUNCATE", |_| Ok(()));
    set.map_err(|error| explain(path, error))
}

/// Fills an empty file.
pub(super) fn write_tables(
    connection: &mut Connection,
    path: &Path,
    header: &Header,
    manifest: &Manifest,
) -> Result<(), StoreError> {
    let mut write = || -> rusqlite::Result<()> {
        let change = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
        for (_, sql) in TABLES {
            change.execute(sql, [])?;
        }
        let Header { store, salt, check, settings } = header;
        change.execute(
            "INSERT INTO header VALUES (1, ?, ?, ?, ?, ?)",
            params![VERSION, store, salt, check, settings],
        )?;
        change.execute(
            "INSERT INTO manifest VALUES (1, ?, ?)",
            params![manifest.counter as i64, manifest.mac],
        )?;
        change.commit()
    };
    write().map_err(|error| explain(path, error))
}

/// Reads what the store begins with, after checking that the tables are ours.
pub(super) fn read_header(
    connection: &Connection,
    path: &Path,
) -> Result<(Header, Manifest), StoreError> {
    let explained = |error| explain(path, error);
    check_schema(connection, path)?;
    let version: u32 = connection
        .query_row("SELECT version FROM header WHERE id = 1", [], |row| row.get(0))
        .map_err(explained)?;
    if version != VERSION {
        return Err(StoreError::Version { found: version, known: VERSION });
    }
    let problem: String = connection
        .query_row("PRAGMA integrity_check(1)", [], |row| row.get(0))
        .map_err(explained)?;
    if problem != "ok" {
        return Err(StoreError::damaged(problem));
    }
    let sql = "SELECT store, salt, key_check, settings FROM header WHERE id = 1";
    let read = |row: &rusqlite::Row<'_>| {
        let (store, salt) = (row.get(0)?, row.get(1)?);
        Ok(Header { store, salt, check: row.get(2)?, settings: row.get(3)? })
    };
    let header = connection.query_row(sql, [], read).map_err(explained)?;
    let sql = "SELECT counter, mac FROM manifest WHERE id = 1";
    let read = |row: &rusqlite::Row<'_>| {
        let counter: i64 = row.get(0)?;
        Ok(Manifest { store: header.store, counter: counter as u64, mac: row.get(1)? })
    };
    let manifest = connection.query_row(sql, [], read).map_err(explained)?;
    Ok((header, manifest))
}

/// Refuses a file that has other tables, or triggers, views or the like.
fn check_schema(connection: &Connection, path: &Path) -> Result<(), StoreError> {
    let read = || -> rusqlite::Result<Vec<(String, String)>> {
        let sql = "SELECT name, sql FROM sqlite_schema WHERE sql IS NOT NULL ORDER BY name LIMIT 4";
        let mut query = connection.prepare(sql)?;
        query.query_map([], |row| Ok((row.get(0)?, row.get(1)?)))?.collect()
    };
    let found = read().map_err(|error| explain(path, error))?;
    let is_ours = found.len() == TABLES.len()
        && found.iter().zip(TABLES).all(|(found, own)| (found.0.as_str(), found.1.as_str()) == own);
    match is_ours {
        true => Ok(()),
        false => Err(StoreError::NoStore { path: path.display().to_string() }),
    }
}

/// Calls `visit` with the records of each person, in the order of their numbers.
pub(super) fn each_person(
    connection: &Connection,
    mut visit: impl FnMut(i64, Row) -> Result<(), StoreError>,
) -> Result<(), StoreError> {
    let sql = "SELECT id, lookup, name, template, attempts FROM person ORDER BY id";
    let mut query = connection.prepare(sql).map_err(StoreError::damaged)?;
    let mut rows = query.query([]).map_err(StoreError::damaged)?;
    while let Some(row) = rows.next().map_err(StoreError::damaged)? {
        let (person, row) = read_row(row).map_err(StoreError::damaged)?;
        visit(person, row)?;
    }
    Ok(())
}

/// The records of the person with this hash of the name.
pub(super) fn find_person(
    connection: &Connection,
    lookup: &[u8; 32],
) -> Result<Option<(i64, Row)>, StoreError> {
    let sql = "SELECT id, lookup, name, template, attempts FROM person WHERE lookup = ?";
    match connection.query_row(sql, [lookup.as_slice()], read_row) {
        Ok(found) => Ok(Some(found)),
        Err(rusqlite::Error::QueryReturnedNoRows) => Ok(None),
        Err(error) => Err(StoreError::damaged(error)),
    }
}

/// The records of the person with this number.
pub(super) fn person(connection: &Connection, person: i64) -> Result<Option<Row>, StoreError> {
    let sql = "SELECT id, lookup, name, template, attempts FROM person WHERE id = ?";
    match connection.query_row(sql, [person], read_row) {
        Ok((_, row)) => Ok(Some(row)),
        Err(rusqlite::Error::QueryReturnedNoRows) => Ok(None),
        Err(error) => Err(StoreError::damaged(error)),
    }
}

fn read_row(row: &rusqlite::Row<'_>) -> rusqlite::Result<(i64, Row)> {
    let (lookup, name) = (row.get(1)?, row.get(2)?);
    Ok((row.get(0)?, Row { lookup, name, template: row.get(3)?, attempts: row.get(4)? }))
}

/// The hashes of the records of all people.
pub(super) fn digests(
    connection: &Connection,
    secrets: &Secrets,
) -> Result<BTreeMap<i64, [u8; 32]>, StoreError> {
    let mut digests = BTreeMap::new();
    each_person(connection, |person, row| {
        digests.insert(person, row.digest(secrets, person));
        Ok(())
    })?;
    Ok(digests)
}

/// Writes or removes the records of a person with the manifest: both or neither.
pub(super) fn write_person(
    connection: &mut Connection,
    path: &Path,
    person: i64,
    row: Option<&Row>,
    manifest: &Manifest,
) -> Result<(), StoreError> {
    let mut write = || -> rusqlite::Result<()> {
        let change = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
        match row {
            Some(Row { lookup, name, template, attempts }) => change.execute(
                "INSERT OR REPLACE INTO person VALUES (?, ?, ?, ?, ?)",
                params![person, lookup, name, template, attempts],
            )?,
            None => change.execute("DELETE FROM person WHERE id = ?", [person])?,
        };
        change.execute(
            "UPDATE manifest SET counter = ?, mac = ? WHERE id = 1",
            params![manifest.counter as i64, manifest.mac],
        )?;
        change.commit()
    };
    write().map_err(|error| explain(path, error))
}

/// Compacts the file, so that no page holds what was deleted.
pub(super) fn compact(connection: &Connection, path: &Path) -> Result<(), StoreError> {
    connection
        .execute_batch("VACUUM")
        .map_err(|error| StoreError::NotCompacted { problem: explain(path, error).to_string() })
}

/// What an error of SQLite means for a person.
fn explain(path: &Path, error: rusqlite::Error) -> StoreError {
    let shown = || path.display().to_string();
    match error.sqlite_error_code() {
        Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked) => {
            StoreError::InUse { path: shown() }
        }
        Some(ErrorCode::NotADatabase) => StoreError::NoStore { path: shown() },
        Some(
            ErrorCode::CannotOpen
            | ErrorCode::DiskFull
            | ErrorCode::PermissionDenied
            | ErrorCode::ReadOnly
            | ErrorCode::SystemIoFailure,
        ) => StoreError::io(path, error),
        _ => StoreError::damaged(error),
    }
}
