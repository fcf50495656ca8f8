//! The Python package of taut: thin bindings.
