//! How long the long tests are; crates with such tests have a symbolic link to this file, so that their packages hold it.

/// Returns `all` where `./check --long` runs the tests, else `few`: cases, rounds, or the step from one case to the next.
pub(crate) fn long_or<T>(all: T, few: T) -> T {
    if std::env::var_os("TAUT_LONG_TESTS").is_some() { all } else { few }
}
