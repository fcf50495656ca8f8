"""Answers, certificates and verdicts: frozen classes, filled from what serde says of the Rust structs."""
