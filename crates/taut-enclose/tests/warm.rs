//! Placeholder to warm the build.
